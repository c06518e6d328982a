//! One joint follows the mouse.

use super::close::closed;
use super::entry::{text, three};
use crate::robot::Robot;
use mozzi::model::{Bounds, integrate};
use mozzi::nalgebra::{DMatrix, DVector, Vector3};
use mozzi::{Error, FrameId, Freedom, Model, Place, Vec3};
use serde_json::Value;

/// Steps of Gauss and Newton's method; damping relative to the largest entry of JᵀJ; the longest step.
const STEPS: usize = 12;
const DAMPING: f64 = 1e-6;
const LONGEST: f64 = 0.5;

/// Moves one joint so that a point of a frame is as near as possible to a goal in {s}. Loops close afterwards, around
/// the joint if they can.
pub fn drag(robot: &mut Robot, command: &Value) -> Result<Value, String> {
    let said = |error: Error| error.to_string();
    let (joint, frame) = (text(command, "joint")?, text(command, "frame")?);
    let (point, goal) = (Vec3(three(command, "point")?), Vec3(three(command, "goal")?));
    let model = robot.model();
    let frame = model.frame(frame).map_err(said)?;
    let mut theta = robot.theta().to_vec();
    let places = model.configuration_space().places();
    let base = usize::from(model.is_floating());
    let index = match joint {
        "base" if base == 1 => 0,
        name => {
            let known = model.joints().position(|joint| joint.name == name);
            base + known.ok_or_else(|| format!("there is no independent joint `{name}`"))?
        }
    };
    let (place, bounds) = (&places[index], Bounds::of(model));
    for _ in 0..STEPS {
        if !nearer(model, place, (frame, point, goal), &mut theta).map_err(said)? {
            break;
        }
        if let Some(k) = index.checked_sub(base) {
            bounds.put_within(&mut theta, k);
        }
    }
    match closed(robot, &theta, &[joint]) {
        Err(_) => closed(robot, &theta, &[]),
        done => done,
    }
}

/// A step of one joint; false if it is small. A free joint is moved, not turned.
fn nearer(
    model: &Model,
    place: &Place,
    (frame, point, goal): (FrameId, Vec3, Vec3),
    theta: &mut [f64],
) -> Result<bool, Error> {
    let T = model.forward_kinematics(theta, frame)?;
    let e = Vector3::from((goal - T * point).0);
    let J = model.body_jacobian(theta, frame)?;
    let velocities = place.velocities().skip(if place.freedom == Freedom::Free { 3 } else { 0 });
    let velocities: Vec<usize> = velocities.collect();
    let columns: Vec<_> =
        (velocities.iter()).map(|&j| Vector3::from((T.R * (J.0[j].v + J.0[j].w.cross(point))).0)).collect();
    let J = DMatrix::from_fn(3, columns.len(), |row, column| columns[column][row]);
    let mut square = J.transpose() * &J;
    let most = square.amax();
    if most == 0.0 {
        return Ok(false);
    }
    for k in 0..columns.len() {
        square[(k, k)] += DAMPING * most;
    }
    let Some(step) = square.cholesky().map(|factor| factor.solve(&(J.transpose() * e))) else { return Ok(false) };
    let step: DVector<f64> = if step.amax() > LONGEST { &step * (LONGEST / step.amax()) } else { step };
    let mut delta = vec![0.0; model.n()];
    velocities.iter().zip(step.iter()).for_each(|(&j, x)| delta[j] = *x);
    integrate(model, theta, &delta, 1.0);
    Ok(step.amax() > 1e-9)
}
