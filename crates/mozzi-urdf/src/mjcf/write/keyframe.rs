//! `<keyframe>`: the named states, in MuJoCo's coordinates.

use super::{Plan, numbers, start, travel};
use crate::mjcf::keyframe::QPOS0;
use crate::urdf::write::escaped;
use mozzi::model::description::{Joint, JointKind, NamedState};
use mozzi::{Base, Description, SE3};
use std::fmt::{self, Write};

/// The keys of all states but the one that the bodies' poses express.
pub(super) fn keyframe(text: &mut String, plan: &Plan) -> fmt::Result {
    let d = plan.d;
    let mut joints = Vec::new();
    if let Some(base) = plan.base {
        depth_first(plan, &base.name, &mut joints);
    }
    let mut lines = String::new();
    for state in d.states.iter().filter(|state| !is_drawn(d, state)) {
        let [qpos, qvel] = coordinates(d, &joints, state);
        write!(lines, "    <key name=\"{}\"", escaped(&state.name))?;
        if state.time != 0.0 {
            write!(lines, " time=\"{:?}\"", state.time)?;
        }
        write!(lines, " qpos=\"{}\"", numbers(&qpos))?;
        if qvel.iter().any(|x| *x != 0.0) {
            write!(lines, " qvel=\"{}\"", numbers(&qvel))?;
        }
        lines.push_str("/>\n");
    }
    if lines.is_empty() { Ok(()) } else { write!(text, "  <keyframe>\n{lines}  </keyframe>\n") }
}

/// The choice of a start that the bodies' poses do not express.
pub(super) fn loss(d: &Description) -> Option<String> {
    let start = start(d)?;
    (!is_drawn(d, start)).then(|| format!("the choice of the state in which the robot starts, `{}`", start.name))
}

/// True if this is the start, at rest, with only free bodies away from their zeros.
fn is_drawn(d: &Description, state: &NamedState) -> bool {
    let is_start = state.name == QPOS0 && d.start.as_deref() == Some(QPOS0) && state.time == 0.0;
    let is_at_rest = state.base.is_none_or(|base| base.twist == [0.0; 6])
        && state.joints.iter().all(|joint| joint.velocities.iter().all(|x| *x == 0.0));
    let is_zero = |positions: &[f64]| match *positions {
        [x] => x == 0.0,
        [w, x, y, z] => [w, x, y, z] == [1.0, 0.0, 0.0, 0.0],
        _ => true,
    };
    is_start && is_at_rest && state.joints.iter().all(|joint| is_zero(&joint.positions))
}

/// The joints that move, in the order in which they are written.
fn depth_first<'d>(plan: &Plan<'d>, link: &str, joints: &mut Vec<&'d Joint>) {
    for joint in plan.below.get(link).into_iter().flatten() {
        if joint.kind != JointKind::Fixed {
            joints.push(joint);
        }
        depth_first(plan, &joint.child, joints);
    }
}

/// qpos and qvel.
fn coordinates(d: &Description, joints: &[&Joint], state: &NamedState) -> [Vec<f64>; 2] {
    let [mut qpos, mut qvel] = [Vec::new(), Vec::new()];
    let free = |pose: [f64; 7], [w_x, w_y, w_z, v_x, v_y, v_z]: [f64; 6]| {
        let [w, x, y, z, p @ ..] = pose;
        let v = SE3::from_pose(pose).R * mozzi::Vec3([v_x, v_y, v_z]); // MuJoCo's is in the world's axes
        ([p.as_slice(), &[w, x, y, z]].concat(), [v.0.as_slice(), &[w_x, w_y, w_z]].concat())
    };
    const AT_ZERO: [f64; 7] = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    if d.base == Base::Floating {
        let (q, v) = state.base.map_or_else(|| free(AT_ZERO, [0.0; 6]), |base| free(base.pose, base.twist));
        qpos.extend(q);
        qvel.extend(v);
    }
    for joint in joints {
        let found = state.joints.iter().find(|one| one.name == joint.name);
        let (q, v) = match joint.kind {
            JointKind::Free => match found.map(|one| (one.positions.as_slice(), one.velocities.as_slice())) {
                Some((positions, velocities)) => {
                    free(positions.try_into().unwrap_or(AT_ZERO), velocities.try_into().unwrap_or_default())
                }
                None => free(AT_ZERO, [0.0; 6]),
            },
            JointKind::Ball(_) => found.map_or_else(
                || (AT_ZERO[..4].to_vec(), vec![0.0; 3]),
                |one| (one.positions.clone(), one.velocities.clone()),
            ),
            _ => {
                let (q, v) = of_one_axis(d, joint, state);
                match travel(joint.kind) {
                    Some(A) => (vec![q, A.pitch() * q], vec![v, A.pitch() * v]),
                    None => (vec![q], vec![v]),
                }
            }
        };
        qpos.extend(q);
        qvel.extend(v);
    }
    [qpos, qvel]
}

/// The position and the rate of a joint of one axis; a mimic joint's follow from its source joint's.
fn of_one_axis(d: &Description, joint: &Joint, state: &NamedState) -> (f64, f64) {
    if let Some(mimic) = &joint.mimic {
        let source = d.joints.iter().find(|one| one.name == mimic.joint);
        let (q, v) = source.map_or((0.0, 0.0), |source| of_one_axis(d, source, state));
        return (mimic.ratio * q + mimic.offset, mimic.ratio * v);
    }
    let found = state.joints.iter().find(|one| one.name == joint.name);
    let first = |list: &[f64]| list.first().copied().unwrap_or(0.0);
    found.map_or((0.0, 0.0), |one| (first(&one.positions), first(&one.velocities)))
}
