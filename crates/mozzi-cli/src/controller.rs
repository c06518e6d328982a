//! `--controller FILE.json`: the controller, its gains, and its own model of the robot.

use crate::failure::{Failure, Result};
use crate::json_file;
use crate::robot::RobotArguments;
use mozzi::Model;
use mozzi_motion::controllers::{ComputedTorque, Gains, Law, PdGravity, TaskSpace};
use mozzi_motion::trajectories::Reference;
use mozzi_sim::Input;
use mozzi_urdf::json::{File, Step, unknown_key};
use serde_json::Value;

/// A controller's file, and its robot if the file names one.
pub struct Controller {
    file: File,
    kind: String,
    /// The controller's own model, if it differs from the simulated robot.
    believed: Option<Model>,
}

/// Kinds of controllers and their entries; all of them accept `model`.
const KINDS: [(&str, &[&str]); 4] = [
    ("pd-gravity", &["p", "d"]),
    ("computed-torque", &["p", "d"]),
    ("task-space", &["frame", "p", "d", "posture_p", "posture_d"]),
    ("impedance", &["frame", "stiffness", "damping", "posture_p", "posture_d"]),
];

impl Controller {
    pub fn read(name: &str, robot: &RobotArguments) -> Result<Self> {
        let file = json_file::read(name)?;
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
        if let Some(missing) = needed.iter().find(|key| !entries.contains_key(**key)) {
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
        Ok(Controller { kind: kind.to_string(), believed, file })
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
            return Err(self.wrong(
                "model",
                format!("the robot has {found} velocities, expected {expected}, the number of the simulated robot"),
            ));
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

    fn wrong(&self, key: &str, sentence: impl std::fmt::Display) -> Failure {
        self.file.wrong(&[Step::Key(key)], format!("{key}: {sentence}")).into()
    }

    fn frame(&self, model: &Model) -> Result<mozzi::FrameId> {
        match &self.file.value["frame"] {
            Value::String(name) => model.frame(name).map_err(|error| self.wrong("frame", error)),
            other => Err(self.wrong("frame", format_args!("is {other}, expected the name of a frame"))),
        }
    }

    /// One number for all, or a list.
    fn list(&self, key: &str, count: usize) -> Result<Vec<f64>> {
        let value = &self.file.value[key];
        let wrong = || self.wrong(key, format_args!("is {value}, expected a number, or a list of {count}"));
        match value {
            Value::Array(list) if list.len() == count => list.iter().map(|x| x.as_f64().ok_or_else(wrong)).collect(),
            other => Ok(vec![other.as_f64().ok_or_else(wrong)?; count]),
        }
    }

    fn six(&self, key: &str) -> Result<[f64; 6]> {
        let list = self.list(key, 6)?;
        Ok(std::array::from_fn(|k| list[k]))
    }
}
