//! What a library is asked: the file, and states of every joint by name.

use crate::constants::Constants;
use crate::{Result, Source};
use mozzi::random::Random;
use mozzi::{Base, Description};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// One number for each joint that moves, mimic joints included, which are where they follow to.
#[derive(Clone, Debug)]
pub struct State {
    pub theta: Vec<f64>,
    pub dtheta: Vec<f64>,
    pub ddtheta: Vec<f64>,
}

#[derive(Clone, Debug)]
pub struct Question {
    pub source: Source,
    /// Every joint that moves.
    pub names: Vec<String>,
    /// Its screw axis at home, by which a library's joint of another name is known.
    pub axes: Vec<[f64; 6]>,
    pub states: Vec<State>,
    /// The file's own base floats: it is compared at rest at {s}, where every convention has the same axes.
    pub floating: bool,
}

impl Question {
    pub fn new(source: Source, robot: &Description, states: usize, seed: u64) -> Result<Self> {
        let constants = Constants::of(robot)?;
        let names: Vec<String> = constants.joints.iter().map(|joint| joint.name.clone()).collect();
        let axes = constants.joints.iter().map(|joint| joint.axes[0]).collect();
        let mut random = Random(seed);
        let states = (0..states).map(|_| State::random(robot, &names, &mut random)).collect();
        Ok(Question { source, names, axes, states, floating: robot.base == Base::Floating })
    }

    /// As a library's script reads it. `mimic` asks Pinocchio to couple mimic joints.
    pub fn json(&self, library: &str, mimic: bool) -> Value {
        let joint = |(name, axis): (&String, &[f64; 6])| json!({ "name": name, "axis": axis });
        let state = |state: &State| json!({ "theta": state.theta, "dtheta": state.dtheta, "ddtheta": state.ddtheta });
        json!({
            "library": library, "mimic": mimic, "floating": self.floating,
            "language": self.source.language, "path": self.source.path, "text": self.source.text,
            "joints": self.names.iter().zip(&self.axes).map(joint).collect::<Value>(),
            "names": self.names,
            "states": self.states.iter().map(state).collect::<Value>(),
        })
    }
}

impl State {
    /// Within the limits, so that no library adds the force of an end stop; rates about 1.
    fn random(robot: &Description, names: &[String], random: &mut Random) -> Self {
        let joints: BTreeMap<&str, _> = robot.joints.iter().map(|joint| (joint.name.as_str(), joint)).collect();
        let mut values: BTreeMap<&str, [f64; 3]> = BTreeMap::new();
        for name in names {
            let Some(joint) = joints.get(name.as_str()) else { continue };
            let reach = if joint.kind.name() == "prismatic" { 0.5 } else { PI };
            let [low, high] = joint.limits.position.unwrap_or([-reach, reach]);
            // limits that exclude 0 by far are kept to; half a per mille off the stops themselves
            let (low, high) =
                if low > reach || high < -reach { (low, high) } else { (low.max(-reach), high.min(reach)) };
            let at = 0.0005 + 0.999 * (0.5 + 0.5 * random.next());
            values.insert(name, [low + (high - low) * at, random.next(), 2.0 * random.next()]);
        }
        let of = |name: &String| {
            let Some(followed) = robot.source_of(name) else { return [0.0; 3] };
            let name = &robot.joints[followed.joint].name;
            let [theta, dtheta, ddtheta] = values.get(name.as_str()).copied().unwrap_or_default();
            [followed.ratio * theta + followed.offset, followed.ratio * dtheta, followed.ratio * ddtheta]
        };
        let all: Vec<[f64; 3]> = names.iter().map(of).collect();
        let column = |k: usize| all.iter().map(|values| values[k]).collect();
        State { theta: column(0), dtheta: column(1), ddtheta: column(2) }
    }
}
