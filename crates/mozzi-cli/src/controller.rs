//! `--controller`: one by its name, with gains by a time constant, or a JSON file with its gains and its own model of
//! the robot.

use crate::failure::{Failure, Result};
use crate::json_file;
use crate::robot::RobotArguments;
use mozzi::simulation::{ContactPoint, Contacts, Input, PlaneMotion};
use mozzi::{FrameId, Model, SE3, Task, TaskFrame, Vec3};
use mozzi_motion::controllers::{ComputedTorque, Gains, Law, PdGravity, Standing, TaskSpace};
use mozzi_motion::trajectories::Reference;
use mozzi_urdf::json::{File, Step, unknown_key};
use serde_json::Value;

/// A controller, and its robot if its file names one.
pub struct Controller {
    /// None if all gains follow from the time constant.
    file: Option<File>,
    kind: String,
    /// 1/ω: errors fall as in ë + 2ω ė + ω² e = 0, s.
    response: f64,
    /// The controller's own model, if it differs from the simulated robot.
    believed: Option<Model>,
}

/// Kinds of controllers and their entries in a file, in which `model` is accepted, too; those of the posture may be
/// left out.
const KINDS: [(&str, &[&str]); 5] = [
    ("pd-gravity", &["p", "d"]),
    ("computed-torque", &["p", "d"]),
    ("task-space", &["frame", "p", "d", "posture_p", "posture_d"]),
    ("impedance", &["frame", "stiffness", "damping", "posture_p", "posture_d"]),
    ("standing", &[]),
];

/// Other names of kinds.
const ALIASES: [(&str, &str); 4] = [
    ("pd", "pd-gravity"),
    ("pd_gravity", "pd-gravity"),
    ("ctc", "computed-torque"),
    ("computed_torque", "computed-torque"),
];

/// Feet of `standing` are the contact points this near to the ground at the start, m.
const STANDS: f64 = 2e-3;

impl Controller {
    pub fn read(name: &str, response: f64, robot: &RobotArguments) -> Result<Self> {
        if !(response > 0.0 && response.is_finite()) {
            return Err(Failure::wrong(format!("--response is {response} s, expected a positive time constant")));
        }
        let alias = ALIASES.iter().find(|(alias, _)| *alias == name).map_or(name, |(_, kind)| kind);
        if KINDS.iter().any(|(kind, _)| *kind == alias) && !std::path::Path::new(name).is_file() {
            return Ok(Controller { file: None, kind: alias.to_string(), response, believed: None });
        }
        let names = KINDS.map(|(kind, _)| kind).join(", ");
        if !name.contains(['.', '/', '\\']) && !std::path::Path::new(name).exists() {
            return Err(Failure::wrong(format!("--controller is `{name}`, expected one of {names}, or a JSON file")));
        }
        Self::from_file(json_file::read(name)?, response, robot)
    }

    fn from_file(file: File, response: f64, robot: &RobotArguments) -> Result<Self> {
        let whole = |sentence: String| Failure::from(file.wrong(&[], sentence));
        let wrong = |key: &str, sentence: String| Failure::from(file.wrong(&[Step::Key(key)], sentence));
        let Value::Object(entries) = &file.value else { return Err(whole("is not a JSON object".into())) };
        let kinds = KINDS.map(|(kind, _)| format!("`{kind}`")).join(", ");
        let kind = match entries.get("controller") {
            Some(Value::String(kind)) => kind.as_str(),
            Some(other) => return Err(wrong("controller", format!("controller: is {other}, expected one of {kinds}"))),
            None => return Err(whole(format!("`controller` is missing, expected one of {kinds}"))),
        };
        let Some((kind, needed)) = KINDS.iter().find(|(known, _)| *known == kind) else {
            return Err(wrong("controller", format!("controller: is `{kind}`, expected one of {kinds}")));
        };
        let known = [&["controller"], *needed, &["model"]].concat();
        if let Some(unknown) = entries.keys().find(|key| !known.contains(&key.as_str())) {
            return Err(wrong(unknown, unknown_key(unknown, &format!("`{kind}`"), &known)));
        }
        let is_missing = |key: &&&str| !entries.contains_key(**key) && !key.starts_with("posture") && **key != "frame";
        if let Some(missing) = needed.iter().find(is_missing) {
            return Err(whole(format!("`{missing}` is missing; `{kind}` needs it")));
        }
        let believed = match entries.get("model") {
            None => None,
            Some(Value::String(name)) => Some(robot.load_other(name).map_err(|failure| match failure {
                Failure::Wrong(sentence) => wrong("model", format!("model: {sentence}")),
                Failure::Load(error) if error.diagnostics().is_empty() => wrong("model", format!("model: {error}")),
                other => other, // points into the robot's own file
            })?),
            Some(other) => {
                return Err(wrong("model", format!("model: is {other}, expected a file or an embedded robot")));
            }
        };
        Ok(Controller { kind: kind.to_string(), believed, response, file: Some(file) })
    }

    /// For the page: "computed-torque of arm.json", "computed-torque, response 0.1 s".
    pub fn name(&self) -> String {
        match &self.file {
            Some(file) => format!("{} of {}", self.kind, file.name),
            None => format!("{}, response {} s", self.kind, self.response),
        }
    }

    /// Motors that follow a reference, with the model of the file's robot or else of this one.
    pub fn follow<'a>(
        &'a self,
        robot: &'a Model,
        reference: &'a dyn Reference,
        contacts: &Contacts,
    ) -> Result<Box<dyn Input + 'a>> {
        let model = self.believed.as_ref().unwrap_or(robot);
        if model.n() != robot.n() || model.nq() != robot.nq() {
            let (found, expected) = (model.n(), robot.n());
            return Err(self.wrong(
                "model",
                format!("the robot has {found} velocities, expected {expected}, the number of the simulated robot"),
            ));
        }
        let place = |error: mozzi_motion::Error| Failure::wrong(format!("{}: {error}", self.place()));
        let start = reference.at(0.0).theta;
        Ok(match self.kind.as_str() {
            "pd-gravity" => {
                let M = model.mass_matrix(&start)?;
                let inertias: Vec<f64> = (0..model.n()).map(|j| M[(j, j)]).collect();
                Box::new(
                    PdGravity::new(model, reference, self.gains(model, "p", "d", Some(&inertias))?).map_err(place)?,
                )
            }
            "computed-torque" => {
                Box::new(ComputedTorque::new(model, reference, self.gains(model, "p", "d", None)?).map_err(place)?)
            }
            "standing" => {
                let (feet, ground) = feet(model, contacts, &start)?;
                let gains = Gains::critical(model.n(), 1.0 / self.response);
                Box::new(Standing::new(model, reference, gains, feet, ground).map_err(place)?)
            }
            kind => {
                let frame = self.frame(model)?;
                let [p, d] = [self.response.powi(-2), 2.0 / self.response];
                let law = match (kind, &self.file) {
                    ("task-space", Some(_)) => Law::Acceleration { p: self.six("p")?, d: self.six("d")? },
                    ("task-space", None) => Law::Acceleration { p: [p; 6], d: [d; 6] },
                    (_, Some(_)) => Law::Impedance { stiffness: self.six("stiffness")?, damping: self.six("damping")? },
                    (_, None) => {
                        let task = Task::all(frame, TaskFrame::Body);
                        let still = vec![0.0; model.n()];
                        let Lambda = model.task_space_dynamics(&start, &still, task, &model.environment());
                        let Lambda = Lambda.map_err(|error| {
                            Failure::wrong(format!(
                                "--controller impedance: {error}; another --theta, or computed-torque, controls the joints"
                            ))
                        })?;
                        let inertias: [f64; 6] = std::array::from_fn(|k| Lambda.Lambda[(k, k)]);
                        Law::Impedance { stiffness: inertias.map(|m| p * m), damping: inertias.map(|m| d * m) }
                    }
                };
                let posture = self.gains(model, "posture_p", "posture_d", None)?;
                Box::new(TaskSpace::new(model, reference, frame, law, posture).map_err(place)?)
            }
        })
    }

    /// Gains of each velocity of a joint, of the file or by the time constant, times the joints' inertias if the gains
    /// are on torques; a floating base has no motors.
    fn gains(&self, model: &Model, p: &str, d: &str, inertias: Option<&[f64]>) -> Result<Gains> {
        let base = model.base().velocities();
        let list = |key: &str, default: f64| -> Result<Vec<f64>> {
            let joints = match self.value(key) {
                Some(value) => self.list(key, value, model.n() - base)?,
                None => (base..model.n()).map(|j| default * inertias.map_or(1.0, |inertias| inertias[j])).collect(),
            };
            Ok([vec![0.0; base], joints].concat())
        };
        Ok(Gains { p: list(p, self.response.powi(-2))?, d: list(d, 2.0 / self.response)? })
    }

    fn value(&self, key: &str) -> Option<&Value> {
        self.file.as_ref()?.value.get(key)
    }

    /// The file, or the flag.
    fn place(&self) -> String {
        self.file.as_ref().map_or_else(|| format!("--controller {}", self.kind), |file| file.name.clone())
    }

    fn wrong(&self, key: &str, sentence: impl std::fmt::Display) -> Failure {
        match &self.file {
            Some(file) => file.wrong(&[Step::Key(key)], format!("{key}: {sentence}")).into(),
            None => Failure::wrong(format!("{}: {key}: {sentence}", self.place())),
        }
    }

    /// The frame of the file, or the end effector.
    fn frame(&self, model: &Model) -> Result<FrameId> {
        match self.value("frame") {
            None => Ok(model.end_effector()?),
            Some(Value::String(name)) => model.frame(name).map_err(|error| self.wrong("frame", error)),
            Some(other) => Err(self.wrong("frame", format_args!("is {other}, expected the name of a frame"))),
        }
    }

    /// One number for all, or a list.
    fn list(&self, key: &str, value: &Value, count: usize) -> Result<Vec<f64>> {
        let wrong = || self.wrong(key, format_args!("is {value}, expected a number, or a list of {count}"));
        match value {
            Value::Array(list) if list.len() == count => list.iter().map(|x| x.as_f64().ok_or_else(wrong)).collect(),
            other => Ok(vec![other.as_f64().ok_or_else(wrong)?; count]),
        }
    }

    fn six(&self, key: &str) -> Result<[f64; 6]> {
        let list = self.list(key, self.value(key).unwrap_or(&Value::Null), 6)?;
        Ok(std::array::from_fn(|k| list[k]))
    }
}

/// The contact points that are on the ground at the start, of each link the four corners, and the ground.
fn feet(model: &Model, contacts: &Contacts, theta: &[f64]) -> Result<(Vec<ContactPoint>, SE3)> {
    let needs = "--controller standing: the robot stands on no plane, expected --ground and a start on it";
    let Some(plane) = contacts.planes.first() else { return Err(Failure::wrong(needs)) };
    let PlaneMotion::Fixed(ground) = &plane.motion else {
        return Err(Failure::wrong("--controller standing: the first plane moves, expected a plane at rest"));
    };
    let gaps = contacts.gaps(model, 0.0, theta);
    let gap = |k: usize| gaps.get(k * contacts.planes.len()).copied().unwrap_or(f64::INFINITY);
    let mut standing: Vec<(FrameId, Vec<(Vec3, usize)>)> = Vec::new();
    for (k, point) in contacts.points.iter().enumerate().filter(|&(k, _)| gap(k) < STANDS) {
        let at = ground.inverse() * (model.forward_kinematics(theta, point.frame)? * point.center);
        match standing.iter_mut().find(|(frame, _)| *frame == point.frame) {
            Some((_, points)) => points.push((at, k)),
            None => standing.push((point.frame, vec![(at, k)])),
        }
    }
    let mut corners = Vec::new();
    for (_, points) in &standing {
        for [x, y] in [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]] {
            let along = |p: &Vec3| x * p.0[0] + y * p.0[1];
            let corner = points.iter().max_by(|(a, _), (b, _)| along(a).total_cmp(&along(b))).map(|(_, k)| *k);
            corners.extend(corner.filter(|k| !corners.contains(k)));
        }
    }
    match corners.is_empty() {
        true => Err(Failure::wrong(needs)),
        false => Ok((corners.into_iter().map(|k| contacts.points[k].clone()).collect(), *ground)),
    }
}
