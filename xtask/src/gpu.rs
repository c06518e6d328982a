//! The GPU kernels: counted in their code (`gpu-report`), and measured on a GPU (`gpu-bench`). NVIDIA's compiler and
//! disassembler come from PyPI, into an environment of their own.

mod shares;

use crate::command;
use crate::oracles;
use crate::report::Outcome;
use crate::stamp::Stamp;
use crate::venv;
use crate::workspace::Workspace;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

const REQUIREMENTS: &str = "benches/requirements-gpu.txt";
/// The environment, whose NVRTC the tests of mozzi-gpu use, too.
const FOLDER: &str = "target/nvidia";

const COUNTED: &str = "docs/gpu.md";
const MEASURED: &str = "benches/GPU.md";
/// The script that measures other libraries beside mozzi, and the variable that names the Python for it.
const PEERS: &str = "benches/gpu/peers.py";
const PYTHON: &str = "MOZZI_GPU_PYTHON";

pub fn report(workspace: &Workspace, options: &[&str]) -> Outcome {
    run(workspace, "report", COUNTED, options)
}

pub fn bench(workspace: &Workspace, options: &[&str]) -> Outcome {
    match run(workspace, "bench", MEASURED, options) {
        Outcome::Passed(_) if is_whole(options) => add_peers(workspace),
        outcome => outcome,
    }
}

/// Whether the options leave the page whole.
fn is_whole(options: &[&str]) -> bool {
    !options.iter().any(|option| ["--only", "--quantity", "--states", "--page"].contains(option))
}

/// Other libraries' speeds, at the end of the measured page.
fn add_peers(workspace: &Workspace) -> Outcome {
    let Some(python) = std::env::var_os(PYTHON) else {
        return Outcome::Passed(format!(
            "without other libraries: {PYTHON} names no Python that has them, see {PEERS}"
        ));
    };
    let added = command::output(Command::new(python).arg(workspace.path(PEERS))).and_then(|(succeeded, table)| {
        if !succeeded {
            return Err(format!("{PEERS} failed"));
        }
        let page = workspace.path(MEASURED);
        let opened = std::fs::OpenOptions::new().append(true).open(page);
        opened.and_then(|mut page| page.write_all(table.as_bytes())).map_err(|error| format!("{MEASURED}: {error}"))
    });
    added.map_or_else(Outcome::Failed, |()| Outcome::Passed(String::new()))
}

/// Writes the share of the counted bounds into the measured page.
fn compare(workspace: &Workspace) -> Result<(), String> {
    let read = |name: &str| std::fs::read_to_string(workspace.path(name)).map_err(|error| format!("{name}: {error}"));
    let page = shares::add(&read(MEASURED)?, &read(COUNTED)?);
    std::fs::write(workspace.path(MEASURED), page).map_err(|error| format!("{MEASURED}: {error}"))
}

fn run(workspace: &Workspace, example: &str, page: &str, options: &[&str]) -> Outcome {
    let tools = match install(workspace) {
        Ok(packages) => packages.join("nvidia/cu13"),
        Err(why) => return Outcome::Failed(why),
    };
    let mut cargo = workspace.cargo(&["run", "--release", "--package", "mozzi-gpu", "--example", example, "--"]);
    cargo.args(options);
    if std::env::var_os("MOZZI_NVRTC").is_none() {
        cargo.env("MOZZI_NVRTC", tools.join("lib/libnvrtc.so.13"));
    }
    if example == "report" {
        cargo.arg("--nvdisasm").arg(tools.join("bin/nvdisasm"));
    }
    match (std::env::var_os("MOZZI_ROBOTS").map(PathBuf::from)).or_else(|| oracles::robots(workspace)) {
        Some(robots) => {
            cargo.arg("--robots").arg(robots);
        }
        None => println!("without Talos: MOZZI_ROBOTS does not name the folder of example-robot-data"),
    }
    if is_whole(options) {
        cargo.arg("--page").arg(workspace.path(page));
    }
    match command::run(cargo).and_then(|()| compare(workspace)) {
        Ok(()) => Outcome::Passed(String::new()),
        Err(why) => Outcome::Failed(why),
    }
}

/// Installs the packages; returns their folder.
fn install(workspace: &Workspace) -> Result<PathBuf, String> {
    let folder = workspace.path(FOLDER);
    let text =
        std::fs::read_to_string(workspace.path(REQUIREMENTS)).map_err(|error| format!("{REQUIREMENTS}: {error}"))?;
    let python = folder.join("bin/python");
    let stamp = Stamp::new(folder.join("requirements.stamp"), text);
    if !stamp.is_fresh() {
        stamp.remove()?;
        command::run(Command::new("python3").args(["-m", "venv", "--clear"]).arg(&folder))?;
        venv::pip(workspace, &python, &[], REQUIREMENTS)?;
        stamp.write()?;
    }
    packages(&folder)
}

/// The folder `site-packages` of an environment.
fn packages(environment: &Path) -> Result<PathBuf, String> {
    let versions = std::fs::read_dir(environment.join("lib")).into_iter().flatten().filter_map(Result::ok);
    let mut folders = versions.map(|version| version.path().join("site-packages")).filter(|folder| folder.is_dir());
    folders.next().ok_or_else(|| format!("{}: no site-packages", environment.display()))
}

#[cfg(test)]
mod tests {
    use super::packages;

    #[test]
    fn the_folder_of_packages_is_found_whatever_the_version() {
        let folder = std::env::temp_dir().join(format!("mozzi-gpu-{}", std::process::id()));
        assert!(packages(&folder).is_err());
        let inner = folder.join("lib/python3.12/site-packages");
        std::fs::create_dir_all(&inner).expect("a folder");
        assert_eq!(packages(&folder), Ok(inner));
        std::fs::remove_dir_all(&folder).expect("the folder");
    }
}
