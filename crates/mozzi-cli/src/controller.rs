//! `--controller`: one by its name, with gains by a time constant, or a JSON file with its gains and its own model of
//! the robot.

use crate::failure::{Failure, Result};
use crate::json_file;
use crate::robot::RobotArguments;
use mozzi::{FrameId, Model, SE3, Task, TaskFrame, Vec3};
use mozzi_motion::controllers::{ComputedTorque, Gains, Law, PdGravity, Standing, TaskSpace};
use mozzi_motion::trajectories::Reference;
use mozzi_sim::{ContactPoint, Contacts, Input, PlaneMotion};
use mozzi_urdf::json::{At, File, Object};
use serde_json::Value;
use std::path::Path;

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

/// Kinds of controllers and the keys of their files; without a frame it is the end effector, without gains of the
/// posture these follow from the time constant.
const KINDS: [(&str, Object); 5] = [
    ("pd-gravity", Object::of(&["controller", "p", "d"]).optional(&["model"])),
    ("computed-torque", Object::of(&["controller", "p", "d"]).optional(&["model"])),
    ("task-space", Object::of(&["controller", "p", "d"]).optional(OF_FRAME)),
    ("impedance", Object::of(&["controller", "stiffness", "damping"]).optional(OF_FRAME)),
    ("standing", Object::of(&["controller"]).optional(&["model"])),
];
const OF_FRAME: &[&str] = &["model", "frame", "posture_p", "posture_d"];

/// Name of the file in errors.
const WHOLE: &str = "the controller's file";

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
        if KINDS.iter().any(|(kind, _)| *kind == alias) && !Path::new(name).is_file() {
            return Ok(Controller { file: None, kind: alias.to_string(), response, believed: None });
        }
        let names = KINDS.map(|(kind, _)| kind).join(", ");
        if !name.contains(['.', '/', '\\']) && !Path::new(name).exists() {
            return Err(Failure::wrong(format!("--controller is `{name}`, expected one of {names}, or a JSON file")));
        }
        let file = json_file::read(name)?;
        let root = At::root(&file, WHOLE);
        Object::of(&["controller"]).check_required(&root)?;
        let kind = root.get("controller").word(&KINDS.map(|(kind, _)| kind))?;
        KINDS.iter().filter(|(known, _)| *known == kind).try_for_each(|(_, keys)| keys.check_all(&root))?;
        let at = root.get("model");
        let believed = at.some(At::text)?.map(|name| Self::believed(&at, &name, robot)).transpose()?;
        Ok(Controller { kind: kind.to_string(), believed, response, file: Some(file) })
    }

    /// The controller's own model. Its errors have no words of its file: the controller's file may name any file.
    fn believed(at: &At, name: &str, robot: &RobotArguments) -> Result<Model> {
        let path = Path::new(name);
        if path.exists() && !path.is_file() {
            return Ok(at.wrong("a regular file, or an embedded robot")?);
        }
        let sentence = match robot.load_other(name) {
            Ok(model) => return Ok(model),
            Err(Failure::Wrong(sentence)) => sentence,
            Err(Failure::Load(error)) => match error.errors().next() {
                None => error.to_string(),
                Some(first) => {
                    let (count, line, code) = (error.errors().count(), first.line(), first.code());
                    let errors = if count == 1 { "1 error".to_string() } else { format!("{count} errors") };
                    format!("{name} is refused: {errors}, first {code} in line {line}; `mozzi check {name}` shows them")
                }
            },
            Err(other) => return Err(other),
        };
        Ok(at.error(format_args!("model: {sentence}"))?)
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
        let same = robot.check_same_joints("the controller's robot", model);
        same.map_err(|error| Failure::wrong(format!("{}: model: {error}", self.place())))?;
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
                let (mut feet, ground) = feet(robot, contacts, &start)?;
                for foot in &mut feet {
                    let frame = model.frame(robot.frame_name(foot.frame));
                    foot.frame = frame.map_err(|why| Failure::wrong(format!("{}: model: {why}", self.place())))?;
                }
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
            let joints = match self.entry(key) {
                Some(at) => list(&at, model.n() - base)?,
                None => (base..model.n()).map(|j| default * inertias.map_or(1.0, |inertias| inertias[j])).collect(),
            };
            Ok([vec![0.0; base], joints].concat())
        };
        Ok(Gains { p: list(p, self.response.powi(-2))?, d: list(d, 2.0 / self.response)? })
    }

    /// The file's entry of this key, if there is one.
    fn entry<'s>(&'s self, key: &'s str) -> Option<At<'s>> {
        let file = self.file.as_ref()?;
        file.value.get(key)?;
        Some(At::root(file, WHOLE).get(key))
    }

    /// The file, or the flag.
    fn place(&self) -> String {
        self.file.as_ref().map_or_else(|| format!("--controller {}", self.kind), |file| file.name.clone())
    }

    /// The frame of the file, or the end effector.
    fn frame(&self, model: &Model) -> Result<FrameId> {
        match self.entry("frame") {
            None => Ok(model.end_effector()?),
            Some(at) => Ok(model.frame(&at.text()?).or_else(|why| at.error(format_args!("frame: {why}")))?),
        }
    }

    fn six(&self, key: &str) -> Result<[f64; 6]> {
        let list = self.entry(key).map_or_else(|| Ok(vec![0.0; 6]), |at| list(&at, 6))?;
        Ok(std::array::from_fn(|k| list[k]))
    }
}

/// One number for all, or a list.
fn list(at: &At, count: usize) -> Result<Vec<f64>> {
    Ok(match at.value {
        Value::Number(_) => vec![at.number()?; count],
        Value::Array(list) if list.len() == count => at.numbers()?,
        _ => at.wrong(format_args!("a number, or a list of {count}"))?,
    })
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
