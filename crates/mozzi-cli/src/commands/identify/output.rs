//! The identified robot in its file's own words: the texts of URDF, MJCF and xacro are edited in place.

use crate::columns::save;
use crate::commands::convert::urdf;
use crate::failure::{self, Failure, Result};
use crate::input;
use crate::robot_json;
use mozzi::Description;
use mozzi_urdf::{EditedFile, Settings, edit_files, expanded, mjcf};
use std::path::{Path, PathBuf};

/// The kind of the output file `--out`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Urdf,
    Json,
    /// The text of MJCF, edited.
    Mjcf,
    /// A file of xacro, edited: the robot's or one that it reads.
    Xacro,
    /// All files that change.
    Folder,
}

/// A file or folder that is written.
pub struct Out<'a> {
    input: &'a str,
    path: &'a str,
    kind: Kind,
    /// The robot's text, if it is edited.
    text: String,
}

impl<'a> Out<'a> {
    /// Checks the name against the robot's own file.
    pub fn new(input: &'a str, path: &'a str, settings: Settings) -> Result<Self> {
        let ending = Path::new(path).extension().map(|ending| ending.to_string_lossy().to_lowercase());
        let kind = match ending.as_deref() {
            _ if path.ends_with(['/', '\\']) || Path::new(path).is_dir() => Kind::Folder,
            Some("urdf") => Kind::Urdf,
            Some("json") => Kind::Json,
            Some("xml") => Kind::Mjcf,
            Some("xacro" | "yaml" | "yml") => Kind::Xacro,
            _ => {
                return Err(Failure::wrong(format!(
                    "--out is `{path}`, expected a name that ends in .urdf, .json, .xml (MJCF), .xacro or .yaml, or a \
                     folder, such as `identified/`"
                )));
            }
        };
        let mut out = Out { input, path, kind, text: String::new() };
        if !matches!(kind, Kind::Urdf | Kind::Json) {
            if robot_json::is_json(input) || mozzi_urdf::embedded::text(input).is_some() && !Path::new(input).exists() {
                let why = format!("`{input}` is no file that could be edited, expected a name that ends in .urdf");
                return Err(Failure::wrong(format!("--out is `{path}`, but {why}")));
            }
            out.text = input::robot_file(input)?;
            let is_mjcf = mjcf::is_mjcf(&out.text);
            let is_xacro = expanded(input, &out.text, settings)?.is_some();
            let language = if is_xacro {
                "xacro"
            } else if is_mjcf {
                "MJCF"
            } else {
                "URDF"
            };
            let is_fitting = match kind {
                Kind::Mjcf => is_mjcf && !is_xacro,
                Kind::Xacro => is_xacro,
                _ => true,
            };
            if !is_fitting {
                let expected = match language {
                    "xacro" => ".xacro, .yaml or .urdf",
                    "MJCF" => ".xml or .urdf",
                    _ => ".urdf",
                };
                return Err(Failure::wrong(format!(
                    "--out is `{path}`, but {input} is {language}; expected a name that ends in {expected}, or a folder"
                )));
            }
        }
        Ok(out)
    }

    /// Writes the robot; returns the names of the files.
    pub fn write(&self, robot: &Description, keeps_old: bool, settings: Settings) -> Result<Vec<String>> {
        let text = match self.kind {
            Kind::Json => robot_json::write(&robot.clone().build()?),
            Kind::Urdf => urdf::edited(self.input, self.path, robot, keeps_old, settings)?,
            Kind::Mjcf | Kind::Xacro | Kind::Folder => return self.write_edited(robot, keeps_old, &settings),
        };
        save(self.path, &text)?;
        Ok(vec![self.path.to_string()])
    }

    fn write_edited(&self, robot: &Description, keeps_old: bool, settings: &Settings) -> Result<Vec<String>> {
        let (input, path) = (self.input, self.path);
        let mut files = edit_files(input, &self.text, robot, keeps_old, settings).map_err(|why| {
            Failure::wrong(format!("{path} is not written: {why}; --out NAME.urdf writes all numbers as URDF"))
        })?;
        if files.is_empty() {
            files.push(EditedFile { name: input.to_string(), text: self.text.clone() });
        }
        let targets = self.targets(&files)?;
        for (file, target) in files.iter().zip(&targets) {
            if std::fs::canonicalize(target).is_ok_and(|to| std::fs::canonicalize(&file.name).is_ok_and(|of| of == to))
            {
                let name = target.display();
                return Err(Failure::wrong(format!("{name} is the robot's own file, expected another name or folder")));
            }
        }
        let mut written = Vec::new();
        for (file, target) in files.iter().zip(targets) {
            let target = target.to_string_lossy().into_owned();
            if file.name != input {
                failure::note(&format!("{target} is the edited {}, which {input} reads", file.name));
            } else if moves(&file.text, Path::new(&file.name), Path::new(&target)) {
                let name = &file.name;
                failure::note(&format!("{target} is in another folder than {name}; the paths in it are unchanged"));
            }
            save(&target, &file.text)?;
            written.push(target);
        }
        Ok(written)
    }

    /// The path of each file.
    fn targets(&self, files: &[EditedFile]) -> Result<Vec<PathBuf>> {
        let path = self.path;
        let list = || files.iter().map(|file| file.name.as_str()).collect::<Vec<_>>().join(", ");
        if self.kind != Kind::Folder {
            let [file] = files else {
                let folder = "expected a folder, such as --out identified/";
                return Err(Failure::wrong(format!("{path}: numbers of {} change; {folder}", list())));
            };
            let ending = |name: &str| Path::new(name).extension().map(|ending| ending.to_string_lossy().to_lowercase());
            if self.kind == Kind::Xacro && ending(&file.name) != ending(path) {
                let expected = ending(&file.name).unwrap_or_default();
                return Err(Failure::wrong(format!(
                    "{path}: the numbers that change are in {}, expected a name that ends in .{expected}, or a folder",
                    file.name
                )));
            }
            return Ok(vec![PathBuf::from(path)]);
        }
        std::fs::create_dir_all(path).map_err(|error| Failure::wrong(format!("{path} cannot be created: {error}")))?;
        let mut targets: Vec<PathBuf> = Vec::new();
        for file in files {
            let target = Path::new(path).join(Path::new(&file.name).file_name().unwrap_or_default());
            if targets.contains(&target) {
                let name = target.display();
                return Err(Failure::wrong(format!("{name} would be written twice: numbers of {} change", list())));
            }
            targets.push(target);
        }
        Ok(targets)
    }
}

/// Whether a text that names other files goes to another folder.
fn moves(text: &str, from: &Path, to: &Path) -> bool {
    let folder = |file: &Path| {
        let parent = file.parent().filter(|parent| !parent.as_os_str().is_empty());
        std::fs::canonicalize(parent.unwrap_or(Path::new("."))).ok()
    };
    (text.contains(" file=") || text.contains("filename=")) && folder(from) != folder(to)
}
