//! The Python environment of the tests: `target/venv` with `oracles/requirements.txt`.

use crate::command;
use crate::report::Outcome;
use crate::stamp::Stamp;
use crate::workspace::Workspace;
use std::path::PathBuf;
use std::process::Command;

const REQUIREMENTS: &str = "oracles/requirements.txt";

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

/// Create it if there is none that works, install the requirements if they changed.
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
    let Ok(requirements) = std::fs::read_to_string(workspace.path(REQUIREMENTS)) else {
        return Ok(Outcome::Skipped(format!("nothing to install: there is no {REQUIREMENTS} yet")));
    };
    let stamp = Stamp::new(workspace.path("target/venv/requirements.stamp"), requirements);
    if stamp.is_fresh() {
        return Ok(Outcome::Passed(format!("{REQUIREMENTS} is installed already")));
    }
    stamp.remove()?;
    let mut pip = Command::new(python(workspace));
    pip.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-input", "-r"]);
    command::run(pip.arg(workspace.path(REQUIREMENTS)))?;
    stamp.write()?;
    Ok(Outcome::Passed(format!("installed {REQUIREMENTS}")))
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
