//! Programs as source text: Rust, C99 and CUDA C.
//!
//! All three have the same steps in the same order, one line each; they differ in the [`Dialect`]. The text depends
//! only on the robot and the quantities, not on the machine.

mod body;
mod c;
mod cuda;
mod describe;
mod dialect;
mod names;
mod rust;
mod sin_cos;

use crate::arguments::{Arguments, record_quantity};
use crate::function::Function;
use crate::program::{Program, Step};
use dialect::{Argument, Emitted, Source};
use mozzi::Model;
use mozzi::quantities::Query;
use mozzi::scalar::Float;
use std::collections::BTreeSet;
use std::fmt;
use std::path::{Path, PathBuf};

/// Language of emitted source text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Language {
    /// One file without attributes of a crate, for `mod` or `include!`: no `std`, no allocation, no panic, no
    /// dependency. Arguments are references to arrays.
    Rust,
    /// C99, a header and a source, dependent on <stdint.h> and <math.h> alone; from C++, too.
    C,
    /// CUDA C, one file without includes: a function for one state, and for many, a thread each, kernels on two
    /// layouts: `_rows` (entry k of state i at `i · length + k`) and `_columns` (at `k · count + i`).
    Cuda,
}

/// Number type of a source text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Precision {
    /// `float`.
    F32,
    /// `double`.
    F64,
}

impl Precision {
    fn is_f64(self) -> bool {
        self == Precision::F64
    }

    /// The largest angle for which sines are computed.
    pub fn largest_angle(self) -> f64 {
        if self.is_f64() { f64::LARGEST } else { f32::LARGEST.into() }
    }
}

/// A generated file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SourceFile {
    /// Its name, without a folder.
    pub name: String,
    /// Its content.
    pub text: String,
}

impl SourceFile {
    /// Writes it into a folder, which is made; not where it stands there already: tools that look at times see a change
    /// only where there is one.
    ///
    /// # Errors
    /// [`EmitError::Write`].
    pub fn write(&self, folder: &Path) -> Result<PathBuf, EmitError> {
        let path = folder.join(&self.name);
        if std::fs::read(&path).ok().as_deref() != Some(self.text.as_bytes()) {
            // next to its place and renamed, so that a full disk leaves an older file whole
            let part = folder.join(format!(".mozzi-{}.part", std::process::id()));
            let written = std::fs::create_dir_all(folder)
                .and_then(|()| std::fs::write(&part, &self.text))
                .and_then(|()| std::fs::rename(&part, &path))
                .inspect_err(|_| drop(std::fs::remove_file(&part)));
            written.map_err(|error| EmitError::Write(path.clone(), error))?;
        }
        Ok(path)
    }
}

/// Errors of emitting source text.
#[derive(Debug)]
pub enum EmitError {
    /// No quantity was given.
    Nothing,
    /// A frame of another model.
    Frame(mozzi::Error),
    /// A function that the language has not without its standard library: tanh in Rust.
    Function(Function, Language),
    /// A constant that is no number of this precision.
    Constant(f64, Precision),
    /// A folder or file that cannot be written.
    Write(PathBuf, std::io::Error),
}

impl fmt::Display for EmitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            EmitError::Nothing => write!(f, "no quantity, expected one or more"),
            EmitError::Frame(error) => write!(f, "{error}"),
            EmitError::Function(function, language) => {
                write!(f, "{function}: {language:?} has none without its standard library, expected C or CUDA")
            }
            EmitError::Write(path, error) => write!(f, "{} cannot be written: {error}", path.display()),
            EmitError::Constant(x, precision) => write!(f, "a constant is {x:?}, expected a finite {precision:?}"),
        }
    }
}
impl std::error::Error for EmitError {}

/// The text of a robot's quantities; what is not one of the `arguments` is constant: its own gravity, its base at rest,
/// nothing touched. Each becomes a function named for the quantity, of a frame for both; in C and CUDA the robot's name
/// stands before. Names are made valid, and each once. The text's first lines tell the robot, its joints and units,
/// frames and gravity; each function's, its arguments and its work.
///
/// ```
/// use mozzi::quantities::GravityForces;
/// use mozzi_codegen::{Arguments, Language, Precision, emit};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let model = mozzi_urdf::open("ur5")?.build()?;
/// let files = emit(&model, &[GravityForces.into()], Arguments::default(), Language::C, Precision::F32)?;
/// let declared = "void ur5_gravity_forces(const float theta[6], float g[6]);";
/// assert!(files[0].name == "ur5.h" && files[0].text.contains(declared));
/// assert!(files[1].name == "ur5.c");
/// # Ok(()) }
/// ```
///
/// Sines are the library's own, within an ulp up to |x| = 10⁶ (`f32`: 8192, 1.5 ulp); a larger angle, or NaN, gives NaN
/// in all that depends on it. Compilers must not be allowed to reorder sums (`-ffast-math`): C refuses it.
///
/// # Errors
/// [`EmitError`].
pub fn emit(
    model: &Model,
    quantities: &[Query],
    arguments: Arguments,
    language: Language,
    precision: Precision,
) -> Result<Vec<SourceFile>, EmitError> {
    let programs = quantities.iter().map(|&query| record_quantity(model, query, arguments));
    let programs: Vec<Program> = programs.collect::<Result<_, _>>().map_err(EmitError::Frame)?;
    let mut functions = Vec::new();
    let mut taken = BTreeSet::new();
    for (quantity, program) in quantities.iter().zip(&programs) {
        let frame = quantity.subject.frame.map(|frame| format!("_{}", model.frame_name(frame))).unwrap_or_default();
        let mut function = written(&format!("{}{frame}", quantity.name()), program, &mut taken);
        function.about = describe::quantity(model, *quantity, program);
        for argument in function.inputs.iter_mut().chain(&mut function.outputs) {
            argument.about = describe::array(model, *quantity, arguments, &argument.name);
        }
        functions.push(function);
    }
    let about = describe::robot(model, arguments, precision);
    files(&model.description().name, about, functions, language, precision)
}

/// [`emit`] into a folder. In a project's `build.rs` that is `OUT_DIR`, from which `include!` takes the text, so that
/// it is written anew from the robot's file at every build; `examples/panda_controller` is such a project.
///
/// # Errors
/// [`EmitError`].
pub fn emit_into(
    folder: &Path,
    model: &Model,
    quantities: &[Query],
    arguments: Arguments,
    language: Language,
    precision: Precision,
) -> Result<Vec<PathBuf>, EmitError> {
    emit(model, quantities, arguments, language, precision)?.iter().map(|file| file.write(folder)).collect()
}

/// The text of programs, each a function of its own name; `name` is the file's. See [`emit`] for robots.
///
/// # Errors
/// [`EmitError`].
pub fn emit_programs(
    name: &str,
    programs: &[Program],
    language: Language,
    precision: Precision,
) -> Result<Vec<SourceFile>, EmitError> {
    let mut taken = BTreeSet::new();
    let functions = programs.iter().map(|program| written(program.name(), program, &mut taken)).collect();
    files(name, Vec::new(), functions, language, precision)
}

/// A program's function, its names valid.
fn written<'p>(name: &str, program: &'p Program, taken: &mut BTreeSet<String>) -> Emitted<'p> {
    let mut arrays = BTreeSet::new();
    let mut argument = |name: &str, length: usize| Argument {
        name: names::unique(&names::identifier(name, "x"), &mut arrays),
        length,
        about: String::new(),
    };
    Emitted {
        name: names::unique(&names::identifier(name, "f"), taken),
        inputs: program.inputs.iter().map(|input| argument(&input.name, input.length)).collect(),
        outputs: program.outputs.iter().map(|output| argument(&output.name, output.values.len())).collect(),
        about: Vec::new(),
        program,
    }
}

fn files(
    name: &str,
    about: Vec<String>,
    functions: Vec<Emitted>,
    language: Language,
    precision: Precision,
) -> Result<Vec<SourceFile>, EmitError> {
    if functions.is_empty() {
        return Err(EmitError::Nothing);
    }
    for step in functions.iter().flat_map(|function| &function.program.steps) {
        match *step {
            Step::Constant(x) if !x.is_finite() || !precision.is_f64() && !(x as f32).is_finite() => {
                return Err(EmitError::Constant(x, precision));
            }
            Step::Apply(Function::Tanh, _) if language == Language::Rust => {
                return Err(EmitError::Function(Function::Tanh, language));
            }
            _ => {}
        }
    }
    let source = Source { name: names::identifier(name, "robot"), about, functions, precision };
    Ok(match language {
        Language::Rust => rust::files(&source),
        Language::C => c::files(&source),
        Language::Cuda => cuda::files(&source),
    })
}
