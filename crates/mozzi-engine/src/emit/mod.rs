//! Programs as source text: Rust, C99 and CUDA C.
//!
//! All three have the same steps in the same order, one line each; they differ in the [`Dialect`]. The text depends
//! only on the robot and the quantities, not on the machine.

mod body;
mod c;
mod casadi;
mod cuda;
mod describe;
mod dialect;
mod names;
mod rust;
mod sin_cos;

use crate::program::Function;
use crate::program::{Arguments, record_quantity};
use crate::program::{Program, Step, TooLong};
pub use casadi::emit_casadi;
pub use cuda::{Block, CudaLayout};
use dialect::{Argument, Emitted, Source};
use mozzi::Model;
use mozzi::quantities::Query;
use mozzi::scalar::Float;
use std::collections::BTreeSet;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Language of emitted source text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Language {
    /// One file without crate attributes, for `mod` or `include!`: no `std`, no allocation, no panic, no dependency.
    /// Arguments are references to arrays.
    Rust,
    /// C99: a header and a source file that need only <stdint.h> and <math.h>; C++ can include the header.
    C,
    /// CUDA C: one file without includes. It has a function for one state and kernels for many states, one thread for
    /// each state, in two layouts: `_rows` (entry k of state i at `i · length + k`, through shared memory) and
    /// `_columns` (at `k · count + i`). Each kernel's comment has the largest block, a multiple of 32 threads; with
    /// `MOZZI_ONLY_ROWS` or `MOZZI_ONLY_COLUMNS` defined, only the kernels of that layout are compiled.
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
    /// Writes it into a folder, which is created if needed. A file with the same content is not rewritten, so that
    /// build tools that compare modification times see real changes only.
    ///
    /// # Errors
    /// [`EmitError::Write`].
    pub fn write(&self, folder: &Path) -> Result<PathBuf, EmitError> {
        let path = folder.join(&self.name);
        if std::fs::read(&path).ok().as_deref() != Some(self.text.as_bytes()) {
            // written next to its destination and renamed: a full disk leaves an older file intact
            // threads write at the same time
            static COUNT: AtomicUsize = AtomicUsize::new(0);
            let count = COUNT.fetch_add(1, Ordering::Relaxed);
            let part = folder.join(format!(".mozzi-{}-{count}.part", std::process::id()));
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
    /// A frame belongs to another model.
    Frame(mozzi::Error),
    /// The language has no such function without its standard library: tanh in Rust.
    Function(Function, Language),
    /// A Jacobian has too many steps.
    TooLong(TooLong),
    /// A constant is not finite in this precision.
    Constant(f64, Precision),
    /// A folder or file cannot be written.
    Write(PathBuf, std::io::Error),
}

impl fmt::Display for EmitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            EmitError::Nothing => write!(f, "no quantity, expected one or more"),
            EmitError::Frame(error) => write!(f, "{error}"),
            EmitError::TooLong(error) => write!(f, "the Jacobian: {error}"),
            EmitError::Function(function, language) => {
                write!(f, "{function}: {language:?} has none without its standard library, expected C or CUDA")
            }
            EmitError::Write(path, error) => write!(f, "{} cannot be written: {error}", path.display()),
            EmitError::Constant(x, precision) => {
                let cause = if x.is_nan() { " (the mass matrix may be singular in all states)" } else { "" };
                write!(f, "a constant is {x:?}{cause}, expected a finite {precision:?}")
            }
        }
    }
}
impl std::error::Error for EmitError {}

/// The source text of a robot's quantities. A quantity that is not in `arguments` is constant: the robot's own gravity,
/// its base at rest, no applied wrenches. Each quantity becomes a function with its name, followed by the frame's name
/// if it has a frame; in C and CUDA the robot's name is the prefix. Names are made valid and unique. The first lines of
/// the text describe the robot, its joints and units, frames and gravity; the comment of each function describes its
/// arguments and its cost.
///
/// ```
/// use mozzi::quantities::GravityForces;
/// use mozzi_engine::{Arguments, Language, Precision, emit};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let model = mozzi_urdf::open("ur5")?.build()?;
/// let files = emit(&model, &[GravityForces.into()], Arguments::default(), Language::C, Precision::F32)?;
/// let declared = "void ur5_gravity_forces(const float theta[6], float g[6]);";
/// assert!(files[0].name == "ur5.h" && files[0].text.contains(declared));
/// assert!(files[1].name == "ur5.c");
/// # Ok(()) }
/// ```
///
/// Sines are the library's own, within an ulp up to |x| = 10⁶ (`f32`: 8192, 1.5 ulp); results that depend on a larger
/// angle or NaN are NaN. Compilers must not be allowed to reorder sums: the C text refuses `-ffast-math`.
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
        let mut function = written(&format!("{}{frame}", program.name()), program, &mut taken);
        function.about = describe::quantity(model, *quantity, program);
        function.describe_arrays(|name| describe::array(model, *quantity, arguments, name));
        functions.push(function);
    }
    let about = describe::robot(model, arguments, precision, describe::ARRAYS);
    files(&model.description().name, about, functions, language, precision)
}

/// Writes the text of [`emit`] into a folder. In a project's `build.rs` the folder is `OUT_DIR`, from which `include!`
/// takes the text, so that every build regenerates it from the robot's file; `examples/panda_controller` is such a
/// project.
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

/// The source text of programs, one function with its own name for each; `name` is the file's. See [`emit`] for robots.
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

/// The function of a program, with valid names.
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
    functions.iter().try_for_each(|function| refuse(function, precision, Some(language)))?;
    let source = Source { name: names::identifier(name, "robot"), about, functions, precision };
    Ok(match language {
        Language::Rust => rust::files(&source),
        Language::C => c::files(&source),
        Language::Cuda => cuda::files(&source),
    })
}

/// An error if a function has a constant that is not finite, or an operation that the language does not have.
fn refuse(function: &Emitted, precision: Precision, language: Option<Language>) -> Result<(), EmitError> {
    for step in &function.program.steps {
        match *step {
            Step::Constant(x) if !x.is_finite() || !precision.is_f64() && !(x as f32).is_finite() => {
                return Err(EmitError::Constant(x, precision));
            }
            Step::Apply(Function::Tanh, _) if language == Some(Language::Rust) => {
                return Err(EmitError::Function(Function::Tanh, Language::Rust));
            }
            _ => {}
        }
    }
    Ok(())
}
