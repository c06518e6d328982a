//! A random state.

use mozzi::model::description::Joint;
use mozzi::random::Random;
use mozzi::{Description, Freedom, Model, SE3, SO3, Vec3};
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// A state of the robot with independent mimic joints; here the mimic joints follow their source joints. A floating
/// base is at rest at {s}.
#[derive(Clone, Debug)]
pub struct State {
    pub theta: Vec<f64>,
    pub dtheta: Vec<f64>,
    pub ddtheta: Vec<f64>,
}

impl State {
    /// All joints at 0, at rest.
    pub fn home(freed: &Model) -> Self {
        let rest = vec![0.0; freed.n()];
        State { theta: freed.neutral_configuration(), dtheta: rest.clone(), ddtheta: rest }
    }

    /// Within the limits, so that no library adds the force of an end stop; rates about 1.
    pub fn random(robot: &Description, freed: &Model, random: &mut Random) -> Self {
        let mut state = State::home(freed);
        let mut values: BTreeMap<&str, [f64; 3]> = BTreeMap::new();
        for (joint, place) in freed.joints().zip(freed.places()) {
            if place.freedom == Freedom::One {
                values.insert(&joint.name, of_one_axis(joint, random));
                continue;
            }
            state.theta[place.positions()].copy_from_slice(&pose(joint, random)[..place.freedom.positions()]);
            let n = place.freedom.velocities();
            state.dtheta[place.velocities()].copy_from_slice(&random.vector(n, 1.0));
            state.ddtheta[place.velocities()].copy_from_slice(&random.vector(n, 2.0));
        }
        for (joint, place) in freed.joints().zip(freed.places()).filter(|(_, place)| place.freedom == Freedom::One) {
            let Some(followed) = robot.source_of(&joint.name) else { continue };
            let [theta, dtheta, ddtheta] =
                values.get(robot.joints[followed.joint].name.as_str()).copied().unwrap_or_default();
            state.theta[place.q] = followed.ratio * theta + followed.offset;
            (state.dtheta[place.j], state.ddtheta[place.j]) = (followed.ratio * dtheta, followed.ratio * ddtheta);
        }
        state
    }
}

/// Random position, velocity and acceleration. Limits that exclude a range around 0 are respected.
fn of_one_axis(joint: &Joint, random: &mut Random) -> [f64; 3] {
    let reach = if joint.kind.name() == "prismatic" { 0.5 } else { PI };
    let [low, high] = joint.limits.bounds();
    let low = low.max((-reach).min(high - 2.0 * reach));
    let high = high.min(reach.max(low + 2.0 * reach));
    [low + (high - low) * within(random), random.next(), 2.0 * random.next()]
}

/// The pose of a ball or a free joint: rotated by an angle within the limit, the origin within 1 m.
fn pose(joint: &Joint, random: &mut Random) -> [f64; 7] {
    let most = joint.limits.position.map_or(PI, |[_, high]| high.min(PI));
    let (w, p) = (Vec3(random.array()), Vec3(random.array()));
    SE3 { R: SO3::exp(w * (most * within(random) / w.norm())), p }.to_pose()
}

/// A random number in 0 … 1, half a per mille away from the ends.
fn within(random: &mut Random) -> f64 {
    0.0005 + 0.999 * (0.5 + 0.5 * random.next())
}
