//! Converts a robot's description to plain tuples, which Python can pickle, and back.

use mozzi::model::Base;
use mozzi::model::description::{
    self, BaseState, Description, FreeJoint, Gear, Joint, JointKind, Limits, Link, Mimic, NamedFrame, NamedState, Rotor,
};
use mozzi::{SE3, ScrewAxis, SpatialInertia, Vec3};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

type Pose = [[f64; 4]; 4];
type LinkState = (String, [f64; 10]);
type LimitState = (Option<[f64; 2]>, Option<f64>, Option<f64>, Option<f64>);
type MimicState = Option<(String, f64, f64)>;
/// A joint's kind, and its numbers: a screw axis, a ball's centre.
type KindState = (String, Vec<f64>);
type JointState = (String, String, String, Pose, KindState, LimitState, [f64; 5], MimicState);
type FrameState = (String, String, Pose);
type RotorState = (String, f64, Vec<(String, f64)>);

type Numbers = (Vec<f64>, Vec<f64>);
/// Name and time, the base's pose and twist, each joint's positions and velocities.
type StateState = ((String, f64), Option<([f64; 7], [f64; 6])>, Vec<(String, Numbers)>);

/// All data of a [`Description`]; its constraints and motors come last, as JSON.
pub type State = (
    String,
    Vec<LinkState>,
    Vec<JointState>,
    Vec<FrameState>,
    Option<String>,
    [f64; 3],
    Option<(String, String)>,
    Vec<RotorState>,
    (Vec<StateState>, Option<String>),
    Option<String>,
);

const FIXED: &str = "fixed";
const SCREW: &str = "screw";
const BALL: &str = "ball";
const FREE: &str = "free";

pub fn to_state(robot: &Description) -> State {
    let link = |link: &Link| (link.name.clone(), link.inertia.to_parameters());
    let joint = |joint: &Joint| {
        let (kind, numbers) = match joint.kind {
            JointKind::Fixed => (FIXED, Vec::new()),
            JointKind::Screw(axis) => (SCREW, axis.twist().to_array().to_vec()),
            JointKind::Ball(center) => (BALL, center.0.to_vec()),
            JointKind::Free => (FREE, Vec::new()),
        };
        let Limits { position, velocity, effort, acceleration } = joint.limits;
        let mimic = joint.mimic.as_ref().map(|mimic| (mimic.joint.clone(), mimic.ratio, mimic.offset));
        (
            joint.name.clone(),
            joint.parent.clone(),
            joint.child.clone(),
            joint.origin.to_matrix(),
            (kind.to_string(), numbers),
            (position, velocity, effort, acceleration),
            [joint.damping, joint.friction, joint.armature, joint.stiffness, joint.spring_reference],
            mimic,
        )
    };
    let frame = |frame: &NamedFrame| (frame.name.clone(), frame.link.clone(), frame.T.to_matrix());
    let rotor = |rotor: &Rotor| {
        let gears = rotor.gears.iter().map(|gear| (gear.joint.clone(), gear.ratio));
        (rotor.name.clone(), rotor.armature, gears.collect())
    };
    let state = |state: &NamedState| {
        let joint =
            |joint: &description::JointState| (joint.name.clone(), (joint.positions.clone(), joint.velocities.clone()));
        let base = state.base.map(|base| (base.pose, base.twist));
        ((state.name.clone(), state.time), base, state.joints.iter().map(joint).collect())
    };
    let free = (robot.base == Base::Floating).then(|| (robot.free_joint.name.clone(), robot.free_joint.parent.clone()));
    (
        robot.name.clone(),
        robot.links.iter().map(link).collect(),
        robot.joints.iter().map(joint).collect(),
        robot.frames.iter().map(frame).collect(),
        robot.end_effector.clone(),
        robot.gravity,
        free,
        robot.rotors.iter().map(rotor).collect(),
        (robot.states.iter().map(state).collect(), robot.start.clone()),
        (!robot.constraints.is_empty() || robot.motors.is_some()).then(|| mozzi_urdf::constraints::write(robot)),
    )
}

/// # Errors
/// `ValueError` for invalid configurations and screw axes.
pub fn from_state(
    (name, links, joints, frames, end_effector, gravity, free, rotors, (states, start), closing): State,
) -> PyResult<Description> {
    let mut robot = Description::new(name).with_gravity(gravity);
    for (name, parameters) in links {
        robot = robot.link(name, SpatialInertia::from_parameters(parameters));
    }
    for (name, parent, child, origin, (kind, axis), (position, velocity, effort, acceleration), numbers, mimic) in
        joints
    {
        let kind = match (kind.as_str(), axis.as_slice()) {
            (FIXED, []) => JointKind::Fixed,
            (SCREW, &[a, b, c, x, y, z]) => {
                JointKind::Screw(ScrewAxis::from_array([a, b, c, x, y, z]).map_err(refused)?)
            }
            (BALL, &[x, y, z]) => JointKind::Ball(Vec3([x, y, z])),
            (FREE, []) => JointKind::Free,
            (kind, axis) => {
                return Err(refused(format!("joint `{name}`: {kind} with {axis:?}, expected a kind of joint")));
            }
        };
        let mut joint = Joint::new(name, parent, child, pose(origin)?, kind);
        joint.limits = Limits { position, velocity, effort, acceleration };
        [joint.damping, joint.friction, joint.armature, joint.stiffness, joint.spring_reference] = numbers;
        joint.mimic = mimic.map(|(joint, ratio, offset)| Mimic { joint, ratio, offset });
        robot = robot.joint(joint);
    }
    for (name, armature, gears) in rotors {
        let gears = gears.into_iter().map(|(joint, ratio)| Gear { joint, ratio }).collect();
        robot.rotors.push(Rotor { name, armature, gears });
    }
    for (name, link, T) in frames {
        robot = robot.frame(name, link, pose(T)?);
    }
    robot.end_effector = end_effector;
    if let Some((name, parent)) = free {
        robot = robot.floating();
        robot.free_joint = FreeJoint { name, parent };
    }
    let joint = |(name, (positions, velocities))| description::JointState { name, positions, velocities };
    let state = |((name, time), base, joints): StateState| NamedState {
        name,
        time,
        base: base.map(|(pose, twist)| BaseState { pose, twist }),
        joints: joints.into_iter().map(joint).collect(),
    };
    robot.states = states.into_iter().map(state).collect();
    robot.start = start;
    match closing {
        Some(text) => mozzi_urdf::constraints::parse("constraints", &text, robot).map_err(refused),
        None => Ok(robot),
    }
}

/// A configuration, whose rotation may have rounded numbers.
///
/// # Errors
/// `ValueError` for an invalid configuration.
pub fn pose(T: Pose) -> PyResult<SE3> {
    SE3::from_rounded_matrix(T).map_err(refused)
}

pub fn refused(error: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}
