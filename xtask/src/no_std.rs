//! Is the library `no_std`? A `#![no_std]` static library with its own panic handler is built on it, for this machine.
//!
//! The crate is `xtask/no_std_check`. It has a panic handler, as `std` has one: if anything pulled `std` in, the
//! compiler would refuse the second. It is built for the host: no bare-metal target is checked.

use crate::command;
use crate::report::Outcome;
use crate::workspace::Workspace;

pub fn check(workspace: &Workspace) -> Outcome {
    let library = std::fs::read_to_string(workspace.path("crates/mozzi/src/lib.rs")).unwrap_or_default();
    if !library.contains("no_std") {
        return Outcome::Skipped("crates/mozzi/src/lib.rs does not say no_std yet".into());
    }
    // Its own workspace, so that no other package's features reach the library; but the same versions.
    let lock = workspace.path("xtask/no_std_check/Cargo.lock");
    if let Err(error) = std::fs::copy(workspace.path("Cargo.lock"), &lock) {
        return Outcome::Failed(format!("{}: {error}", lock.display()));
    }
    let mut cargo = workspace.cargo(&["build", "--manifest-path"]);
    cargo.arg(workspace.path("xtask/no_std_check/Cargo.toml"));
    cargo.arg("--target-dir").arg(workspace.path("target/no_std_check"));
    match command::run(cargo) {
        Ok(()) => Outcome::Passed("a #![no_std] crate on mozzi without default features, built for the host".into()),
        Err(why) => Outcome::Failed(why),
    }
}
