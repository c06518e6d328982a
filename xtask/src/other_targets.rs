//! Other processors: AArch64 by an emulator, WebAssembly in Node.

use crate::command;
use crate::cross::Compiler;
use crate::report::Outcome;
use crate::workspace::Workspace;
use std::process::Command;

/// cargo's own variables: the program that runs what was built for AArch64, and the compiler of C that links it.
const RUNNER: &str = "CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUNNER";
const LINKER: &str = "CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER";

const TARGET: &str = "aarch64-unknown-linux-gnu";
/// Debian's programs and libraries, after `apt install qemu-user gcc-aarch64-linux-gnu`.
const QEMU: &str = "qemu-aarch64";
const GCC: &str = "aarch64-linux-gnu-gcc";
const LIBRARIES: &str = "/usr/aarch64-linux-gnu";

/// cargo for this processor: with its own variables if they are set, else with Debian's programs; or what is missing.
fn cargo_for_aarch64(workspace: &Workspace, arguments: &[&str]) -> Result<Command, Outcome> {
    let missing = |what: &str| {
        Outcome::Skipped(format!(
            "{what}: `apt install qemu-user gcc-aarch64-linux-gnu` (or set {RUNNER} and {LINKER}), \
             `rustup target add {TARGET}`"
        ))
    };
    if matches!(Compiler::find(TARGET), Ok(None)) {
        return Err(missing("no standard library for AArch64"));
    }
    let mut cargo = workspace.cargo(arguments);
    cargo.args(["--target", TARGET, "--target-dir"]).arg(workspace.path("target/aarch64"));
    if std::env::var_os(RUNNER).is_none() {
        if !command::exists(Command::new(QEMU).arg("--version")) {
            return Err(missing("no qemu-aarch64"));
        }
        cargo.env(RUNNER, format!("{QEMU} -L {LIBRARIES}"));
    }
    match std::env::var_os(LINKER) {
        Some(compiler) => cargo.env("CC", compiler), // tests compile emitted C
        None if command::exists(Command::new(GCC).arg("--version")) => cargo.env(LINKER, GCC).env("CC", GCC),
        None => return Err(missing("no C compiler for AArch64")),
    };
    Ok(cargo)
}

/// Tests of the libraries whose arithmetic depends on the processor, and of its machine code. Times under an emulator
/// are meaningless.
pub fn aarch64(workspace: &Workspace) -> Outcome {
    let packages = ["mozzi", "mozzi-sim", "mozzi-engine", "mozzi-urdf", "mozzi-motion"];
    match cargo_for_aarch64(workspace, &["test", "--tests"]) {
        Ok(mut cargo) => command::outcome(cargo.args(packages.iter().flat_map(|package| ["-p", package]))),
        Err(skipped) => skipped,
    }
}

/// Random programs as machine code, compared with the interpreter, for so many seconds.
pub fn aarch64_programs(workspace: &Workspace, seconds: u32) -> Outcome {
    match cargo_for_aarch64(workspace, &["test", "-p", "mozzi-engine", "--test", "fuzz"]) {
        Ok(mut cargo) => {
            cargo.env("MOZZI_FUZZ_SECONDS", seconds.to_string()).args(["--", "--ignored", "--nocapture"]);
            command::outcome(&mut cargo)
        }
        Err(skipped) => skipped,
    }
}

/// Machine code computes the same numbers by AVX2 and on AArch64, to the bit.
pub fn aarch64_bits(workspace: &Workspace) -> Outcome {
    const RUN: [&str; 7] =
        ["run", "--quiet", "--release", "--package", "mozzi-engine", "--example", "machine_code_bits"];
    if !cfg!(target_arch = "x86_64") {
        return Outcome::Skipped("only on x86-64".into());
    }
    let there = match cargo_for_aarch64(workspace, &RUN) {
        Ok(cargo) => cargo,
        Err(skipped) => return skipped,
    };
    match (command::output(workspace.cargo(&RUN)), command::output(there)) {
        (Ok((true, here)), Ok((true, there))) => {
            let lines = || here.lines().zip(there.lines());
            let is_same = here.lines().count() == there.lines().count() && !here.is_empty();
            match lines().find(|(here, there)| here != there) {
                None if is_same => Outcome::Passed(format!("{} numbers", here.split(' ').count())),
                None => Outcome::Failed("another number of lines".into()),
                Some((line, _)) => Outcome::Failed(line.split(':').next().unwrap_or_default().to_owned()),
            }
        }
        (Err(why), _) | (_, Err(why)) => Outcome::Failed(why),
        _ => Outcome::Failed("the example machine_code_bits of mozzi-engine failed".into()),
    }
}

/// A few random programs, by a package of their own, which does not build what other tests of mozzi-engine need.
pub fn aarch64_sample(workspace: &Workspace) -> Outcome {
    match cargo_for_aarch64(workspace, &["test", "--manifest-path", "xtask/aarch64/Cargo.toml"]) {
        Ok(mut cargo) => command::outcome(&mut cargo),
        Err(skipped) => skipped,
    }
}

/// Targets for which the packages are compiled. Nothing is linked or run, because their linkers and machines are not
/// available.
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
