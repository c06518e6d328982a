//! `cargo xtask deb`: a Debian package with the command line, its completions and manual, and the C and C++ library,
//! packed by dpkg-deb from a folder that looks like the system's. It is linked by zig against the glibc of 2018,
//! among the results of `cargo xtask dist`, so that what both contain is compiled once.

mod control;
mod trial;

use crate::command;
use crate::dist;
use crate::report::{Outcome, Report};
use crate::sbom;
use crate::third_party;
use crate::venv;
use crate::workspace::Workspace;
use crate::zig;
use control::Package;
use std::path::{Path, PathBuf};
use std::process::Command;

const FOLDER: &str = "target/deb";
/// cargo-zigbuild and zig.
const TOOLS: &str = "crates/mozzi-c/requirements-dist.txt";
/// The largest size of the program `mozzi` without symbols; docs/weight.md has today's.
const MOST_BYTES: u64 = 22_000_000;

/// Where the completions of each shell are found.
const COMPLETIONS: [(&str, &str); 3] = [
    ("bash", "usr/share/bash-completion/completions/mozzi"),
    ("zsh", "usr/share/zsh/vendor-completions/_mozzi"),
    ("fish", "usr/share/fish/vendor_completions.d/mozzi.fish"),
];

pub fn run(workspace: &Workspace, report: &mut Report) {
    let missing =
        ["dpkg-deb", "cmake", "strip", "gzip"].into_iter().find(|name| !command::exists(&mut Command::new(name)));
    let mut file = Err("it was not built".to_owned());
    if missing.is_none() {
        report.step("Python environment", || venv::prepare(workspace));
        report.step("zig", || venv::add(workspace, TOOLS));
    }
    report.step("Debian package", || {
        if let Some(missing) = missing {
            return Outcome::Skipped(format!("{missing} is not installed"));
        }
        let built = build(workspace);
        file = built.as_ref().map(|(file, _)| file.clone()).map_err(String::clone);
        built.map_or_else(Outcome::Failed, |(_, note)| Outcome::Passed(note))
    });
    report.step("installation of the Debian package", || match &file {
        Ok(file) => trial::run(workspace, file),
        Err(why) => Outcome::Skipped(why.clone()),
    });
    report.step("lintian", || match &file {
        Ok(file) if command::exists(&mut Command::new("lintian")) => trial::lintian(file),
        Ok(_) => Outcome::Skipped("lintian is not installed".into()),
        Err(why) => Outcome::Skipped(why.clone()),
    });
}

/// The package's file, and its sizes.
fn build(workspace: &Workspace) -> Result<(PathBuf, String), String> {
    let package = Package::of_this_machine(workspace.version()?)?;
    let stage = workspace.fresh_folder(&format!("{FOLDER}/stage"))?;
    let program = command_line(workspace, &stage, &package)?;
    let library = library(workspace, &stage, &package)?;
    documents(workspace, &stage, &program, &package)?;
    let binaries = [stage.join("usr/bin/mozzi"), library];
    for binary in &binaries {
        command::run(Command::new("strip").args(["--strip-unneeded", "--remove-section=.comment"]).arg(binary))?;
    }
    let sizes = binaries.iter().map(|binary| size(binary)).collect::<Result<Vec<_>, _>>()?;
    if sizes[0] > MOST_BYTES {
        return Err(format!("mozzi has {} bytes, expected at most {MOST_BYTES}", sizes[0]));
    }
    permissions(&stage)?;
    package.write_control(&stage, &binaries)?;

    let file = workspace.path(FOLDER).join(package.file_name());
    let mut pack = Command::new("dpkg-deb");
    pack.args(["--root-owner-group", "-Zxz", "--build"]).arg(&stage).arg(&file);
    if let Some(seconds) = workspace.time_of_commit() {
        pack.env("SOURCE_DATE_EPOCH", seconds);
    }
    command::run(pack)?;
    let megabytes = |bytes: u64| bytes as f64 / 1e6;
    let note = format!(
        "{}, {:.2} MB: mozzi {:.2} MB, shared library {:.2} MB",
        file.display(),
        megabytes(size(&file)?),
        megabytes(sizes[0]),
        megabytes(sizes[1])
    );
    Ok((file, note))
}

fn size(file: &Path) -> Result<u64, String> {
    Ok(std::fs::metadata(file).map_err(|error| format!("{}: {error}", file.display()))?.len())
}

/// Builds the program and copies it; its place among cargo's results.
fn command_line(workspace: &Workspace, stage: &Path, package: &Package) -> Result<PathBuf, String> {
    let mut cargo = workspace.cargo(&[
        "zigbuild",
        "--profile",
        "dist",
        "--locked",
        "--package",
        "mozzi-cli",
        "--features",
        "arrow",
        "--target",
    ]);
    cargo.arg(package.target()).arg("--target-dir").arg(workspace.path(dist::CARGO));
    zig::prepare(workspace, &mut cargo)?;
    let commit = std::env::var("MOZZI_COMMIT").ok();
    if let Some(commit) = commit.or_else(|| workspace.git(&["rev-parse", "--short=12", "HEAD"])) {
        cargo.env("MOZZI_COMMIT", commit);
    }
    command::run(cargo)?;
    let built = workspace.path(dist::CARGO).join(package.triple()).join("dist/mozzi");
    copy(&built, &stage.join("usr/bin/mozzi"))?;
    Ok(built)
}

/// Installs headers, shared library, CMake package and pkg-config file by CMake's rules; the shared library's place.
/// The static library is left out: it is five times as large as everything else.
fn library(workspace: &Workspace, stage: &Path, package: &Package) -> Result<PathBuf, String> {
    let build = workspace.path(FOLDER).join("cmake");
    let folder = format!("lib/{}", package.multiarch());
    let mut configure = Command::new("cmake");
    configure.arg("-S").arg(&workspace.root).arg("-B").arg(&build);
    configure.args(["-DMOZZI_CARGO_BUILD=zigbuild", "-DMOZZI_CARGO_PROFILE=library"]);
    configure.args(["-DMOZZI_BUILD_EXAMPLES=OFF", "-DCMAKE_INSTALL_PREFIX=/usr"]);
    configure.arg(format!("-DMOZZI_CARGO_TARGET={}", package.target()));
    configure.arg(format!("-DCMAKE_INSTALL_LIBDIR={folder}"));
    command::run(configure.arg(format!("-DMOZZI_CARGO_FOLDER={}", workspace.path(dist::CARGO).display())))?;
    let mut cmake = Command::new("cmake");
    zig::prepare(workspace, &mut cmake)?;
    command::run(cmake.arg("--build").arg(&build))?;
    command::run(Command::new("cmake").arg("--install").arg(&build).env("DESTDIR", stage))?;
    let folder = stage.join("usr").join(folder);
    // Debian states licences in one file, which `documents` writes
    for unwanted in [folder.join("libmozzi.a"), stage.join("usr/share/doc/mozzi")] {
        let removed =
            if unwanted.is_dir() { std::fs::remove_dir_all(&unwanted) } else { std::fs::remove_file(&unwanted) };
        removed.map_err(|error| format!("{}: {error}", unwanted.display()))?;
    }
    let mut files = std::fs::read_dir(&folder).map_err(|error| format!("{}: {error}", folder.display()))?.flatten();
    let found = files.find(|entry| entry.file_name().to_string_lossy().starts_with("libmozzi.so."));
    found.map(|entry| entry.path()).ok_or_else(|| format!("{} has no libmozzi.so", folder.display()))
}

/// Completions and manual, written by the program itself; licences and changelog.
fn documents(workspace: &Workspace, stage: &Path, program: &Path, package: &Package) -> Result<(), String> {
    for (shell, file) in COMPLETIONS {
        let (true, script) = command::output(Command::new(program).args(["completions", shell]))? else {
            return Err(format!("`mozzi completions {shell}` failed"));
        };
        write(&stage.join(file), script.as_bytes())?;
    }
    let manual = stage.join("usr/share/man/man1");
    command::run(Command::new(program).args(["man", "--out"]).arg(&manual))?;
    let doc = stage.join("usr/share/doc/mozzi");
    copy(&workspace.path("CHANGELOG.md"), &doc.join("CHANGELOG.md"))?;
    let time = workspace.time_of_commit().unwrap_or_else(|| "0".into());
    let (_, date) =
        command::output(Command::new("date").args(["--utc", "--rfc-email", "--date"]).arg(format!("@{time}")))?;
    write(&doc.join("changelog"), package.changelog(date.trim()).as_bytes())?;
    for name in [third_party::FILE, sbom::FILE] {
        copy(&workspace.path(name), &doc.join(name))?;
    }
    let licence = workspace.path("LICENSE-MIT");
    let licence = std::fs::read_to_string(&licence).map_err(|error| format!("{}: {error}", licence.display()))?;
    write(&doc.join("copyright"), control::copyright(&licence).as_bytes())?;
    let pages = std::fs::read_dir(&manual).map_err(|error| format!("{}: {error}", manual.display()))?;
    let large = ["changelog", "CHANGELOG.md", third_party::FILE, sbom::FILE].map(|name| doc.join(name));
    let files = pages.flatten().map(|entry| entry.path()).chain(large);
    command::run(Command::new("gzip").args(["-9", "--no-name"]).args(files))
}

/// Files are readable by everyone, and programs can be run, whatever this user's defaults are.
fn permissions(stage: &Path) -> Result<(), String> {
    let chmod = |mode: &str, what: &[&str]| {
        let mut find = Command::new("find");
        find.arg(stage).args(what).args(["-exec", "chmod", mode, "{}", "+"]);
        command::run(find)
    };
    chmod("755", &["-type", "d"])?;
    chmod("644", &["-type", "f", "-not", "-path", "*/usr/bin/*"])?;
    chmod("755", &["-type", "f", "-path", "*/usr/bin/*"])
}

fn copy(from: &Path, to: &Path) -> Result<(), String> {
    let made = to.parent().map_or(Ok(()), std::fs::create_dir_all).and_then(|()| std::fs::copy(from, to));
    made.map(|_| ()).map_err(|error| format!("{}: {error}", to.display()))
}

fn write(file: &Path, bytes: &[u8]) -> Result<(), String> {
    let made = file.parent().map_or(Ok(()), std::fs::create_dir_all).and_then(|()| std::fs::write(file, bytes));
    made.map_err(|error| format!("{}: {error}", file.display()))
}
