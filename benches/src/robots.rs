//! The robots: two arms, a body with a head and four limbs, a long chain, and two legged robots.

use mozzi::model::description::{Anchor, Constraint, Joint, JointKind};
use mozzi::random::Random;
use mozzi::{Description, Model, SE3, SO3, ScrewAxis, SpatialInertia, Sym3, Vec3};
use std::path::Path;

/// Legged robots with a floating base, from the folder of robots of PyPI's `example-robot-data`.
///
/// # Errors
/// If one of them cannot be read.
pub fn legged(folder: &Path) -> Result<[(&'static str, Model); 2], String> {
    let read = |file| {
        let path = folder.join(file);
        let name = path.to_str().ok_or_else(|| format!("{}: no text", path.display()))?;
        let mut robot = mozzi_urdf::open(name).map_err(|error| error.to_string())?.description;
        for joint in &mut robot.joints {
            (joint.damping, joint.friction, joint.armature, joint.stiffness) = (0.0, 0.0, 0.0, 0.0);
        }
        robot.floating().build().map_err(|error| error.to_string())
    };
    Ok([
        ("ANYmal, floating base", read("anymal_b_simple_description/robots/anymal.urdf")?),
        ("Talos, floating base", read("talos_data/robots/talos_reduced.urdf")?),
    ])
}

/// ANYmal on its four feet, whose contact points are pinned at their positions in the neutral configuration of the
/// legs.
///
/// # Errors
/// If its feet are missing.
pub fn on_four_feet(anymal: &Model) -> Result<Model, String> {
    let theta: Vec<f64> = anymal.neutral_configuration();
    let mut robot = merged(anymal);
    let whole = anymal.description();
    let moving: Vec<&Joint> = anymal.moving_joints().collect();
    for foot in ["LF_FOOT", "RF_FOOT", "LH_FOOT", "RH_FOOT"] {
        let frame = anymal.frame(foot).map_err(|error| error.to_string())?;
        let pose = anymal.forward_kinematics(&theta, frame).map_err(|error| error.to_string())?;
        let (body, T) = place(whole, &moving, foot);
        let on = Anchor::frame(body.to_string()).at(SE3::translation(T.p.0));
        robot = robot.constraint(Constraint::point(foot, Anchor::world(SE3::translation(pose.p.0)), on));
    }
    robot.build().map_err(|error| error.to_string())
}

/// The Panda arm: 7 joints, the fingers closed and locked.
pub fn panda() -> Model {
    let panda = mozzi_urdf::open("panda").and_then(|robot| robot.build()).expect("an embedded robot");
    panda.with_locked_joints(&[("panda_finger_joint1", 0.0)]).expect("it has fingers")
}

/// The UR5 arm: 6 joints.
pub fn ur5() -> Model {
    mozzi_urdf::open("ur5").and_then(|robot| robot.build()).expect("an embedded robot")
}

/// A tree of 32 revolute joints: a trunk of 2, a head of 2, two arms and two legs of 7. The numbers are random, the
/// axes along x, y and z in turn, as in most robots' files.
pub fn tree() -> Model {
    let limbs = [("pelvis", "trunk", 2), ("trunk2", "head", 2), ("trunk2", "left_arm", 7), ("trunk2", "right_arm", 7)];
    of_limbs("tree", &[&limbs[..], &[("pelvis", "left_leg", 7), ("pelvis", "right_leg", 7)]].concat())
}

/// A chain of 100 revolute joints, its numbers random as the tree's.
pub fn chain() -> Model {
    of_limbs("chain", &[("pelvis", "link", 100)])
}

/// Limbs, each with the link that carries it and the number of its joints.
fn of_limbs(name: &str, limbs: &[(&str, &str, usize)]) -> Model {
    let mut random = Random(32);
    let mut robot = Description::new(name).link("pelvis", body(&mut random));
    for &(carrier, limb, joints) in limbs {
        let mut parent = carrier.to_string();
        for i in 1..=joints {
            let child = format!("{limb}{i}");
            let mut axis = [0.0; 3];
            axis[i % 3] = 1.0;
            let screw = ScrewAxis::new(axis, [0.0; 3]).expect("a unit axis");
            let [roll, pitch, yaw] = random.array();
            let origin = SE3::new(SO3::from_rpy(roll, pitch, yaw), Vec3(random.array()) * 0.3);
            robot = robot.link(&child, body(&mut random)).joint(Joint::new(
                format!("{child}_joint"),
                parent,
                &child,
                origin,
                JointKind::Screw(screw),
            ));
            parent = child;
        }
    }
    robot.build().expect("a sound robot")
}

/// A body of 1 to 3 kg: a ball with a point mass off its centre.
fn body(random: &mut Random) -> SpatialInertia {
    let axis = Vec3(random.array());
    let moment = 0.02 + 0.01 * axis.dot(axis);
    let moments = Sym3::diagonal(moment, moment, moment) - Sym3::outer(axis, 0.01);
    SpatialInertia::new(2.0 + random.next(), Vec3(random.array()) * 0.1, moments)
}

/// The robot in the form given to every library: fixed links are merged into the links that carry them, joint k
/// connects link `k` to the base or to the link of another joint, no friction, no armature, no limits, and standard
/// gravity, which is built into dynibo.
pub fn merged(model: &Model) -> Description {
    let original = model.description();
    let moving: Vec<&Joint> = model.moving_joints().collect();
    let mut inertias = vec![SpatialInertia::zero(); moving.len() + 1];
    for link in &original.links {
        let (k, T) = place(original, &moving, &link.name);
        inertias[k] += link.inertia.transformed(T);
    }
    let mut robot = Description::new(&original.name).with_gravity([0.0, 0.0, -9.80665]);
    robot.base = original.base;
    for (k, inertia) in inertias.into_iter().enumerate() {
        robot = robot.link(k.to_string(), inertia);
    }
    for (k, joint) in moving.iter().enumerate() {
        let (parent, carrier) = place(original, &moving, &joint.parent);
        let beside = matches!(joint.kind, JointKind::Screw(A) if !A.is_prismatic() && A.twist().v != Vec3::zero());
        assert!(!beside && joint.mimic.is_none(), "`{}` is beside its origin, or follows", joint.name);
        let (name, child) = (format!("joint{}", k + 1), (k + 1).to_string());
        robot = robot.joint(Joint::new(name, parent.to_string(), child, carrier * joint.origin, joint.kind));
    }
    robot
}

/// The index of the moving joint that carries a link (0 for the base), and the link's frame relative to it.
fn place(description: &Description, moving: &[&Joint], link: &str) -> (usize, SE3) {
    let (mut T, mut link) = (SE3::identity(), link);
    while let Some(joint) = description.joints.iter().find(|joint| joint.child == link) {
        if let Some(k) = moving.iter().position(|moving| moving.name == joint.name) {
            return (k + 1, T);
        }
        (T, link) = (joint.origin * T, &joint.parent);
    }
    (0, T)
}
