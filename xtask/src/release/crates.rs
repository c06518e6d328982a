//! The crates that are published.

use crate::command;
use crate::report::Outcome;
use crate::workspace::Workspace;
use serde_json::Value;

/// Those with a documented interface, in an order in which each depends on earlier ones.
pub const PUBLIC: [&str; 10] = [
    "mozzi",
    "mozzi-sim",
    "mozzi-xacro",
    "mozzi-urdf",
    "mozzi-engine",
    "mozzi-symbolic",
    "mozzi-gpu",
    "mozzi-motion",
    "mozzi-identify",
    "mozzi-cli",
];

/// Parts of the command line: on crates.io because mozzi-cli needs them there, without a promise of stability.
pub const PARTS: [&str; 1] = ["mozzi-report"];

/// Everything that is published.
pub fn all() -> impl Iterator<Item = &'static str> {
    PUBLIC.into_iter().chain(PARTS)
}

/// Checks what crates.io requires, and that exactly these crates can be published.
pub fn check(workspace: &Workspace) -> Outcome {
    match found(workspace) {
        Ok((problems, notes)) if problems.is_empty() => Outcome::Passed(notes),
        Ok((problems, _)) => Outcome::Failed(problems.join("; ")),
        Err(why) => Outcome::Failed(why),
    }
}

fn found(workspace: &Workspace) -> Result<(Vec<String>, String), String> {
    let (true, text) = command::output(workspace.cargo(&["metadata", "--no-deps", "--format-version", "1"]))? else {
        return Err("`cargo metadata` failed".into());
    };
    let metadata: Value = serde_json::from_str(&text).map_err(|error| format!("`cargo metadata`: {error}"))?;
    let packages = metadata["packages"].as_array().ok_or("`cargo metadata` lists no packages")?;
    let (mut problems, mut without_repository) = (Vec::new(), 0);
    for package in packages {
        let name = package["name"].as_str().unwrap_or_default();
        let is_listed = all().any(|known| known == name);
        if package["publish"].is_null() != is_listed {
            problems.push(format!("{name} is {}listed, against its `publish`", if is_listed { "" } else { "not " }));
        }
        if !is_listed {
            continue;
        }
        for field in ["description", "license", "rust_version"] {
            if package[field].as_str().is_none_or(str::is_empty) {
                problems.push(format!("{name} has no {field}"));
            }
        }
        for field in ["keywords", "categories"] {
            let count = package[field].as_array().map_or(0, Vec::len);
            if !(1..=5).contains(&count) {
                problems.push(format!("{name} has {count} {field}, expected 1 to 5"));
            }
        }
        without_repository += usize::from(package["repository"].is_null());
    }
    let notes = match without_repository {
        0 => format!("{} crates", all().count()),
        count => format!("{} crates; {count} name no repository: set it when there is one", all().count()),
    };
    Ok((problems, notes))
}

/// mozzi compiles with each set of its features, and the other libraries with none of theirs.
pub fn features(workspace: &Workspace) -> Outcome {
    let of_mozzi = [&["--no-default-features"][..], &[], &["--all-features"]];
    let mozzi = of_mozzi.iter().map(|features| ("mozzi", *features));
    let others = PUBLIC[1..].iter().map(|name| (*name, &["--no-default-features"][..]));
    for (name, features) in mozzi.chain(others) {
        let mut cargo = workspace.cargo(&["check", "--package", name, "--lib", "--target-dir"]);
        cargo.arg(workspace.path("target/features")).args(features);
        if let Err(why) = command::run(cargo) {
            return Outcome::Failed(why);
        }
    }
    Outcome::Passed(String::new())
}
