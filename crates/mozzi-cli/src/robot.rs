//! The robot that a command is about.

use crate::angles;
use crate::edits::{EditArguments, pinned};
use crate::failure::{self, Failure, Result};
use crate::numbers::{array, number};
use crate::xacro_arguments::XacroArguments;
use crate::{input, robot_json};
use clap::Args;
use mozzi::model::Problem;
use mozzi::quantities::INPUTS;
use mozzi::{Description, FrameId, Model, SO3};
use mozzi_urdf::{Consequence, Diagnostic, LoadError, Loaded, Policy, Settings, Severity, constraints};
use std::collections::BTreeMap;
use std::ops::Deref;
use std::path::{Path, PathBuf};

/// The number of printed warnings that do not change the motion; `mozzi check` prints all.
const WARNINGS: usize = 3;

/// A file of constraints that often lies next to a robot's.
const BESIDE: &str = "robot.yaml";

/// How the robot's file is read.
#[derive(Args, Debug)]
pub struct PolicyArguments {
    /// Treat warnings as errors
    #[arg(long)]
    strict: bool,
    /// Repair errors where possible, such as an unphysical inertia, and report each repair
    #[arg(long, conflicts_with = "strict")]
    lenient: bool,
    /// Floating base: θ begins with its quaternion (w, x, y, z) and origin, θ̇ with its twist (ω, v), τ with the wrench
    /// on it
    #[arg(long)]
    floating: bool,
    /// Add the constraints of this file, which close loops or pin frames, and its motors: mozzi's JSON or YAML, or
    /// robot.yaml with `closed_loop`
    #[arg(long, value_name = "FILE")]
    constraints: Option<PathBuf>,
    #[command(flatten)]
    xacro: XacroArguments,
}

impl PolicyArguments {
    /// Whether `--floating` freed the base.
    pub fn frees(&self) -> bool {
        self.floating
    }

    /// How a robot's file is read.
    pub fn settings(&self) -> Settings {
        let policy = match (self.strict, self.lenient) {
            (true, _) => Policy::Strict,
            (_, true) => Policy::Lenient,
            _ => Policy::Default,
        };
        Settings { policy, xacro: self.xacro.arguments() }
    }

    /// A file, standard input for `-`, or an embedded robot by its name.
    pub fn open(&self, name_or_path: &str) -> std::result::Result<Loaded, LoadError> {
        let settings = self.settings();
        let loaded = if name_or_path == "-" {
            let cannot = |source| LoadError::File { path: input::name(name_or_path).into(), source };
            mozzi_urdf::parse_with(input::name(name_or_path), input::robot_text().map_err(cannot)?, settings)?
        } else {
            mozzi_urdf::open_with(name_or_path, settings)?
        };
        if mozzi_urdf::embedded::text(name_or_path).is_some_and(|_| Path::new(name_or_path).is_file()) {
            failure::note(&format!("`{name_or_path}` is a file here and an embedded robot; the file is read"));
        }
        Ok(Loaded { description: self.freed(loaded.description), ..loaded })
    }

    /// The robot, with a floating base if `--floating` is given.
    pub fn freed(&self, robot: Description) -> Description {
        if self.floating { robot.floating() } else { robot }
    }

    /// As [`open`](Self::open), and prints every warning that changes the motion, some of the others, and the number of
    /// unused attributes and elements.
    fn load(&self, name_or_path: &str) -> Result<Loaded> {
        let loaded = self.open(name_or_path)?;
        let code = |warning: &Diagnostic| mozzi_urdf::consequence(warning.code());
        print(name_or_path, &loaded.warnings, code, |warning| format!("{warning}\n"));
        mozzi_urdf::unused(&loaded.unused).iter().for_each(|count| failure::note(count));
        Ok(loaded)
    }

    /// Adds the constraints of `--constraints`. Without the flag, prints a note if a `robot.yaml` is next to the
    /// robot's file.
    pub fn constrained(&self, name_or_path: &str, robot: Description) -> Result<Description> {
        if let Some(file) = &self.constraints {
            return Ok(constraints::read(file, robot)?);
        }
        let beside = Path::new(name_or_path).with_file_name(BESIDE);
        if Path::new(name_or_path).is_file() && beside.is_file() {
            let beside = beside.display();
            failure::note(&format!("{beside} is not read; --constraints {beside} adds its constraints"));
        }
        Ok(robot)
    }

    /// The robot of a file of any kind.
    pub fn model(&self, name_or_path: &str) -> Result<Model> {
        self.model_and_axes(name_or_path).map(|(model, _)| model)
    }

    /// The model, and the axes in which the file gives inertias.
    pub fn model_and_axes(&self, name_or_path: &str) -> Result<(Model, BTreeMap<String, SO3>)> {
        if !robot_json::is_json(name_or_path) {
            let Loaded { description, inertial_axes, .. } = self.load(name_or_path)?;
            return Ok((self.constrained(name_or_path, description)?.build()?, inertial_axes));
        }
        let robot = self.constrained(name_or_path, self.freed(robot_json::read(name_or_path)?))?;
        let (errors, warnings) = self.problems(&robot);
        if self.strict && !errors.is_empty() {
            return Err(Failure::wrong(format!("{name_or_path} is refused: {}", errors[0])));
        }
        let code = |problem: &Problem| mozzi_urdf::consequence(problem.code);
        print(name_or_path, &warnings, code, |problem| format!("{name_or_path}: warning: {problem}\n"));
        Ok((robot.build()?, BTreeMap::new()))
    }

    /// Errors and warnings for a robot without source text. Nothing is repaired here: repairs were made, if requested,
    /// when the file was written.
    pub fn problems(&self, robot: &Description) -> (Vec<Problem>, Vec<Problem>) {
        let is_error = |problem: &Problem| self.strict || problem.severity == Severity::Error;
        let (errors, mut warnings): (Vec<_>, Vec<_>) = robot.check().into_iter().partition(is_error);
        warnings.sort_by_key(|problem| mozzi_urdf::consequence(problem.code));
        (errors, warnings)
    }
}

/// Prints warnings, which are in order of consequence.
fn print<T>(name: &str, warnings: &[T], consequence: impl Fn(&T) -> Consequence, text: impl Fn(&T) -> String) {
    let motion = warnings.iter().filter(|warning| consequence(warning) == Consequence::Motion).count();
    warnings.iter().take(motion + WARNINGS).for_each(|warning| failure::write(&text(warning)));
    if warnings.len() > motion + WARNINGS {
        failure::note(&format!("{} warnings in total; `mozzi check {name}` shows them", warnings.len()));
    }
}

/// A robot's file, and how it is read.
#[derive(Args, Debug)]
pub struct FileArguments {
    /// A file (URDF, xacro, MJCF, SDFormat, or JSON of `mozzi convert`), - for standard input, or an embedded robot:
    /// anymal, double_pendulum, furuta_pendulum, panda, two_link_planar, ur5
    pub model: String,
    /// The frame for poses, Jacobians and the tip's wrench; required if the robot branches
    #[arg(long, value_name = "FRAME", visible_alias = "frame", aliases = ["ee", "tool", "tip"])]
    pub end_effector: Option<String>,
    /// Gravity in {s} (the frame of a fixed base), m/s²; one number points down, and earth, moon, mars and none are
    /// known [default: the robot's own, else 0,0,-9.81]
    #[arg(long, value_name = "X,Y,Z")]
    pub gravity: Option<String>,
    /// Print one JSON object with all digits instead of text
    #[arg(long)]
    pub json: bool,
    /// Angles of flags and of printed text are in degrees; those of files, tables and JSON stay in radians. Single
    /// angles: 45deg, pi/4
    #[arg(long, aliases = ["degrees", "degree"])]
    deg: bool,
    #[command(flatten)]
    policy: PolicyArguments,
}

/// A robot, and its edits.
#[derive(Args, Debug)]
pub struct RobotArguments {
    #[command(flatten)]
    file: FileArguments,
    #[command(flatten)]
    edits: EditArguments,
    /// Pin a frame where it is, at --theta or the robot's start, also its orientation unless =point follows; may be
    /// repeated
    #[arg(long, value_name = "FRAME[=point]")]
    pin: Vec<String>,
}

impl Deref for RobotArguments {
    type Target = FileArguments;

    fn deref(&self) -> &FileArguments {
        &self.file
    }
}

impl RobotArguments {
    /// Loads the robot with its edits and prints its warnings.
    pub fn load(&self) -> Result<Model> {
        self.load_at(|model| Ok(model.start().theta))
    }

    /// As [`load`](Self::load); frames are pinned where they are at these positions.
    pub fn load_at(&self, theta: impl FnOnce(&Model) -> Result<Vec<f64>>) -> Result<Model> {
        let model = self.edits.apply(self.file.load()?)?;
        if self.pin.is_empty() {
            return Ok(model);
        }
        let theta = theta(&model)?;
        pinned(model, &self.pin, &theta)
    }
}

/// Three numbers, or one that points down, or the body on whose surface it is.
fn gravity(text: &str) -> Result<[f64; 3]> {
    const BODIES: [(&str, f64); 4] = [("earth", 9.81), ("moon", 1.62), ("mars", 3.72), ("none", 0.0)];
    let down = |size: f64| [0.0, 0.0, -size];
    let is_name = text.trim().starts_with(char::is_alphabetic);
    match BODIES.iter().find(|(name, _)| name.eq_ignore_ascii_case(text.trim())) {
        Some((_, size)) => Ok(down(*size)),
        None if is_name && !text.contains(',') => {
            let names = BODIES.map(|(name, _)| name).join(", ");
            Err(Failure::wrong(format!("--gravity is `{text}`, expected a number, a vector X,Y,Z, or one of {names}")))
        }
        None if !text.contains(',') => match number("--gravity", text)? {
            size if size < 0.0 => Err(Failure::wrong(format!(
                "--gravity is {text}: one number is the size of gravity, which points down; expected {}, or the vector \
                 0,0,{text}",
                -size
            ))),
            size => Ok(down(size)),
        },
        None => array("--gravity", text, ["x", "y", "z"]),
    }
}

impl FileArguments {
    /// Whether warnings are errors.
    pub fn is_strict(&self) -> bool {
        self.policy.strict
    }

    /// How its file is read.
    pub fn settings(&self) -> Settings {
        self.policy.settings()
    }

    /// Another robot, read by the same policy and under the same gravity.
    pub fn load_other(&self, name_or_path: &str) -> Result<Model> {
        self.under_gravity(self.policy.model(name_or_path)?)
    }

    /// The text of the file if it is URDF, after the expansion of xacro: its numbers with all their decimals.
    pub fn urdf_text(&self) -> Option<String> {
        let is_file = Path::new(&self.model).is_file() || self.model == "-";
        if robot_json::is_json(&self.model) {
            return None;
        }
        if !is_file {
            return mozzi_urdf::embedded::text(&self.model).map(str::to_string);
        }
        let text = input::robot_file(&self.model).ok()?;
        let expanded = mozzi_urdf::expanded(input::name(&self.model), text.as_bytes(), self.settings()).ok()?;
        Some(expanded.unwrap_or(text)).filter(|text| text.contains("<robot"))
    }

    fn under_gravity(&self, model: Model) -> Result<Model> {
        match &self.gravity {
            None => Ok(model),
            Some(text) => Ok(model.with_gravity(gravity(text)?)?),
        }
    }

    /// Loads the robot and prints its warnings.
    pub fn load(&self) -> Result<Model> {
        let mut model = self.load_other(&self.model)?;
        if let Some(name) = &self.end_effector {
            model = model.with_end_effector(model.frame(name)?)?;
        }
        Ok(model)
    }
}

/// The end effector, or `None` with a note that quantities are omitted.
pub fn end_effector(model: &Model) -> Option<FrameId> {
    match model.end_effector() {
        Ok(frame) => Some(frame),
        Err(error) => {
            failure::note(&format!("{error}; without --end-effector, quantities that need it are omitted"));
            None
        }
    }
}

/// The alternatives of a unit for this robot's joints: turning joints, sliding joints, or both.
pub enum Units {
    Turning,
    Sliding,
    Both,
}

/// Lines that fit a screen: an arm's, or a humanoid's.
pub fn screen(model: &Model) -> usize {
    if model.n() <= 8 { 60 } else { 100 }
}

/// The name of {s} for this robot.
pub fn space_frame(model: &Model) -> &'static str {
    if model.is_floating() { "the space frame {s}" } else { "the base frame" }
}

impl Units {
    /// A floating base both turns and slides.
    pub fn of(model: &Model) -> Self {
        let is_free = |place: &mozzi::Place| place.freedom == mozzi::Freedom::Free;
        match model.joints().filter(|joint| joint.kind.name() == "prismatic").count() {
            _ if model.configuration_space().places().iter().any(is_free) => Units::Both,
            0 => Units::Turning,
            all if all == model.n() => Units::Sliding,
            _ => Units::Both,
        }
    }

    /// "N m" from "N m or N"; the unit of turning joints precedes that of sliding ones. A ratio is a number for both.
    pub fn own(&self, unit: &str) -> String {
        let (units, each) = unit.split_at(unit.find(", each").unwrap_or(unit.len()));
        let mut alternatives = units.split(", ").flat_map(|part| part.split(" or "));
        let own = match self {
            Units::Turning => alternatives.next(),
            Units::Sliding => alternatives.clone().find(|unit| *unit == "1").or_else(|| alternatives.last()),
            Units::Both => None,
        };
        format!("{}{each}", own.unwrap_or(units))
    }

    /// The unit of positions, velocities, accelerations or forces: the first inputs of [`INPUTS`].
    pub fn input(&self, index: usize) -> String {
        self.shown(INPUTS[index].name, INPUTS[index].unit)
    }

    /// An input's unit on a page: with `--deg`, positions and their rates are in degrees.
    pub fn shown(&self, name: &str, unit: &str) -> String {
        let is_of_angles = ["theta", "dtheta", "ddtheta"].contains(&name);
        if is_of_angles { angles::unit(&self.own(unit)) } else { self.own(unit) }
    }
}
