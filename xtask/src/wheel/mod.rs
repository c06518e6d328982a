//! The wheel for Linux: built for old systems, too, limited in size, and tested with the README's examples in an
//! environment that contains only the wheel. The tests do the latter with a wheel of the library that they built.

mod environment;
mod maturin;
mod sdist;

use crate::command;
use crate::package;
use crate::report::{Outcome, Report};
use crate::venv;
use crate::workspace::Workspace;
use maturin::Sources;
pub use maturin::recompress;
use std::path::{Path, PathBuf};
use std::process::Command;

const PACKAGE: &str = "crates/mozzi-py";
/// Wheels and the source distribution.
const FOLDER: &str = "target/wheels";
/// maturin, zig for its linker and its C libraries of old versions, and a compressor.
pub const TOOLS: &str = "crates/mozzi-py/requirements-wheel.txt";
/// The largest size of a wheel; docs/weight.md has the budget that it is to reach.
const MOST_BYTES: u64 = 9_500_000;

const ELSEWHERE: &str = "\
on macOS and Windows: `pip install maturin`, then `maturin build --release` in crates/mozzi-py; both need Rust, Windows also
Microsoft's C++ build tools. For macOS from Linux, zig needs Apple's SDK (SDKROOT); for Windows, `--target x86_64-pc-windows-msvc`
with cargo-xwin. AArch64 Linux from x86-64: `rustup target add aarch64-unknown-linux-gnu`, then `maturin build --release --zig
--compatibility manylinux_2_28 --target aarch64-unknown-linux-gnu`.";

/// The wheel; with `sdist` also the source distribution, from which the wheel is built once more.
pub fn run(workspace: &Workspace, sdist: bool, report: &mut Report) {
    report.step("Python environment", || venv::prepare(workspace));
    report.step("maturin and zig", || venv::add(workspace, TOOLS));
    let mut wheel = Err("there is no wheel".to_owned());
    report.step("wheel", || {
        wheel = build(workspace);
        let sized = wheel.as_ref().map_err(String::clone).and_then(|wheel| check_size(wheel));
        sized.map_or_else(Outcome::Failed, Outcome::Passed)
    });
    report.step("installation of the wheel", || match &wheel {
        Ok(wheel) => environment::install(workspace, wheel, true).map_or_else(Outcome::Failed, Outcome::Passed),
        Err(why) => Outcome::Skipped(why.clone()),
    });
    if sdist {
        report.step("source distribution", || sdist::write(workspace));
        report.step("wheel of the source distribution", || match &wheel {
            Ok(wheel) => sdist::build(workspace, wheel),
            Err(why) => Outcome::Skipped(why.clone()),
        });
    }
    println!("{ELSEWHERE}");
}

fn build(workspace: &Workspace) -> Result<PathBuf, String> {
    let sources = Sources::of_workspace(workspace);
    let wheels = workspace.fresh_folder(FOLDER)?;
    maturin::build(workspace, &sources, &wheels)?;
    only_file(&wheels)
}

fn check_size(wheel: &Path) -> Result<String, String> {
    let bytes = std::fs::metadata(wheel).map_err(|error| format!("{}: {error}", wheel.display()))?.len();
    if bytes > MOST_BYTES {
        return Err(format!("{} has {bytes} bytes, expected at most {MOST_BYTES}", wheel.display()));
    }
    Ok(format!("{}, {:.2} MB", name(wheel), bytes as f64 / 1e6))
}

/// The tests' build as a wheel: maturin writes the metadata for pip, the files are those of `target/python`. So nothing
/// is compiled; only [`build`] checks that `maturin build` packs the same files.
pub fn test(workspace: &Workspace) -> Outcome {
    match pack(workspace, &package::folder(workspace)).and_then(|wheel| environment::install(workspace, &wheel, false))
    {
        Ok(note) => Outcome::Passed(note),
        Err(why) => Outcome::Failed(why),
    }
}

/// A wheel of the package in this folder.
pub fn pack(workspace: &Workspace, from: &Path) -> Result<PathBuf, String> {
    let (files, wheels) = (workspace.scratch("wheel-files")?, workspace.scratch("wheels")?);
    package::copy(&from.join("mozzi"), &files.join("mozzi"))?;
    let mut maturin = Command::new(venv::python(workspace));
    maturin.current_dir(workspace.path(PACKAGE)).args(["-m", "maturin", "pep517", "write-dist-info"]);
    command::run(maturin.arg("--metadata-directory").arg(&files))?;
    let mut pack = Command::new(venv::python(workspace));
    command::run(pack.args(["-m", "wheel", "pack", "--dest-dir"]).arg(&wheels).arg(&files))?;
    only_file(&wheels)
}

fn only_file(folder: &Path) -> Result<PathBuf, String> {
    let entries = std::fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut files = entries.filter_map(Result::ok).map(|entry| entry.path());
    files.next().ok_or_else(|| format!("maturin left nothing in {}", folder.display()))
}

fn name(file: &Path) -> String {
    file.file_name().unwrap_or_default().to_string_lossy().into_owned()
}
