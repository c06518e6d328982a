//! The end effector follows the mouse: inverse kinematics.

use super::close::closed;
use super::entry::{text, three};
use crate::robot::Robot;
use mozzi::{Base, FrameId, Model, SE3, Vec3};
use mozzi_motion::inverse_kinematics::{Options, Secondary};
use mozzi_motion::{Goal, InverseKinematics};
use serde_json::{Value, json};

/// One start: the nearest solution, or the nearest position to the goal.
const OPTIONS: fn() -> Options =
    || Options { starts: 1, iterations: 40, angle: 1e-6, distance: 1e-6, ..Options::default() };

/// Moves a frame's origin to a point of {s}, with its orientation if `keep` is true. A floating base stays;
/// constraints are closed again afterwards.
pub fn reach(robot: &mut Robot, command: &Value) -> Result<Value, String> {
    let said = |error: mozzi::Error| error.to_string();
    let frame = text(command, "frame")?;
    let goal = Vec3(three(command, "goal")?);
    let theta = robot.theta().to_vec();
    let model = robot.model();
    let id = model.frame(frame).map_err(said)?;
    let now = model.forward_kinematics(&theta, id).map_err(said)?;
    let goal = SE3 { R: now.R, p: goal };
    let keep = command["keep"] == true;
    let (theta, is_reached) = if model.is_floating() {
        // the same robot on a base at rest, whose frame is the space frame
        let mut still = model.description().clone();
        (still.base, still.constraints, still.states, still.start) = (Base::Fixed, Vec::new(), Vec::new(), None);
        let still: Model = still.build().map_err(said)?;
        let base = SE3::from_pose(std::array::from_fn(|k| theta[k]));
        let id = still.frame(frame).map_err(said)?;
        let (joints, is_reached) = found(&still, id, base.inverse() * goal, keep, &theta[7..])?;
        ([&theta[..7], &joints].concat(), is_reached)
    } else {
        let open = model.without_constraints().map_err(said)?;
        found(&open, id, goal, keep, &theta)?
    };
    closed(robot, &theta, &[])?;
    Ok(json!({ "reached": is_reached }))
}

fn found(model: &Model, frame: FrameId, goal: SE3, keep: bool, guess: &[f64]) -> Result<(Vec<f64>, bool), String> {
    let said = |error: mozzi_motion::Error| error.to_string();
    let goal = if keep { Goal::Pose(goal) } else { Goal::Position(goal.p) };
    let mut theta = guess.to_vec();
    let mut solver = InverseKinematics::with_options(model, frame, OPTIONS()).map_err(said)?;
    let found = solver.search(goal, &Secondary::None, &mut theta).map_err(said)?;
    Ok((theta, found.is_reached))
}
