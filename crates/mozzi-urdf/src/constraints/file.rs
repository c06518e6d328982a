//! A file of constraints: its contents.

use super::closed_loop;
use super::{entry, yaml};
use crate::files;
use crate::json::{At, Misplaced, Object, Read};
use mozzi::Description;
use mozzi::model::description::{Constraint, Limits};
use mozzi::model::{Element, Severity};
use std::fmt;
use std::path::{Path, PathBuf};

/// Larger files are refused.
const MOST_BYTES: u64 = 16 << 20;
/// A file in mozzi's format.
const FILE: Object = Object::of(&["constraints"]).optional(&["motors"]);

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
    let one = |error: Misplaced| ConstraintsError::Refused(vec![error]);
    let file = yaml::parse(file, text).map_err(one)?;
    let root = At::root(&file, "the file");
    if root.has("closed_loop") {
        for (joint, kind) in closed_loop::retyped(&root, &robot).map_err(one)? {
            if robot.joints[joint].kind != kind {
                (robot.joints[joint].kind, robot.joints[joint].mimic) = (kind, None);
                robot.joints[joint].limits = Limits::default();
            }
        }
    }
    let contents = contents(&root, &robot).map_err(one)?;
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
        .filter_map(|problem| {
            Some(Misplaced::at(&file.name, place(problem.element, problem.attribute)?, problem.to_string()))
        })
        .collect();
    if errors.is_empty() { Ok(robot) } else { Err(ConstraintsError::Refused(errors)) }
}

fn contents(at: &At, robot: &Description) -> Read<Contents> {
    if !at.value.is_object() {
        return at.wrong("a map with the key `constraints`, or `closed_loop`");
    }
    if at.has("closed_loop") {
        return closed_loop::contents(at, robot);
    }
    entry::check(&FILE, at)?;
    let list = at.get("constraints").list()?;
    let constraints = list.iter().map(|at| Ok((entry::constraint(at)?, at.position()))).collect::<Read<_>>()?;
    let motors = at.get("motors");
    Ok(Contents { constraints, motors: motors.some(At::texts)?, place_of_motors: motors.position() })
}
