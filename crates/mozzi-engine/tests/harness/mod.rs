//! Emitted text in a test program: it reads states from standard input and writes the functions' results.

mod c;
mod cuda;
mod rust;

use mozzi_engine::{Language, Precision, Program, SourceFile};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// A source text, and the functions of it that are called.
pub struct Module {
    pub files: Vec<SourceFile>,
    pub calls: Vec<Call>,
}

/// A function, and the states at which it is called, each with the function's inputs.
pub struct Call {
    pub function: String,
    pub program: Program,
    pub states: Vec<Vec<Vec<f64>>>,
}

impl Module {
    /// The prefix of its functions' names.
    pub fn name(&self) -> &str {
        self.files[0].name.split('.').next().expect("a name")
    }
}

impl Call {
    fn lengths(&self) -> (Vec<usize>, Vec<usize>) {
        let inputs = self.program.inputs().iter().map(|input| input.length).collect();
        (inputs, self.program.outputs().iter().map(|output| output.values.len()).collect())
    }
}

/// The number type's name in C.
fn c_number(precision: Precision) -> &'static str {
    if precision == Precision::F64 { "double" } else { "float" }
}

/// Rounds to the precision.
pub fn rounded(x: f64, precision: Precision) -> f64 {
    if precision == Precision::F64 { x } else { (x as f32).into() }
}

/// True if this program is installed.
pub fn exists(compiler: &str) -> bool {
    let found = Command::new(compiler).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok();
    if !found {
        eprintln!("skipped: no {compiler} here");
    }
    found
}

/// Writes the text and a main program into an empty folder; returns the compiler's command line.
pub fn build(
    language: Language,
    precision: Precision,
    modules: &[Module],
    name: &str,
    compiler: &str,
    flags: &[&str],
) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder");
    modules.iter().flat_map(|module| &module.files).for_each(|file| {
        file.write(&folder).expect("a file");
    });
    match language {
        Language::Rust => rust::build(&folder, precision, modules, compiler, flags),
        Language::C => c::build(&folder, precision, modules, compiler, flags),
        Language::Cuda => cuda::build(&folder, precision, modules, compiler, flags),
    }
    folder
}

/// Runs a command that must succeed.
pub fn compile(folder: &Path, compiler: &str, arguments: &[&str]) {
    let output = Command::new(compiler).args(arguments).current_dir(folder).output().expect("a compiler");
    assert!(output.status.success(), "{compiler} {arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
}

/// The outputs of each call at each of its states.
pub fn run(folder: &Path, precision: Precision, modules: &[Module]) -> Vec<Vec<Vec<Vec<f64>>>> {
    let calls: Vec<&Call> = modules.iter().flat_map(|module| &module.calls).collect();
    let numbers = calls.iter().flat_map(|call| call.states.iter().flatten().flatten());
    let bytes: Vec<u8> = match precision {
        Precision::F64 => numbers.flat_map(|x| x.to_ne_bytes()).collect(),
        Precision::F32 => numbers.flat_map(|x| (*x as f32).to_ne_bytes()).collect(),
    };
    let mut child = Command::new(folder.join("main"))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("what was compiled");
    let mut input = child.stdin.take().expect("a pipe");
    let writer = std::thread::spawn(move || input.write_all(&bytes));
    let output = child.wait_with_output().expect("an end");
    writer.join().expect("a writer").expect("all was read");
    assert!(output.status.success(), "{}: {}", output.status, String::from_utf8_lossy(&output.stderr));
    let mut numbers: Box<dyn Iterator<Item = f64>> = match precision {
        Precision::F64 => Box::new(output.stdout.as_chunks().0.iter().map(|x| f64::from_ne_bytes(*x))),
        Precision::F32 => Box::new(output.stdout.as_chunks().0.iter().map(|x| f32::from_ne_bytes(*x).into())),
    };
    let mut array = |length: usize| {
        let array: Vec<f64> = numbers.by_ref().take(length).collect();
        assert_eq!(array.len(), length);
        array
    };
    let of_call = |call: &&Call| {
        let (_, lengths) = call.lengths();
        call.states.iter().map(|_| lengths.iter().map(|&length| array(length)).collect()).collect()
    };
    let results = calls.iter().map(of_call).collect();
    assert_eq!(numbers.count(), 0);
    results
}
