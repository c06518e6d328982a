//! The wheel for Linux: built for old systems, too, limited in size, and tested with the README's examples in an
//! environment that contains only the wheel. The tests do the latter with a wheel of the library that they built.

use crate::command;
use crate::package;
use crate::report::Outcome;
use crate::venv;
use crate::workspace::Workspace;
use std::path::{Path, PathBuf};
use std::process::Command;

const PACKAGE: &str = "crates/mozzi-py";
/// maturin, and zig for its linker and its C libraries of old versions.
const TOOLS: &str = "crates/mozzi-py/requirements-wheel.txt";
const MOST_BYTES: u64 = 5_000_000;

const ELSEWHERE: &str = "\
on macOS and Windows: `pip install maturin`, then `maturin build --release` in crates/mozzi-py; both need Rust, Windows also
Microsoft's C++ build tools. For macOS from Linux, zig needs Apple's SDK (SDKROOT); for Windows, `--target x86_64-pc-windows-msvc`
with cargo-xwin. AArch64 Linux: `--target aarch64-unknown-linux-gnu --zig`, after `rustup target add`.";

/// Build it, check its size, install it into an empty environment and run the README's Python there.
pub fn build(workspace: &Workspace) -> Outcome {
    match try_build(workspace) {
        Ok(note) => {
            println!("{ELSEWHERE}");
            Outcome::Passed(note)
        }
        Err(why) => Outcome::Failed(why),
    }
}

fn try_build(workspace: &Workspace) -> Result<String, String> {
    let mut pip = Command::new(venv::python(workspace));
    pip.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-input", "-r"]);
    command::run(pip.arg(workspace.path(TOOLS)))?;
    let wheels = workspace.fresh_folder("target/wheels")?;
    let mut maturin = Command::new(venv::python(workspace));
    maturin.current_dir(workspace.path(PACKAGE)).args(["-m", "maturin", "build", "--release", "--out"]).arg(&wheels);
    if cfg!(target_os = "linux") {
        maturin.args(["--zig", "--compatibility", "manylinux_2_17"]);
    }
    // maturin finds zig as a module of the first Python in PATH
    let bin = venv::python(workspace).parent().map(Path::to_path_buf).unwrap_or_default();
    let path = std::env::var_os("PATH").unwrap_or_default();
    let path = std::env::join_paths(std::iter::once(bin).chain(std::env::split_paths(&path)));
    command::run(maturin.env("PATH", path.map_err(|error| error.to_string())?))?;
    let wheel = only_file(&wheels)?;
    let bytes = std::fs::metadata(&wheel).map_err(|error| format!("{}: {error}", wheel.display()))?.len();
    if bytes > MOST_BYTES {
        return Err(format!("{} has {bytes} bytes, expected at most {MOST_BYTES}", wheel.display()));
    }

    let name = wheel.file_name().unwrap_or_default().to_string_lossy().into_owned();
    Ok(format!("{name}, {:.2} MB; {}", bytes as f64 / 1e6, install(workspace, &wheel)?))
}

/// The tests' build as a wheel: maturin writes the metadata for pip, the files are those of `target/python`. So nothing
/// is compiled; only [`build`] checks that `maturin build` packs the same files.
pub fn test(workspace: &Workspace) -> Outcome {
    match pack(workspace).and_then(|wheel| install(workspace, &wheel)) {
        Ok(note) => Outcome::Passed(note),
        Err(why) => Outcome::Failed(why),
    }
}

fn pack(workspace: &Workspace) -> Result<PathBuf, String> {
    let (files, wheels) = (workspace.scratch("wheel-files")?, workspace.scratch("wheels")?);
    package::copy(&package::folder(workspace).join("mozzi"), &files.join("mozzi"))?;
    let mut maturin = Command::new(venv::python(workspace));
    maturin.current_dir(workspace.path(PACKAGE)).args(["-m", "maturin", "pep517", "write-dist-info"]);
    command::run(maturin.arg("--metadata-directory").arg(&files))?;
    let mut pack = Command::new(venv::python(workspace));
    command::run(pack.args(["-m", "wheel", "pack", "--dest-dir"]).arg(&wheels).arg(&files))?;
    only_file(&wheels)
}

/// Installs a wheel into an empty environment and runs the README's Python there.
fn install(workspace: &Workspace, wheel: &Path) -> Result<String, String> {
    let home = workspace.fresh_folder("target/wheel-venv")?;
    let mut create = Command::new(venv::python(workspace));
    command::run(create.args(["-m", "venv"]).arg(&home))?;
    let python = home.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    let mut install = Command::new(&python);
    command::run(install.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check"]).arg(wheel))?;
    let scratch = workspace.scratch("wheel")?;
    let readme = format!("{PACKAGE}/README.md");
    let text = std::fs::read_to_string(workspace.path(&readme)).map_err(|error| format!("{readme}: {error}"))?;
    let program = python_of(&text);
    if program.is_empty() {
        return Err(format!("{readme} has no Python to run"));
    }
    std::fs::write(scratch.join("readme.py"), program).map_err(|error| error.to_string())?;
    command::run(Command::new(&python).arg("readme.py").current_dir(&scratch).env_remove("PYTHONPATH"))?;
    Ok(format!("{readme} runs where nothing else is installed"))
}

fn only_file(folder: &Path) -> Result<PathBuf, String> {
    let entries = std::fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut files = entries.filter_map(Result::ok).map(|entry| entry.path());
    files.next().ok_or_else(|| format!("maturin left no wheel in {}", folder.display()))
}

/// The code blocks between ```python and ```, in order.
fn python_of(text: &str) -> String {
    let blocks = text.split("```python\n").skip(1).filter_map(|rest| rest.split("```").next());
    blocks.collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::python_of;

    #[test]
    fn python_is_taken_out_of_a_text() {
        let text = "a\n```python\nx = 1\n```\nb\n```console\n$ c\n```\n```python\nprint(x)\n```\n";
        assert_eq!(python_of(text), "x = 1\n\nprint(x)\n");
        assert_eq!(python_of("none"), "");
    }
}
