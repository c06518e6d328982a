//! The files that were dropped with a robot: for xacro their texts and their packages.

use mozzi_urdf::{Policy, Settings, XacroArguments};
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// How a file is read among others. A folder is the package of its name, and of the name in its package.xml.
pub fn settings(files: &Map<String, Value>, arguments: &Map<String, Value>) -> Settings {
    // also as absolute paths, which do not depend on the file that includes them
    let both = |(path, text): (&String, &Value)| {
        let text = text.as_str()?.to_string();
        Some([(path.clone(), text.clone()), (format!("/{path}"), text)])
    };
    let texts: Vec<(String, String)> = files.iter().filter_map(both).flatten().collect();
    let mut packages: BTreeMap<String, PathBuf> = BTreeMap::new();
    let absolute = || texts.iter().filter(|(path, _)| path.starts_with('/'));
    for (path, _) in absolute() {
        for folder in Path::new(path).ancestors().skip(1) {
            if let Some(name) = folder.file_name() {
                packages.entry(name.to_string_lossy().into_owned()).or_insert_with(|| folder.to_path_buf());
            }
        }
    }
    for (path, text) in absolute().filter(|(path, _)| path.ends_with("package.xml")) {
        let name = text.split_once("<name>").and_then(|(_, rest)| rest.split_once("</name>"));
        if let (Some((name, _)), Some(folder)) = (name, Path::new(path).parent()) {
            packages.insert(name.trim().to_string(), folder.to_path_buf());
        }
    }
    let value = |(name, value): (&String, &Value)| Some((name.clone(), value.as_str()?.to_string()));
    Settings {
        policy: Policy::Default,
        xacro: XacroArguments {
            values: arguments.iter().filter_map(value).collect(),
            packages: packages.into_iter().collect(),
            texts,
        },
    }
}
