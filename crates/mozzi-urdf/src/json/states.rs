//! Named states, by joint.

use super::entry::{At, Read};
use super::value;
use mozzi::model::description::{BaseState, JointState, NamedState};
use serde_json::{Value, json};

pub fn write(state: &NamedState) -> Value {
    let base = |base: &BaseState| json!({ "pose": value::vector(&base.pose), "twist": value::vector(&base.twist) });
    let joint = |joint: &JointState| {
        let (positions, velocities) = (value::vector(&joint.positions), value::vector(&joint.velocities));
        json!({ "name": joint.name, "positions": positions, "velocities": velocities })
    };
    json!({
        "name": state.name, "time": state.time, "base": state.base.as_ref().map(base),
        "joints": state.joints.iter().map(joint).collect::<Value>(),
    })
}

pub fn read(at: &At) -> Read<NamedState> {
    let base = |at: &At| Ok(BaseState { pose: at.get("pose").vector()?, twist: at.get("twist").vector()? });
    let joint = |at: &At| {
        let (positions, velocities) = (at.get("positions").numbers()?, at.get("velocities").numbers()?);
        Ok(JointState { name: at.get("name").text()?, positions, velocities })
    };
    Ok(NamedState {
        name: at.get("name").text()?,
        time: at.get("time").some(At::number)?.unwrap_or(0.0),
        base: at.get("base").some(base)?,
        joints: at.get("joints").list()?.iter().map(joint).collect::<Read<_>>()?,
    })
}
