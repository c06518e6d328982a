//! The robot as text.

use mozzi::{Base, Model};
use mozzi_urdf::{expressible, json, write};
use serde_json::{Value, json};

/// The robot as URDF, and a list of the parts that URDF cannot express.
pub fn urdf(model: &Model) -> Result<Value, String> {
    let mut robot = expressible(&model.described().map_err(|error| error.to_string())?);
    let mut left_out: Vec<String> =
        robot.states.drain(..).map(|state| format!("the named state `{}`", state.name)).collect();
    for constraint in std::mem::take(&mut robot.constraints) {
        left_out.push(format!("the constraint `{}`", constraint.name));
    }
    if robot.motors.take().is_some() {
        left_out.push("the list of motors".into());
    }
    if let Some(frame) = robot.end_effector.take() {
        left_out.push(format!("the end effector `{frame}`"));
    }
    if robot.gravity != [0.0, 0.0, -9.81] {
        robot.gravity = [0.0, 0.0, -9.81];
        left_out.push("gravity".into());
    }
    if robot.base == Base::Floating && robot.free_joint.name.is_empty() {
        left_out.push("the floating base".into());
    }
    let text = write(&robot).map_err(|error| error.to_string())?;
    Ok(json!({ "text": text, "leftOut": left_out }))
}

/// JSON, which expresses every robot.
pub fn json(model: &Model) -> Value {
    json!({ "text": json::write(model) })
}
