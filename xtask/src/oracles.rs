//! Makes the reference numbers with the scripts of `oracles/`: `make.py` with Pinocchio on the robots of
//! example-robot-data, with fixed bases, `make_floating.py` with floating bases, `make_mjcf.py` with MuJoCo on the
//! models of gymnasium and dm_control.

use crate::command;
use crate::report::Outcome;
use crate::stamp::Stamp;
use crate::venv;
use crate::workspace::Workspace;
use std::path::PathBuf;
use std::process::Command;

/// Each script, and the subfolder for its files in the folder of numbers.
const SCRIPTS: [(&str, &str); 3] =
    [("oracles/make.py", ""), ("oracles/make_floating.py", "floating"), ("oracles/make_mjcf.py", "")];
const STATES: &str = "100";

/// Finds the example_robot_data robots: the package has no Python module, but it lists its files.
const ROBOTS: &str = "\
import importlib.metadata as metadata, pathlib
try:
    files = metadata.files('example-robot-data') or []
except metadata.PackageNotFoundError:
    files = []
for file in files:
    parents = pathlib.Path(file.locate()).resolve().parents
    folders = [p for p in parents if p.name == 'robots' and p.parent.name == 'example-robot-data']
    if folders:
        print(folders[0])
        break";

/// Make them, unless they already exist for the same sources.
pub fn make(workspace: &Workspace) -> Outcome {
    match try_make(workspace) {
        Ok(note) => Outcome::Passed(note),
        Err(why) => Outcome::Failed(why),
    }
}

fn try_make(workspace: &Workspace) -> Result<String, String> {
    robots(workspace).ok_or("the robots of example-robot-data are not installed")?;
    let stamp = stamp(workspace)?;
    if stamp.is_fresh() {
        return Ok("made already".into());
    }
    let folder = workspace.fresh_folder("target/oracles")?; // also removes the stamp
    for (script, part) in SCRIPTS {
        let mut python = Command::new(venv::python(workspace));
        python.current_dir(&workspace.root).arg(script).args(["--states", STATES, "--out"]);
        command::run(python.arg(folder.join(part)))?;
    }
    stamp.write()?;
    Ok(format!("{STATES} states a robot"))
}

/// The finished folder of reference numbers; none if it does not exist, or the sources have changed.
pub fn folder(workspace: &Workspace) -> Option<PathBuf> {
    stamp(workspace).ok()?.is_fresh().then(|| workspace.path("target/oracles"))
}

/// The folder of the robots' URDF files, found with Python.
pub fn robots(workspace: &Workspace) -> Option<PathBuf> {
    let (_, text) = command::output(Command::new(venv::python(workspace)).args(["-c", ROBOTS])).ok()?;
    let folder = text.trim();
    (!folder.is_empty()).then(|| PathBuf::from(folder))
}

/// The sources of the numbers: scripts, requirements, robots and models under `oracles/`, and the embedded robots.
fn stamp(workspace: &Workspace) -> Result<Stamp, String> {
    let mut files = Vec::new();
    let folders = [
        ("oracles", &["py", "txt", "urdf", "xml"][..]),
        ("oracles/parts", &["xml"]),
        ("oracles/floating", &["urdf"]),
        ("crates/mozzi-urdf/models", &["urdf"]),
    ];
    for (folder, endings) in folders {
        let Ok(entries) = std::fs::read_dir(workspace.path(folder)) else { continue };
        let paths = entries.filter_map(Result::ok).map(|entry| entry.path());
        files.extend(paths.filter(|path| path.extension().is_some_and(|e| endings.iter().any(|known| e == *known))));
    }
    files.sort();
    let mut text = format!("states {STATES}\n");
    for file in files {
        let source = std::fs::read_to_string(&file).map_err(|error| format!("{}: {error}", file.display()))?;
        let name = file.strip_prefix(&workspace.root).unwrap_or(&file).display().to_string();
        text += &format!("--- {name}\n{source}");
    }
    Ok(Stamp::new(workspace.path("target/oracles/sources.stamp"), text))
}
