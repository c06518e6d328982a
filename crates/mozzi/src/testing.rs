//! Random values for tests and benchmarks: robots, states, twists and wrenches, each from a seed.

use crate::lie::SE3;
use crate::linalg::{Sym3, Vec3};
use crate::model::description::{Anchor, Closure, Constraint, Gear, Joint, JointKind, Mimic, Rotor};
use crate::model::{Base, Description, Model};
use crate::scalar::Scalar;
use crate::spatial::solids::Solid;
use crate::spatial::{ScrewAxis, SpatialInertia, Twist, Wrench};
use alloc::format;

pub use crate::random::{Random, state};

/// A twist with entries in [−1, 1).
pub fn twist(seed: u64) -> Twist {
    Twist::from_array(Random(seed).array())
}

/// A wrench with entries in [−1, 1).
pub fn wrench(seed: u64) -> Wrench {
    Wrench::from_array(Random(seed + 1000).array())
}

/// A physical inertia, with its centre of mass off the origin and its principal axes off the frame's.
pub fn inertia(seed: u64) -> SpatialInertia {
    let mut random = Random(seed + 2000);
    let [a, b, c] = random.array().map(|x: f64| 0.1 + x * x);
    let turn = SE3::exp(Twist::from_array(random.array())).R.matrix();
    SpatialInertia::new(
        1.0 + 0.9 * random.next(),
        Vec3(random.array()),
        Sym3::diagonal(b + c, a + c, a + b).congruence(turn),
    )
}

/// The largest difference of two configurations' entries.
pub fn distance(a: SE3, b: SE3) -> f64 {
    let (a, b) = (a.to_matrix(), b.to_matrix());
    a.as_flattened().iter().zip(b.as_flattened()).fold(0.0, |m, (x, y)| m.max((x - y).abs()))
}

/// A random tree of moving links: revolute, prismatic and helical joints, axes and masses off every frame, masses over
/// four decades, fixed links folded in between, friction, armature and springs; `mimics` of the last joints are mimic
/// joints, and two joints turn a rotor.
pub fn tree(seed: u64, links: usize, mimics: usize) -> Model {
    let mut random = Random(seed + 3000);
    let mut robot = Description::new("tree").link("link0", inertia(seed));
    for i in 1..=links {
        let parent = ((random.next() + 1.0) * 0.5 * i as f64) as usize;
        // mostly chains, some branches
        let parent = if random.next() < 0.4 { i - 1 } else { parent.min(i - 1) };
        let mut V = Twist::from_array(random.array());
        match i % 4 {
            0 => V.w = Vec3::zero(),
            1 => {}
            _ => V.v = Vec3(random.array()).cross(V.w),
        }
        let (axis, _) = ScrewAxis::normalize(V).expect("a random screw");
        let origin = SE3::exp(Twist::from_array(random.array()));
        let mut joint = Joint::new(
            format!("joint{i}"),
            format!("link{parent}"),
            format!("link{i}"),
            origin,
            JointKind::Screw(axis),
        );
        if i % 3 == 0 {
            (joint.damping, joint.friction, joint.armature) = (0.3 + random.next() * 0.2, 0.5, 0.1);
        }
        if i % 4 < 2 {
            (joint.stiffness, joint.spring_reference) = (0.7 * i as f64, 0.9 - 0.3 * i as f64);
        }
        if i > links - mimics {
            let joint_followed = format!("joint{}", 1 + (i * 7) % (links - mimics));
            joint.mimic = Some(Mimic { joint: joint_followed, ratio: 1.5 * random.next(), offset: random.next() });
        }
        let scale = libm::pow(10.0, 2.0 * random.next());
        robot = robot.link(format!("link{i}"), inertia(seed + i as u64) * scale).joint(joint);
        if i % 5 == 2 {
            let origin = SE3::exp(Twist::from_array(random.array()));
            let fixed =
                Joint::new(format!("weld{i}"), format!("link{i}"), format!("tool{i}"), origin, JointKind::Fixed);
            robot = robot.link(format!("tool{i}"), inertia(seed + 50 + i as u64)).joint(fixed);
        }
    }
    if mimics > 0 && links >= 5 {
        let gears = [(3, 0.8), (5, -1.7)].map(|(i, ratio)| Gear { joint: format!("joint{i}"), ratio });
        robot.rotors.push(Rotor { name: "differential".into(), armature: 0.4, gears: gears.into() });
    }
    robot = robot.frame("tip", format!("link{links}"), SE3::exp(twist(seed)));
    robot.gravity = [0.3, -1.0, -9.7];
    robot.end_effector = Some("tip".into());
    robot.build().expect("a sound robot")
}

/// A [`tree`] in which some joints are balls or free joints.
pub fn mixed_tree(seed: u64, links: usize, mimics: usize) -> Model {
    let mut robot = tree(seed, links, mimics).description().clone();
    let mut followed: alloc::vec::Vec<_> =
        robot.joints.iter().filter_map(|joint| Some(joint.mimic.as_ref()?.joint.clone())).collect();
    followed.extend(robot.rotors.iter().flat_map(|rotor| &rotor.gears).map(|gear| gear.joint.clone()));
    let of_one_axis = |joint: &&mut Joint| matches!(joint.kind, JointKind::Screw(_)) && joint.mimic.is_none();
    let free = robot.joints.iter_mut().filter(of_one_axis).filter(|joint| !followed.contains(&joint.name));
    for (k, joint) in free.enumerate() {
        match (k as u64 + seed) % 4 {
            0 => {
                joint.kind = JointKind::Ball(Vec3(Random(seed + k as u64).array()));
                (joint.stiffness, joint.spring_reference) = (0.9, 0.0);
            }
            2 if k % 3 == 2 => {
                (joint.kind, joint.friction, joint.armature) = (JointKind::Free, 0.0, 0.3);
                (joint.stiffness, joint.spring_reference) = (0.0, 0.0);
            }
            _ => {}
        }
    }
    robot.build().expect("a sound robot")
}

/// A copy of the robot in which all joints of one axis on the same link mimic the first of them, as a gripper's
/// fingers.
pub fn grippers(of: &Model) -> Model {
    let mut robot = of.description().clone();
    let mut random = Random(40);
    for i in 0..robot.joints.len() {
        let is_same = |a: &Joint, b: &Joint| a.parent == b.parent && matches!(a.kind, JointKind::Screw(_));
        let first = robot.joints[..i].iter().find(|first| is_same(first, &robot.joints[i]));
        if let (Some(first), JointKind::Screw(_)) = (first, robot.joints[i].kind) {
            let joint = first.name.clone();
            robot.joints[i].mimic = Some(Mimic { joint, ratio: 1.5 * random.next(), offset: random.next() });
        }
    }
    robot.build().expect("a sound robot")
}

/// A tree in which each link is the child of the one before, so that it is deep.
pub fn chain(of: &Model) -> Model {
    limbs(of, usize::MAX)
}

/// A tree in which each link is the child of the one before, except that every `length` links a new limb branches off
/// from the middle of the first limb and from the base in turn.
pub fn limbs(of: &Model, length: usize) -> Model {
    let mut robot = of.description().clone();
    for joint in &mut robot.joints {
        if let Some(number) = joint.child.strip_prefix("link").and_then(|number| number.parse::<usize>().ok()) {
            let before = number - 1;
            let parent = match (before / length, before % length) {
                (1.., 0) if (before / length) % 2 == 1 => length / 2,
                (1.., 0) => 0,
                _ => before,
            };
            joint.parent = format!("link{parent}");
        }
    }
    robot.build().expect("a sound robot")
}

/// A [`tree`] on a floating base.
pub fn floating_tree(seed: u64, links: usize, mimics: usize) -> Model {
    tree(seed, links, mimics).with_base(Base::Floating).expect("a sound robot")
}

/// Balls and free joints on a floating base.
pub fn floating_mixed_tree(seed: u64, links: usize, mimics: usize) -> Model {
    mixed_tree(seed, links, mimics).with_base(Base::Floating).expect("a sound robot")
}

pub use crate::model::seed_direction as moving;

/// A planar four-bar linkage in the x-z plane: ground 0.9 m, crank 0.3 m, coupler 0.8 m, rocker 0.6 m, uniform rods of
/// 1 kg a metre. The loop is closed by a hinge, five rows of which three are redundant. θ = 0 is not closed.
pub fn four_bar() -> Model {
    let rod = |length: f64| Solid::Box([length, 0.02, 0.02]).inertia(length);
    let along = |x: f64| SE3::translation([x, 0.0, 0.0]);
    let pivot = |x: f64| JointKind::Screw(ScrewAxis::from_line([0.0, -1.0, 0.0], [x, 0.0, 0.0], 0.0).expect("unit"));
    // a link's frame is in the middle of its rod
    let joint = |name: &str, parent: &str, at: f64, child: &str, half: f64| {
        Joint::new(name, parent, child, along(at + half), pivot(-half))
    };
    let upright = SE3::exp(Twist { w: Vec3([core::f64::consts::FRAC_PI_2, 0.0, 0.0]), v: Vec3::zero() });
    let end = |link: &str, half: f64| Anchor::frame(link).at(along(half) * upright);
    Description::new("four-bar")
        .link("ground", SpatialInertia::zero())
        .link("crank", rod(0.3))
        .link("coupler", rod(0.8))
        .link("rocker", rod(0.6))
        .joint(joint("crank_pivot", "ground", 0.0, "crank", 0.15))
        .joint(joint("coupler_pivot", "crank", 0.15, "coupler", 0.4))
        .joint(joint("rocker_pivot", "ground", 0.9, "rocker", 0.3))
        .constraint(Constraint::hinge("loop", end("coupler", 0.4), end("rocker", 0.3)))
        .build()
        .expect("a sound robot")
}

/// A copy of the robot with constraints that hold at θ, each between random anchors; on a floating base every second
/// one is between a link and {s}.
pub fn closed(model: &Model, theta: &[f64], closures: &[Closure], seed: u64) -> Model {
    let mut random = Random(seed + 5000);
    let bodies: alloc::vec::Vec<usize> = core::iter::once(0).chain(model.moving_slots()).collect();
    let others = bodies.len() - 1;
    let constraint = |(k, &closure): (usize, &Closure)| {
        let mut pick = |below: usize| (((random.next() + 1.0) * 0.5 * below as f64) as usize).min(below - 1);
        let to_world = k % 2 == 1;
        let a = pick(others + 1);
        let b = (a + 1 + pick(others)) % (others + 1); // another one
        let (a, b) = (bodies[a], bodies[b]);
        let name = |slot: usize| {
            let found = model.frames().find(|(id, _)| model.frames[id.0].slot == slot);
            found.map_or_else(|| alloc::string::String::from("link0"), |(_, name)| name.into())
        };
        let pose = |name: &str| {
            let frame = model.frame(name).expect("a link");
            model.forward_kinematics(theta, frame).expect("lengths")
        };
        let mut offset = || SE3::exp(Twist::from_array(random.array()));
        let (from, relative) = (offset(), offset());
        let (from, T_sa) = match to_world && model.is_floating() {
            true => (Anchor::world(from), from),
            false => (Anchor::frame(name(a)).at(from), pose(&name(a)) * from),
        };
        let T_ab = match closure {
            Closure::Weld => SE3::identity(),
            Closure::Point => SE3 { p: Vec3::zero(), ..relative },
            Closure::Hinge => SE3::exp(Twist { w: Vec3([0.0, 0.0, 0.7]), v: Vec3::zero() }),
            Closure::Distance(length) => SE3 { p: relative.p * (length / relative.p.norm()), ..relative },
            Closure::Rolling(radius) => {
                let z = relative.R.matrix().z.0[2]; // n·z of the wheel
                let [x, y, _] = relative.p.0;
                SE3 { p: Vec3([x, y, radius * Scalar::sqrt(1.0 - z * z)]), ..relative }
            }
        };
        let to = Anchor::frame(name(b)).at(pose(&name(b)).inverse() * T_sa * T_ab);
        Constraint::new(format!("constraint{k}"), from, to, closure)
    };
    let constraints: alloc::vec::Vec<_> = closures.iter().enumerate().map(constraint).collect();
    model.with_constraints(constraints).expect("anchors on different links")
}
