//! The packages as crates.io would get them, in a directory that stands for it: cargo builds from it without network
//! and without this workspace.

use super::crates;
use crate::command;
use crate::report::Outcome;
use crate::workspace::Workspace;
use std::path::{Path, PathBuf};
use std::process::Command;

const REGISTRY: &str = "target/xtask/registry";

/// The largest package of mozzi, in bytes.
const LARGEST: u64 = 400_000;

/// Packages every crate, and puts the packages and everything that they need into the registry.
pub fn write(workspace: &Workspace, version: &str) -> Outcome {
    match written(workspace, version) {
        Ok(sizes) => Outcome::Passed(sizes),
        Err(why) => Outcome::Failed(why),
    }
}

fn written(workspace: &Workspace, version: &str) -> Result<String, String> {
    let registry = workspace.fresh_folder(REGISTRY)?;
    let mut vendor = workspace.cargo(&["vendor", "--quiet", "--locked", "--versioned-dirs"]);
    command::output(vendor.arg(&registry))?;
    // what is not committed is a failure of its own
    let mut package = workspace.cargo(&["package", "--no-verify", "--allow-dirty"]);
    crates::all().for_each(|name| {
        package.args(["--package", name]);
    });
    command::run(package)?;
    let mut sizes = Vec::new();
    for name in crates::all() {
        let archive = workspace.target().join(format!("package/{name}-{version}.crate"));
        let size = std::fs::metadata(&archive).map_err(|error| format!("{}: {error}", archive.display()))?.len();
        if name == "mozzi" && size > LARGEST {
            return Err(format!("the package of mozzi has {size} bytes, at most {LARGEST} are allowed"));
        }
        sizes.push(format!("{name} {} kB", size.div_ceil(1000)));
        command::run(Command::new("tar").arg("xzf").arg(&archive).arg("-C").arg(&registry))?;
        // the sum of the archive is in the lock files of the packages that need it
        let (_, sum) = command::output(Command::new("sha256sum").arg(&archive))?;
        let sum = sum.split(' ').next().unwrap_or_default();
        let sums = registry.join(format!("{name}-{version}/.cargo-checksum.json"));
        std::fs::write(&sums, format!("{{\"files\":{{}},\"package\":\"{sum}\"}}"))
            .map_err(|error| format!("{}: {error}", sums.display()))?;
    }
    Ok(sizes.join(", "))
}

/// A folder in which cargo knows no other registry than that one.
pub fn folder(workspace: &Workspace, name: &str) -> Result<PathBuf, String> {
    let folder = workspace.scratch(name)?;
    let config = format!(
        "[source.crates-io]\nreplace-with = \"packages\"\n[source.packages]\ndirectory = {:?}\n[net]\noffline = true\n",
        workspace.path(REGISTRY)
    );
    let file = folder.join(".cargo/config.toml");
    let made = std::fs::create_dir_all(folder.join(".cargo")).and_then(|()| std::fs::write(&file, config));
    made.map(|()| folder).map_err(|error| format!("{}: {error}", file.display()))
}

/// cargo in such a folder.
pub fn cargo(workspace: &Workspace, folder: &Path, arguments: &[&str]) -> Command {
    let mut cargo = workspace.cargo(arguments);
    cargo.current_dir(folder).env("CARGO_TARGET_DIR", workspace.path("target/release_check"));
    cargo
}

/// Runs the examples in the documentation of every library from its package alone.
pub fn test(workspace: &Workspace, version: &str) -> Outcome {
    for name in crates::PUBLIC.into_iter().filter(|name| *name != "mozzi-cli") {
        let tested = folder(workspace, "package").and_then(|folder| {
            let source = workspace.path(REGISTRY).join(format!("{name}-{version}"));
            command::run(Command::new("cp").args(["-R", "-L"]).arg(source.join(".")).arg(&folder))?;
            // it is no member of the workspace around it
            let manifest = folder.join("Cargo.toml");
            let text =
                std::fs::read_to_string(&manifest).map_err(|error| format!("{}: {error}", manifest.display()))?;
            std::fs::write(&manifest, text + "\n[workspace]\n").map_err(|error| error.to_string())?;
            command::run(cargo(workspace, &folder, &["test", "--doc", "--all-features"]))
        });
        if let Err(why) = tested {
            return Outcome::Failed(format!("{name}: {why}"));
        }
    }
    Outcome::Passed(String::new())
}
