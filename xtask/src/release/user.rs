//! A user's first program, built from the packages instead of the published crates.

use super::packages;
use crate::command;
use crate::report::Outcome;
use crate::workspace::Workspace;
use std::fmt::Write;
use std::time::Instant;

/// A first program.
const PROGRAM: &str = r#"fn main() -> Result<(), Box<dyn std::error::Error>> {
    let model = mozzi_urdf::open("ur5")?.build()?;
    let (theta, dtheta, ddtheta) = ([0.0, -1.2, 1.5, 0.3, 1.1, 0.0], [0.1; 6], [0.5; 6]);
    let tau = model.inverse_dynamics(&theta, &dtheta, &ddtheta, &model.environment())?;
    println!("{:.3?}", tau.as_slice());
    Ok(())
}
"#;

/// Its output: the torques of README's first command.
const OUTPUT: &str = "[0.655, -28.953, -13.888, 0.459, 0.027, 0.015]\n";

/// Builds and runs a program that depends on mozzi and mozzi-urdf alone.
pub fn build(workspace: &Workspace, version: &str) -> Outcome {
    match built(workspace, version) {
        Ok(note) => Outcome::Passed(note),
        Err(why) => Outcome::Failed(why),
    }
}

fn built(workspace: &Workspace, version: &str) -> Result<String, String> {
    let folder = packages::folder(workspace, "user")?;
    let mut manifest = "[package]\nname = \"user\"\nedition = \"2024\"\n\n[workspace]\n\n[dependencies]\n".to_string();
    for name in ["mozzi", "mozzi-urdf"] {
        // writing to a String cannot fail
        let _ = writeln!(manifest, "{name} = \"{version}\"");
    }
    let write = |name: &str, text: &str| {
        let file = folder.join(name);
        let made = file.parent().map_or(Ok(()), std::fs::create_dir_all).and_then(|()| std::fs::write(&file, text));
        made.map_err(|error| format!("{}: {error}", file.display()))
    };
    write("Cargo.toml", &manifest)?;
    write("src/main.rs", PROGRAM)?;
    let target = workspace.fresh_folder("target/xtask/user_target")?;
    let start = Instant::now();
    let (true, output) =
        command::output(packages::cargo(workspace, &folder, &["run"]).env("CARGO_TARGET_DIR", target))?
    else {
        return Err("the program failed".into());
    };
    let seconds = start.elapsed().as_secs_f64();
    if output != OUTPUT {
        return Err(format!("the program printed {output:?}, expected {OUTPUT:?}"));
    }
    let count = |name: &str| {
        let tree = ["tree", "--package", name, "--edges", "normal,build", "--prefix", "none", "--no-dedupe"];
        let (_, text) = command::output(packages::cargo(workspace, &folder, &tree))?;
        let names = text.lines().filter_map(|line| line.split(' ').next());
        Ok::<_, String>(names.collect::<std::collections::BTreeSet<_>>().len() - 1)
    };
    let (mozzi, urdf) = (count("mozzi")?, count("mozzi-urdf")?);
    if mozzi > 20 || urdf > 30 {
        return Err(format!("mozzi pulls {mozzi} crates (at most 20), mozzi-urdf {urdf} (at most 30)"));
    }
    Ok(format!("built and run in {seconds:.0} s; mozzi pulls {mozzi} crates, mozzi-urdf {urdf}"))
}

/// Installs the command line and runs its first command.
pub fn install(workspace: &Workspace, version: &str) -> Outcome {
    let installed = packages::folder(workspace, "install").and_then(|folder| {
        // `cargo install` does not look for configuration where it is called
        let mut cargo = packages::cargo(
            workspace,
            &folder,
            &["install", "mozzi-cli", "--version", version, "--features", "arrow", "--config"],
        );
        command::run(cargo.arg(".cargo/config.toml").args(["--locked", "--root"]).arg(&folder))?;
        let mozzi = folder.join("bin/mozzi");
        let size = std::fs::metadata(&mozzi).map_err(|error| format!("{}: {error}", mozzi.display()))?.len();
        let mut run = std::process::Command::new(&mozzi);
        command::run(run.args(["compute", "ur5", "inverse-dynamics", "--theta", "0,-1.2,1.5,0.3,1.1,0"]))?;
        Ok(format!("{:.1} MB", size as f64 / 1e6))
    });
    match installed {
        Ok(note) => Outcome::Passed(note),
        Err(why) => Outcome::Failed(why),
    }
}
