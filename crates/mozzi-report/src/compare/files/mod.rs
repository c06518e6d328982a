//! Compares the files of one robot, without a simulator: [`compare_files`] matches joints by name and place, compares M
//! and forces at random states, and searches for the causes.
//!
//! Each link is compared in its own frame, as if all before it were equal: `places` finds where the second robot has
//! it, by its frame, its joints and its inertia.
//!
//! A cause is a change of the first robot that makes one of its numbers the second's. If all causes together make the
//! forces agree, the list is complete. Its reason is an error of a converter which, made with the first file's numbers,
//! gives the second's.

mod actuation;
mod cause;
mod comparison;
mod constraints;
mod forces;
mod frames;
mod inertia;
mod joints;
mod matching;
mod merged;
mod moments;
mod number;
mod place;
mod places;
mod report;
mod rotation;
mod rotors;
mod shapes;
mod solid;
mod starts;
mod trial;

pub use comparison::{FilesComparison, compare_files};

use mozzi::{Model, SO3};
use mozzi_urdf::geometry::Shape;
use mozzi_urdf::mjcf::Actuation;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// One of the two robots.
#[derive(Clone, Debug)]
pub struct RobotFile {
    /// The file's name.
    pub name: String,
    /// The robot.
    pub model: Model,
    /// The axes in which the file gives each link's inertia, in the link's: see
    /// [`Loaded::inertial_axes`](mozzi_urdf::Loaded::inertial_axes).
    pub inertial_axes: BTreeMap<String, SO3>,
    /// The shapes of its links; none if those of its format are not read.
    pub shapes: Option<Vec<Shape>>,
    /// Whether its format holds where the robot starts. URDF does not: there a start is no difference.
    pub has_start: bool,
    /// Whether its format holds limits of velocity and acceleration. MJCF does not: there a lost one is no difference.
    pub has_rates: bool,
    /// Its actuators and gravity compensation; none if its format does not hold them.
    pub actuation: Option<Actuation>,
    /// Its place, from which meshes are found; without it they are not read.
    pub path: Option<PathBuf>,
}
