//! The packages on which the workspace depends, as `cargo metadata` lists them.

use crate::command;
use crate::workspace::Workspace;
use serde_json::Value;

/// A third-party package.
pub struct Dependency {
    /// Name and version.
    pub name: String,
    /// SPDX expression, if the package states one.
    pub licence: Option<String>,
}

/// All packages in the `Cargo.lock` next to this manifest, for any platform, except the workspace's own.
pub fn dependencies(workspace: &Workspace, manifest: &str) -> Result<Vec<Dependency>, String> {
    let mut cargo = workspace.cargo(&["metadata", "--all-features", "--format-version", "1", "--manifest-path"]);
    let (true, text) = command::output(cargo.arg(workspace.path(manifest)))? else {
        return Err("`cargo metadata` failed".into());
    };
    let metadata: Value = serde_json::from_str(&text).map_err(|error| format!("`cargo metadata`: {error}"))?;
    let packages = metadata["packages"].as_array().ok_or("`cargo metadata` lists no packages")?;
    let foreign = packages.iter().filter(|package| !package["source"].is_null());
    let dependency = |package: &Value| {
        let text = |key: &str| package[key].as_str().map(str::to_owned);
        let name = text("name").zip(text("version")).map(|(name, version)| format!("{name} {version}"));
        Some(Dependency { name: name?, licence: text("license") })
    };
    foreign.map(dependency).collect::<Option<_>>().ok_or("a package without a name".into())
}
