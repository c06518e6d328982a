//! Runs the program `mozzi`, and the commands of a page that draw its pictures.

use crate::Place;
use crate::text;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The standard output of a run of `mozzi` in the repository's root.
pub fn output(place: &Place, arguments: &[&str]) -> Result<String, String> {
    let found = Command::new(&place.mozzi).args(arguments).current_dir(&place.root).stdin(Stdio::null()).output();
    let found = found.map_err(|error| format!("{}: {error}", place.mozzi.display()))?;
    if !found.status.success() {
        let errors = String::from_utf8_lossy(&found.stderr);
        return Err(format!("`mozzi {}` ended with {}: {errors}", arguments.join(" "), found.status));
    }
    String::from_utf8(found.stdout).map_err(|_| format!("`mozzi {}` printed no text", arguments.join(" ")))
}

/// Runs a block of shell commands in an empty folder; the pictures that it made.
pub fn draw(place: &Place, folder: &Path, script: &str) -> Result<Vec<PathBuf>, String> {
    let failed = |error: std::io::Error| format!("{}: {error}", folder.display());
    std::fs::create_dir_all(folder).map_err(failed)?;
    let programs = place.mozzi.parent().map(Path::to_path_buf).into_iter();
    let paths = std::env::var_os("PATH").unwrap_or_default();
    let paths =
        std::env::join_paths(programs.chain(std::env::split_paths(&paths))).map_err(|error| error.to_string())?;
    let mut shell = Command::new("sh");
    let found = shell.args(["-e", "-c", script]).current_dir(folder).env("PATH", paths).stdin(Stdio::null()).output();
    let found = found.map_err(|error| format!("sh: {error}"))?;
    if !found.status.success() {
        return Err(format!("{script}\nended with {}: {}", found.status, String::from_utf8_lossy(&found.stderr)));
    }
    let pictures =
        text::files(folder)?.into_iter().filter(|file| file.extension().is_some_and(|ending| ending == "svg"));
    Ok(pictures.collect())
}
