//! The robot in the form that the libraries read.

use crate::compare::{Error, Result};
use mozzi::Description;
use mozzi_urdf::embedded;
use std::path::Path;

/// The robot's source for the libraries.
#[derive(Clone, Debug)]
pub struct Source {
    /// Its name in reports.
    pub(crate) name: String,
    /// "urdf" or "mjcf".
    pub(crate) language: &'static str,
    /// The file, if the libraries can read it.
    pub(crate) path: Option<String>,
    /// Otherwise the text.
    pub(crate) text: Option<String>,
}

impl Source {
    /// The file if the libraries can read it (URDF, MJCF); the text of an embedded robot; for SDFormat and JSON,
    /// `robot` written as URDF.
    ///
    /// # Errors
    /// [`Error::Read`], [`Error::Write`].
    pub fn read(name_or_path: &str, robot: &Description) -> Result<Self> {
        let source = |language, path, text| Source { name: name_or_path.to_string(), language, path, text };
        if let Some(embedded) = embedded::unless_file(name_or_path) {
            return Ok(source("urdf", None, Some(embedded.to_string())));
        }
        let path = Path::new(name_or_path);
        if path.extension().is_some_and(|suffix| suffix == "json") {
            return Self::written(name_or_path, robot);
        }
        let bytes = std::fs::read(path).map_err(|error| Error::Read { file: name_or_path.to_string(), error })?;
        let text = String::from_utf8_lossy(&bytes);
        if mozzi_urdf::sdf::is_sdf(&text) {
            return Self::written(name_or_path, robot); // they do not read it
        }
        Ok(source(language(&text), Some(name_or_path.to_string()), None))
    }

    /// A text of URDF or MJCF, such as that of a pipe.
    pub fn of_text(name: &str, text: &str) -> Self {
        Source { name: name.to_string(), language: language(text), path: None, text: Some(text.to_string()) }
    }

    /// The robot, written as URDF. Axes that miss their frames get links, further frames become links; the end effector
    /// has no effect, and gravity, which URDF lacks, is a difference that the comparison explains.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn written(name: &str, robot: &Description) -> Result<Self> {
        let gravity = Description::new("").gravity;
        let robot = Description { end_effector: None, gravity, ..mozzi_urdf::expressible(robot) };
        let text = mozzi_urdf::write(&robot).map_err(|error| Error::Write { robot: name.to_string(), error })?;
        Ok(Source { name: name.to_string(), language: "urdf", path: None, text: Some(text) })
    }
}

fn language(text: &str) -> &'static str {
    if mozzi_urdf::mjcf::is_mjcf(text) { "mjcf" } else { "urdf" }
}
