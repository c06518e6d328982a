//! Arguments and packages for expanding a xacro file.

use clap::Args;
use std::path::PathBuf;

#[derive(Args, Clone, Debug)]
pub struct XacroArguments {
    /// Value of an argument of a xacro file; repeatable
    #[arg(long = "xacro-arg", value_name = "NAME:=VALUE", value_parser = assignment)]
    values: Vec<(String, String)>,
    /// Folder of a ROS package, for `$(find NAME)` in a xacro file and meshes at package://NAME; repeatable
    #[arg(long = "package", value_name = "NAME=DIR", value_parser = package)]
    packages: Vec<(String, PathBuf)>,
}

impl XacroArguments {
    pub fn arguments(&self) -> mozzi_urdf::XacroArguments {
        let given = self.values.iter().filter(|(_, value)| !value.is_empty());
        mozzi_urdf::XacroArguments {
            values: given.cloned().collect(),
            packages: self.packages.clone(),
            texts: Vec::new(),
        }
    }

    /// Adds values of arguments.
    pub fn with(&self, values: &[(String, String)]) -> Self {
        let values = self.values.iter().chain(values).cloned().collect();
        XacroArguments { values, ..self.clone() }
    }
}

/// `name:=value`; without a value the default applies, as in ROS.
pub fn assignment(text: &str) -> Result<(String, String), String> {
    let parts: Vec<&str> = text.split(":=").map(str::trim).collect();
    match parts[..] {
        [name, value] if !name.is_empty() => Ok((name.to_string(), value.to_string())),
        _ => Err(format!("`{text}` is not of the form NAME:=VALUE")),
    }
}

fn package(text: &str) -> Result<(String, PathBuf), String> {
    match text.split_once('=') {
        Some((name, folder)) if !name.is_empty() && !folder.is_empty() => Ok((name.to_string(), folder.into())),
        _ => Err(format!("`{text}` is not of the form NAME=DIR")),
    }
}
