//! `--controller FILE.json`: the controller, its gains, and its own model of the robot.

use crate::failure::{Failure, Result};
use crate::json_file;
use crate::robot::RobotArguments;
use mozzi::Model;
use mozzi_motion::controllers::{ComputedTorque, Gains, Law, PdGravity, TaskSpace};
use mozzi_motion::trajectories::Reference;
use mozzi_sim::Input;
use mozzi_urdf::json::{At, File, Object};
use serde_json::Value;
use std::path::Path;

/// A controller's file, and its robot if the file names one.
pub struct Controller {
    file: File,
    kind: String,
    /// The controller's own model, if it differs from the simulated robot.
    believed: Option<Model>,
}

/// Kinds of controllers and their keys.
const KINDS: [(&str, Object); 4] = [
    ("pd-gravity", Object::of(&["controller", "p", "d"]).optional(MODEL)),
    ("computed-torque", Object::of(&["controller", "p", "d"]).optional(MODEL)),
    ("task-space", Object::of(&["controller", "frame", "p", "d", "posture_p", "posture_d"]).optional(MODEL)),
    (
        "impedance",
        Object::of(&["controller", "frame", "stiffness", "damping", "posture_p", "posture_d"]).optional(MODEL),
    ),
];
const MODEL: &[&str] = &["model"];

impl Controller {
    pub fn read(name: &str, robot: &RobotArguments) -> Result<Self> {
        let file = json_file::read(name)?;
        let root = At::root(&file, "the controller's file");
        Object::of(&["controller"]).check_required(&root)?;
        let kind = root.get("controller").word(&KINDS.map(|(kind, _)| kind))?;
        KINDS.iter().filter(|(known, _)| *known == kind).try_for_each(|(_, keys)| keys.check_all(&root))?;
        let at = root.get("model");
        let believed = at.some(At::text)?.map(|name| Self::believed(&at, &name, robot)).transpose()?;
        Ok(Controller { kind: kind.to_string(), believed, file })
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

    /// For the page: "computed-torque of arm.json".
    pub fn name(&self) -> String {
        format!("{} of {}", self.kind, self.file.name)
    }

    /// Motors that follow a reference, with the model of the file's robot or else of this one.
    pub fn follow<'a>(&'a self, robot: &'a Model, reference: &'a dyn Reference) -> Result<Box<dyn Input + 'a>> {
        let model = self.believed.as_ref().unwrap_or(robot);
        if model.n() != robot.n() || model.nq() != robot.nq() {
            let (found, expected) = (model.n(), robot.n());
            return Ok(self.at().get("model").error(format_args!(
                "model: the robot has {found} velocities, expected {expected}, the number of the simulated robot"
            ))?);
        }
        // one gain for each velocity of a joint; a floating base has no motors
        let base = model.base().velocities();
        let list = |key: &str| Ok::<_, Failure>([vec![0.0; base], self.list(key, model.n() - base)?].concat());
        let gains = |p: &str, d: &str| Ok::<_, Failure>(Gains { p: list(p)?, d: list(d)? });
        let place = |error: mozzi_motion::Error| Failure::wrong(format!("{}: {error}", self.file.name));
        Ok(match self.kind.as_str() {
            "pd-gravity" => Box::new(PdGravity::new(model, reference, gains("p", "d")?).map_err(place)?),
            "computed-torque" => Box::new(ComputedTorque::new(model, reference, gains("p", "d")?).map_err(place)?),
            kind => {
                let law = match kind {
                    "task-space" => Law::Acceleration { p: self.six("p")?, d: self.six("d")? },
                    _ => Law::Impedance { stiffness: self.six("stiffness")?, damping: self.six("damping")? },
                };
                let posture = gains("posture_p", "posture_d")?;
                Box::new(TaskSpace::new(model, reference, self.frame(model)?, law, posture).map_err(place)?)
            }
        })
    }

    fn at(&self) -> At<'_> {
        At::root(&self.file, "the controller's file")
    }

    fn frame(&self, model: &Model) -> Result<mozzi::FrameId> {
        let at = self.at().get("frame");
        Ok(model.frame(&at.text()?).or_else(|why| at.error(format_args!("frame: {why}")))?)
    }

    /// One number for all, or a list.
    fn list(&self, key: &str, count: usize) -> Result<Vec<f64>> {
        let at = self.at().get(key);
        Ok(match at.value {
            Value::Number(_) => vec![at.number()?; count],
            Value::Array(list) if list.len() == count => at.numbers()?,
            _ => at.wrong(format_args!("a number, or a list of {count}"))?,
        })
    }

    fn six(&self, key: &str) -> Result<[f64; 6]> {
        let list = self.list(key, 6)?;
        Ok(std::array::from_fn(|k| list[k]))
    }
}
