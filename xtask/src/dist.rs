//! Archives of the C and C++ library for Linux, one for each kind of processor, by CMake's own install rules: zig links
//! against the glibc of 2018, so that they run on old systems, too. The archive of this machine is unpacked, and the
//! program of docs/cpp.md is built with it.

use crate::command;
use crate::glibc;
use crate::report::{Outcome, Report};
use crate::venv;
use crate::workspace::Workspace;
use crate::zig::{self, GLIBC};
use std::path::{Path, PathBuf};
use std::process::Command;

/// cargo-zigbuild and zig.
const TOOLS: &str = "crates/mozzi-c/requirements-dist.txt";
const FOLDER: &str = "target/dist";
/// cargo's results, of the Debian package, too.
pub const CARGO: &str = "target/dist/cargo";
const ARCHITECTURES: [&str; 2] = ["x86_64", "aarch64"];
/// The largest size of the shared library without symbols: half of it are kernels (docs/performance-log.md).
const MOST_BYTES: u64 = 12_000_000;

pub fn run(workspace: &Workspace, report: &mut Report) {
    report.step("Python environment", || venv::prepare(workspace));
    report.step("zig", || venv::add(workspace, TOOLS));
    for architecture in ARCHITECTURES {
        report.step(&format!("archive for {architecture}"), || match archive(workspace, architecture) {
            Ok(outcome) => outcome,
            Err(why) => Outcome::Failed(why),
        });
    }
}

fn archive(workspace: &Workspace, architecture: &str) -> Result<Outcome, String> {
    let triple = format!("{architecture}-unknown-linux-gnu");
    if !has_standard_library(&triple)? {
        return Ok(Outcome::Skipped(format!("`rustup target add {triple}` installs what it needs")));
    }
    let (build, cargo) = (workspace.path(FOLDER).join(architecture), workspace.path(CARGO));
    let name = format!("mozzi-{}-{architecture}-linux", workspace.version()?);
    let stage = workspace.fresh_folder(&format!("{FOLDER}/{name}"))?;
    let mut configure = tool(workspace, "cmake")?;
    configure.arg("-S").arg(&workspace.root).arg("-B").arg(&build);
    configure.args(["-DMOZZI_CARGO_BUILD=zigbuild", "-DMOZZI_CARGO_PROFILE=library"]);
    configure.args(["-DMOZZI_BUILD_EXAMPLES=OFF", "-DCMAKE_INSTALL_LIBDIR=lib"]);
    configure.arg(format!("-DMOZZI_CARGO_TARGET={triple}.2.{GLIBC}"));
    command::run(configure.arg(format!("-DMOZZI_CARGO_FOLDER={}", cargo.display())))?;
    command::run(tool(workspace, "cmake")?.arg("--build").arg(&build))?;
    command::run(tool(workspace, "cmake")?.arg("--install").arg(&build).arg("--prefix").arg(&stage))?;

    let (library, bytes) = shared_library(&stage)?;
    let newest = glibc::newest(&bytes).ok_or_else(|| format!("{} names no version of glibc", library.display()))?;
    if newest > GLIBC {
        return Err(format!("{} needs glibc 2.{newest}, expected at most 2.{GLIBC}", library.display()));
    }
    if bytes.len() as u64 > MOST_BYTES {
        return Err(format!("{} has {} bytes, expected at most {MOST_BYTES}", library.display(), bytes.len()));
    }
    let file = workspace.path(FOLDER).join(format!("{name}.tar.gz"));
    let mut tar = Command::new("tar");
    command::run(tar.arg("-czf").arg(&file).arg("-C").arg(workspace.path(FOLDER)).arg(&name))?;
    let used = if architecture == std::env::consts::ARCH { use_it(workspace, &file, &name)? } else { String::new() };
    let megabytes = bytes.len() as f64 / 1e6;
    Ok(Outcome::Passed(format!("{}, shared library {megabytes:.2} MB, glibc 2.{newest}{used}", file.display())))
}

/// Whether this compiler has the standard library for a target.
fn has_standard_library(triple: &str) -> Result<bool, String> {
    let mut rustc = Command::new(std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()));
    let (found, folder) = command::output(rustc.args(["--print", "target-libdir", "--target", triple]))?;
    Ok(found && Path::new(folder.trim()).is_dir())
}

/// A program that builds by cargo-zigbuild.
fn tool(workspace: &Workspace, program: &str) -> Result<Command, String> {
    let mut command = Command::new(program);
    zig::prepare(workspace, &mut command)?;
    Ok(command)
}

fn shared_library(stage: &Path) -> Result<(PathBuf, Vec<u8>), String> {
    let folder = stage.join("lib");
    let entries = std::fs::read_dir(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let file = entries.filter_map(Result::ok).map(|entry| entry.path()).find(|path| {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        name.starts_with("libmozzi.so.")
    });
    let file = file.ok_or_else(|| format!("{} has no libmozzi.so", folder.display()))?;
    let bytes = std::fs::read(&file).map_err(|error| format!("{}: {error}", file.display()))?;
    Ok((file, bytes))
}

/// Unpacks the archive, builds the first program of docs/cpp.md with it, and runs it; the time that a user waits.
fn use_it(workspace: &Workspace, archive: &Path, name: &str) -> Result<String, String> {
    let scratch = workspace.scratch("dist")?;
    command::run(Command::new("tar").arg("-xzf").arg(archive).arg("-C").arg(&scratch))?;
    let page = "docs/cpp.md";
    let text = std::fs::read_to_string(workspace.path(page)).map_err(|error| format!("{page}: {error}"))?;
    for (language, file) in [("cpp", "main.cpp"), ("cmake", "CMakeLists.txt")] {
        let block = text.split(&format!("```{language}\n")).nth(1).and_then(|rest| rest.split("```").next());
        let block = block.ok_or_else(|| format!("{page} has no block of {language}"))?;
        std::fs::write(scratch.join(file), block).map_err(|error| format!("{file}: {error}"))?;
    }
    let begin = std::time::Instant::now();
    let mut configure = Command::new("cmake");
    configure.arg("-S").arg(&scratch).arg("-B").arg(scratch.join("build"));
    command::run(configure.arg(format!("-DCMAKE_PREFIX_PATH={}", scratch.join(name).display())))?;
    command::run(Command::new("cmake").arg("--build").arg(scratch.join("build")))?;
    let seconds = begin.elapsed().as_secs_f64();
    command::run(Command::new(scratch.join("build/main")).current_dir(&scratch))?;
    Ok(format!("; the program of {page} was configured and built in {seconds:.1} s, and ran"))
}
