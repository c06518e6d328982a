//! A file of constraints: its contents, and errors with their places.

use super::closed_loop;
use super::entry::{self, Entry};
use super::yaml::{self, Node, Value};
use crate::files;
use mozzi::Description;
use mozzi::model::description::{Constraint, Limits};
use mozzi::model::{Element, Severity};
use std::fmt;
use std::path::{Path, PathBuf};

/// Larger files are refused.
const MOST_BYTES: u64 = 16 << 20;

/// An error at a place of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Misplaced {
    /// The file's name.
    pub file: String,
    /// From 1.
    pub line: usize,
    /// From 1, in characters.
    pub column: usize,
    /// The message.
    pub message: String,
}

impl fmt::Display for Misplaced {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}:{}: {}", self.file, self.line, self.column, self.message)
    }
}

/// Why a file of constraints is refused.
#[derive(Debug)]
#[non_exhaustive]
pub enum ConstraintsError {
    /// It cannot be read.
    File {
        /// The path of the file.
        path: PathBuf,
        /// The cause.
        source: std::io::Error,
    },
    /// It has errors, each at its place.
    Refused(Vec<Misplaced>),
}

impl fmt::Display for ConstraintsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ConstraintsError::File { path, source } => write!(f, "{} cannot be read: {source}", path.display()),
            ConstraintsError::Refused(errors) => {
                let lines: Vec<String> = errors.iter().map(ToString::to_string).collect();
                f.write_str(&lines.join("\n"))
            }
        }
    }
}

impl std::error::Error for ConstraintsError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            ConstraintsError::File { source, .. } => Some(source),
            ConstraintsError::Refused(_) => None,
        }
    }
}

pub fn text(path: &Path) -> std::io::Result<String> {
    String::from_utf8(files::read(path, MOST_BYTES)?).map_err(std::io::Error::other)
}

/// The contents of a file: constraints with their places.
pub struct Contents {
    pub constraints: Vec<(Constraint, (usize, usize))>,
    pub motors: Option<Vec<String>>,
    pub place_of_motors: (usize, usize),
}

pub fn add(file: &str, text: &str, mut robot: Description) -> Result<Description, ConstraintsError> {
    let at =
        |(line, column): (usize, usize), message: String| Misplaced { file: file.to_string(), line, column, message };
    let one = |(place, message): yaml::Wrong| ConstraintsError::Refused(vec![at(place, message)]);
    let root = yaml::parse(text.strip_prefix('\u{feff}').unwrap_or(text)).map_err(one)?;
    let at_root = At { node: root.clone(), path: String::new(), place: root.place };
    if at_root.keys().iter().any(|key| key == "closed_loop") {
        for (joint, kind) in closed_loop::retyped(&at_root, &robot).map_err(one)? {
            if robot.joints[joint].kind != kind {
                (robot.joints[joint].kind, robot.joints[joint].mimic) = (kind, None);
                robot.joints[joint].limits = Limits::default();
            }
        }
    }
    let contents = contents(&at_root, &robot).map_err(one)?;
    let before = robot.constraints.len();
    let (constraints, places): (Vec<_>, Vec<_>) = contents.constraints.into_iter().unzip();
    robot.constraints.extend(constraints);
    if contents.motors.is_some() {
        robot.motors = contents.motors;
    }
    let place = |element, attribute| match element {
        Element::Constraint(i) => places.get(i.wrapping_sub(before)).copied(),
        Element::Robot if attribute == "motors" => Some(contents.place_of_motors),
        _ => None,
    };
    let problems = robot.check().into_iter().filter(|problem| problem.severity == Severity::Error);
    let errors: Vec<Misplaced> = problems
        .filter_map(|problem| Some(at(place(problem.element, problem.attribute)?, problem.to_string())))
        .collect();
    if errors.is_empty() { Ok(robot) } else { Err(ConstraintsError::Refused(errors)) }
}

fn contents(at: &At, robot: &Description) -> Result<Contents, yaml::Wrong> {
    if !at.is_map() {
        return at.wrong("a map with the key `constraints`, or `closed_loop`");
    }
    if at.keys().iter().any(|key| key == "closed_loop") {
        return closed_loop::contents(at, robot);
    }
    entry::known(at, &["constraints", "motors"])?;
    let list = entry::required(at, "constraints")?.list()?;
    let constraints = list.iter().map(|at| Ok((entry::constraint(at)?, at.place))).collect::<Result<_, _>>()?;
    let motors = at.get("motors");
    Ok(Contents { constraints, motors: entry::motors(&motors)?, place_of_motors: motors.place })
}

/// A value of the file with its path.
pub struct At {
    node: Node,
    path: String,
    /// The place of its key, if it has one.
    pub place: (usize, usize),
}

impl Entry for At {
    type Error = yaml::Wrong;

    fn get(&self, key: &'static str) -> Self {
        let path = if self.path.is_empty() { key.to_string() } else { format!("{}.{key}", self.path) };
        let found = match &self.node.value {
            Value::Map(entries) => entries.iter().find(|(known, ..)| known == key),
            _ => None,
        };
        match found {
            Some((_, place, node)) => At { node: node.clone(), path, place: *place },
            None => At { node: Node::default(), path, place: self.place },
        }
    }

    fn keys(&self) -> Vec<String> {
        match &self.node.value {
            Value::Map(entries) => entries.iter().map(|(key, ..)| key.clone()).collect(),
            _ => Vec::new(),
        }
    }

    fn is_null(&self) -> bool {
        matches!(self.node.value, Value::Null)
    }

    fn is_map(&self) -> bool {
        matches!(self.node.value, Value::Map(_))
    }

    fn name(&self) -> String {
        if self.path.is_empty() { "the file".to_string() } else { self.path.clone() }
    }

    fn text(&self) -> Result<String, Self::Error> {
        match &self.node.value {
            Value::Text(text) => Ok(text.clone()),
            _ => self.wrong("a text"),
        }
    }

    fn number(&self) -> Result<f64, Self::Error> {
        match self.node.value {
            Value::Number(x) => Ok(x),
            _ => self.wrong("a number"),
        }
    }

    fn list(&self) -> Result<Vec<Self>, Self::Error> {
        let Value::List(list) = &self.node.value else { return self.wrong("a list") };
        let entry = |(k, node): (usize, &Node)| At {
            node: node.clone(),
            path: format!("{}[{k}]", self.path),
            place: node.place,
        };
        Ok(list.iter().enumerate().map(entry).collect())
    }

    fn wrong<T>(&self, expected: &str) -> Result<T, Self::Error> {
        let found = match &self.node.value {
            Value::Null => "null".to_string(),
            Value::Number(x) => x.to_string(),
            Value::Text(text) => format!("`{}`", crate::urdf::vocabulary::shown(text)),
            Value::Flag(flag) => flag.to_string(),
            Value::List(list) => format!("a list of {}", list.len()),
            Value::Map(_) => "a map".to_string(),
        };
        self.error(format!("{} is {found}, expected {expected}", self.name()))
    }

    fn error<T>(&self, message: String) -> Result<T, Self::Error> {
        Err((self.place, message))
    }
}
