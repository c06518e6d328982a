//! The input for a library: the file, and states of every joint by name.

use crate::compare::constants::{Constants, freed};
use crate::compare::convention::{Convention, Lists};
use crate::compare::state::State;
use crate::compare::{Result, Source};
use mozzi::random::Random;
use mozzi::{Base, Description, Model, Place};
use serde_json::{Value, json};

#[derive(Clone, Debug)]
pub struct Question {
    pub source: Source,
    /// Every joint that moves.
    pub names: Vec<String>,
    /// Its screw axis at home, which identifies the joint if the library has another name for it; zeros for a ball or a
    /// free joint.
    pub axes: Vec<[f64; 6]>,
    pub states: Vec<State>,
    /// The robot with independent mimic joints, to which the states belong. None if mozzi refuses the robot.
    pub freed: Option<Model>,
    /// True if the file's own base floats: it is compared at rest at {s}, where the axes of all conventions agree.
    pub floating: bool,
}

impl Question {
    pub fn new(source: Source, robot: &Description, states: usize, seed: u64) -> Result<Self> {
        let (constants, model) = (Constants::of(robot)?, freed(robot).build()?);
        let names = constants.joints.iter().map(|joint| joint.name.clone()).collect();
        let axes = constants.joints.iter().map(|joint| joint.axes[0]).collect();
        let mut random = Random(seed);
        let states = (0..states).map(|_| State::random(robot, &model, &mut random)).collect();
        Ok(Question { source, names, axes, states, freed: Some(model), floating: robot.base == Base::Floating })
    }

    /// The place of a joint's numbers in a state.
    pub fn place(&self, joint: &str) -> Option<&Place> {
        let k = self.names.iter().position(|known| known == joint)?;
        self.freed.as_ref()?.places().get(k)
    }

    /// Only the file, to check whether the library loads it.
    pub fn of_file(source: Source) -> Self {
        Question { source, names: Vec::new(), axes: Vec::new(), states: Vec::new(), freed: None, floating: false }
    }

    /// The JSON for a library's script, with states in the library's coordinates. `mimic` makes Pinocchio couple mimic
    /// joints.
    pub fn json(&self, library: &str, mimic: bool) -> Result<Value> {
        let (mut home, mut states, mut joints) = (Value::Null, Vec::new(), Vec::new());
        if let Some(model) = &self.freed {
            let convention = Convention::new(name_of(library), model)?;
            let at = |state: &State| convention.lists(model, &state.theta, &state.dtheta, &state.ddtheta);
            let listed =
                |[theta, dtheta, ddtheta]: Lists| json!({ "theta": theta, "dtheta": dtheta, "ddtheta": ddtheta });
            home = at(&State::home(model))?[0].clone().into();
            states = self.states.iter().map(|state| at(state).map(listed)).collect::<Result<_>>()?;
            joints = (self.names.iter().zip(&self.axes).zip(model.places()))
                .map(|((name, axis), place)| json!({ "name": name, "axis": axis, "nv": place.freedom.velocities() }))
                .collect();
        }
        Ok(json!({
            "library": library, "mimic": mimic, "floating": self.floating,
            "language": self.source.language, "path": self.source.path, "text": self.source.text,
            "joints": joints, "names": self.names, "home": home, "states": states,
        }))
    }
}

/// The name of a library of the script.
pub fn name_of(library: &str) -> &'static str {
    if library == "pinocchio" { "Pinocchio" } else { "MuJoCo" }
}
