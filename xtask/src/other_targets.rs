//! Other processors: AArch64 by an emulator, WebAssembly in Node.

use crate::command;
use crate::cross::Compiler;
use crate::report::Outcome;
use crate::workspace::Workspace;
use std::process::Command;

/// cargo's own variables: the program that runs what was built for AArch64, and the compiler of C that links it.
const RUNNER: &str = "CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUNNER";
const LINKER: &str = "CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER";

/// Tests of the libraries whose arithmetic depends on the processor. Times under an emulator say nothing.
pub fn aarch64(workspace: &Workspace) -> Outcome {
    if std::env::var_os(RUNNER).is_none() {
        return Outcome::Skipped(format!(
            "set {RUNNER} to qemu-aarch64 and {LINKER} to a C compiler for it, with `rustup target add aarch64-unknown-linux-gnu`"
        ));
    }
    let mut cargo = workspace.cargo(&["test", "--target", "aarch64-unknown-linux-gnu", "--tests", "--target-dir"]);
    cargo.arg(workspace.path("target/aarch64"));
    if let Some(compiler) = std::env::var_os(LINKER) {
        cargo.env("CC", compiler); // tests compile emitted C
    }
    command::outcome(cargo.args([
        "-p",
        "mozzi",
        "-p",
        "mozzi-sim",
        "-p",
        "mozzi-engine",
        "-p",
        "mozzi-urdf",
        "-p",
        "mozzi-motion",
    ]))
}

/// What users of these systems compile. Nothing is linked or run, for want of their linkers and their machines.
const ELSEWHERE: [&str; 2] = ["x86_64-pc-windows-msvc", "aarch64-apple-darwin"];
const CHECKED: [&str; 4] = ["mozzi-cli", "mozzi-c", "mozzi-py", "mozzi-identify"];

/// Everything that is published compiles, without a warning, for Windows and macOS.
pub fn windows_and_macos(workspace: &Workspace) -> Outcome {
    let packages: Vec<&str> = CHECKED.iter().flat_map(|name| ["--package", name]).collect();
    let mut without = Vec::new();
    for target in ELSEWHERE {
        let compiler = match Compiler::find(target) {
            Ok(Some(compiler)) => compiler,
            Ok(None) => {
                without.push(target);
                continue;
            }
            Err(why) => return Outcome::Failed(why),
        };
        let mut cargo = compiler.cargo(workspace, &["check"], target);
        cargo.args(&packages).arg("--target-dir").arg(workspace.path("target/elsewhere"));
        // no Python of that system is here; linking would need it, checking does not
        cargo.env("PYO3_NO_PYTHON", "1").env("CARGO_ENCODED_RUSTFLAGS", "-Dwarnings");
        if let Err(why) = command::run(cargo) {
            return Outcome::Failed(format!("{target}: {why}"));
        }
    }
    match without.is_empty() {
        true => Outcome::Passed(format!("checked, not linked or run: {}", ELSEWHERE.join(", "))),
        false => Outcome::Skipped(format!(
            "no compiler for {}: `rustup target add`, or {} for the sources of the standard library",
            without.join(", "),
            crate::cross::FOLDER
        )),
    }
}

/// The page's WebAssembly computes the command line's torques.
pub fn node(workspace: &Workspace) -> Outcome {
    if !command::exists(&mut Command::new("node")) {
        return Outcome::Skipped("there is no node".into());
    }
    match difference(workspace) {
        Ok(worst) if worst < 1e-12 => Outcome::Passed(format!("torques differ by {worst:.1e} of the largest")),
        Ok(worst) => {
            Outcome::Failed(format!("torques differ by {worst:.1e} of the largest, at most 1e-12 is expected"))
        }
        Err(why) => Outcome::Failed(why),
    }
}

fn difference(workspace: &Workspace) -> Result<f64, String> {
    let robot = workspace.scratch("node")?.join("ur5.json");
    let mozzi = || {
        let mut cargo = workspace.cargo(&["run", "--quiet", "--release", "--package", "mozzi-cli", "--"]);
        cargo.current_dir(&workspace.root);
        cargo
    };
    command::run(mozzi().args(["convert", "ur5"]).arg(&robot))?;
    let state = ["--theta", "0,-1.2,1.5,0.3,1.1,0", "--dtheta", "0.1,0.1,0.1,0.1,0.1,0.1"];
    let motion = ["--ddtheta", "0.5,0.5,0.5,0.5,0.5,0.5", "--json"];
    let (_, native) = command::output(mozzi().args(["compute", "ur5", "inverse-dynamics"]).args(state).args(motion))?;
    let native: serde_json::Value = serde_json::from_str(&native).map_err(|error| format!("native: {error}"))?;
    let mut node = Command::new("node");
    node.arg(workspace.path("xtask/node/torques.mjs")).arg(workspace.path("crates/mozzi-report/bundle/mozzi.wasm.gz"));
    let (_, found) = command::output(node.arg(&robot))?;
    let found: Vec<f64> = serde_json::from_str(&found).map_err(|error| format!("node printed {found:?}: {error}"))?;
    let expected: Vec<f64> =
        native["tau"].as_array().into_iter().flatten().filter_map(serde_json::Value::as_f64).collect();
    if expected.len() != 6 || found.len() != 6 {
        return Err(format!("{} and {} torques", expected.len(), found.len()));
    }
    let size = expected.iter().fold(0.0, |size: f64, x| size.max(x.abs()));
    Ok(expected.iter().zip(&found).fold(0.0, |worst: f64, (a, b)| worst.max((a - b).abs())) / size)
}
