//! Checks that mozzi and mozzi-sim are `no_std`: builds a `#![no_std]` static library with its own panic handler on it,
//! for this machine.
//!
//! The crate is `xtask/no_std_check`. It defines a panic handler, as `std` does: if a dependency used `std`, the
//! compiler would refuse the second one. It is built for the host: no bare-metal target is checked.

use crate::command;
use crate::report::Outcome;
use crate::workspace::Workspace;

pub fn check(workspace: &Workspace) -> Outcome {
    // It is a separate workspace, so that no other package's features reach the library; but the versions are the same.
    let lock = workspace.path("xtask/no_std_check/Cargo.lock");
    if let Err(error) = std::fs::copy(workspace.path("Cargo.lock"), &lock) {
        return Outcome::Failed(format!("{}: {error}", lock.display()));
    }
    let mut cargo = workspace.cargo(&["build", "--manifest-path"]);
    cargo.arg(workspace.path("xtask/no_std_check/Cargo.toml"));
    cargo.arg("--target-dir").arg(workspace.path("target/no_std_check"));
    match command::run(cargo) {
        Ok(()) => Outcome::Passed(
            "a #![no_std] crate on mozzi and mozzi-sim without default features, built for the host".into(),
        ),
        Err(why) => Outcome::Failed(why),
    }
}
