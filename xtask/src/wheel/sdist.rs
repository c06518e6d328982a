//! The source distribution: written twice with the same bytes; and a wheel built from it elsewhere, without a network,
//! is the same file as the wheel of the workspace.

use super::maturin::{self, Sources};
use super::{FOLDER, name, only_file};
use crate::command;
use crate::report::Outcome;
use crate::stamp;
use crate::workspace::Workspace;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

/// Writes it next to the wheel.
pub fn write(workspace: &Workspace) -> Outcome {
    let written = || {
        let folder = workspace.path(FOLDER);
        maturin::sdist(workspace, &folder)?;
        let file = find(workspace)?;
        let again = workspace.scratch("sdist-again")?;
        maturin::sdist(workspace, &again)?;
        let bytes = same_bytes(&file, &only_file(&again)?)?;
        Ok(format!("{}, {:.2} MB; written again it is the same file", name(&file), bytes as f64 / 1e6))
    };
    written().map_or_else(Outcome::Failed, Outcome::Passed)
}

/// Builds a wheel from it, in another folder and with nothing built yet, and compares it with this one.
pub fn build(workspace: &Workspace, wheel: &Path) -> Outcome {
    let built = || {
        let folder = workspace.scratch("sdist")?;
        command::run(Command::new("tar").arg("-xzf").arg(find(workspace)?).arg("-C").arg(&folder))?;
        let root = only_file(&folder)?;
        let sources = Sources { target: root.join("target"), project: root.clone(), root, offline: true };
        let wheels = workspace.scratch("sdist-wheel")?;
        let start = Instant::now();
        maturin::build(workspace, &sources, &wheels)?;
        let minutes = start.elapsed().as_secs_f64() / 60.0;
        let again = only_file(&wheels)?;
        same_bytes(wheel, &again)?;
        let bytes = std::fs::read(&again).map_err(|error| format!("{}: {error}", again.display()))?;
        let hash = stamp::fnv(bytes);
        Ok(format!("{} built offline in {minutes:.1} min is the workspace's, FNV-1a {hash}", name(&again)))
    };
    built().map_or_else(Outcome::Failed, Outcome::Passed)
}

fn find(workspace: &Workspace) -> Result<PathBuf, String> {
    let entries = std::fs::read_dir(workspace.path(FOLDER)).map_err(|error| format!("{FOLDER}: {error}"))?;
    let mut files = entries.flatten().map(|entry| entry.path());
    let file = files.find(|path| path.extension().is_some_and(|end| end == "gz"));
    file.ok_or_else(|| format!("maturin left no source distribution in {FOLDER}"))
}

/// The number of bytes, if two files have the same ones.
fn same_bytes(one: &Path, other: &Path) -> Result<usize, String> {
    let read = |file: &Path| std::fs::read(file).map_err(|error| format!("{}: {error}", file.display()));
    let (a, b) = (read(one)?, read(other)?);
    match a.iter().zip(&b).position(|(a, b)| a != b) {
        None if a.len() == b.len() => Ok(a.len()),
        place => Err(format!(
            "{} ({} bytes) and {} ({} bytes) differ from byte {} on",
            one.display(),
            a.len(),
            other.display(),
            b.len(),
            place.unwrap_or(a.len().min(b.len()))
        )),
    }
}
