//! θ at which constraints hold, and robots put on the ground.

use super::entry::text;
use crate::robot::Robot;
use mozzi::Model;
use mozzi::model::Bounds;
use mozzi_sim::{Contacts, Plane};
use serde_json::{Value, json};

/// Closes loops: the joint of `hold` stays if that is possible.
pub fn close(robot: &mut Robot, command: &Value) -> Result<Value, String> {
    let hold: Vec<&str> = if command["hold"].is_null() { Vec::new() } else { vec![text(command, "hold")?] };
    let theta = robot.theta().to_vec();
    closed(robot, &theta, &hold)
}

/// Puts the nearest θ that satisfies the constraints into the inputs, and the nearest θ̇.
pub fn closed(robot: &mut Robot, guess: &[f64], hold: &[&str]) -> Result<Value, String> {
    let mut theta = guess.to_vec();
    if robot.model().constraint_rows() > 0 {
        theta = robot.model().assemble(guess, hold).map_err(|error| error.to_string())?;
        let dtheta = robot.model().assemble_velocities(&theta, robot.dtheta(), &[]);
        robot.put("dtheta", &dtheta.map_err(|error| error.to_string())?);
    }
    robot.put("theta", &theta);
    Ok(Value::Null)
}

/// Puts each joint that is beyond a limit, its own or a mimic joint's, onto it.
pub fn within(model: &Model, theta: &mut [f64]) {
    let bounds = Bounds::of(model);
    (0..bounds.joints.len()).for_each(|k| _ = bounds.put_within(theta, k));
}

/// Moves the inputs within the joints' limits, before a simulation that respects them.
pub fn put_within(robot: &mut Robot) -> Value {
    let mut theta = robot.theta().to_vec();
    within(robot.model(), &mut theta);
    robot.put("theta", &theta);
    Value::Null
}

/// Moves a floating base up or down until its lowest contact point is at z = 0. Returns that point's height before.
pub fn settle(robot: &mut Robot) -> Result<Value, String> {
    let mut theta = robot.theta().to_vec();
    let contacts = Contacts { points: robot.settings.points.clone(), planes: vec![Plane::ground()] };
    let gaps = contacts.gaps(robot.model(), 0.0, &theta);
    let lowest = gaps.into_iter().fold(f64::INFINITY, f64::min);
    if robot.model().is_floating() && lowest.is_finite() {
        theta[6] -= lowest;
        robot.put("theta", &theta);
    }
    Ok(json!({ "lowest": lowest.is_finite().then_some(lowest) }))
}
