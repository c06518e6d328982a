//! A difference between the robots, and how it acts.

use mozzi::model::description::{Joint, JointKind, Rotor};
use mozzi::{Description, SE3, SO3, SpatialInertia, Vec3};

/// A change that makes a number of the first robot the second's.
#[derive(Clone, Debug)]
pub enum Change {
    Gravity([f64; 3]),
    Joint(String, Property),
    /// A joint's other parent, with its place there.
    Parent(String, String, SE3, JointKind),
    /// The names of two joints are exchanged.
    Names([String; 2]),
    /// The second joint, which the first one carries, comes before it.
    Order([String; 2]),
    /// The inertias of these links.
    Inertia(Vec<(String, SpatialInertia)>),
    /// A rotor becomes another, or is removed.
    Rotor(String, Option<Rotor>),
    /// It enters no force here: limits, couplings, names.
    NoForce,
}

#[derive(Clone, Copy, Debug)]
pub enum Property {
    Damping(f64),
    Friction(f64),
    /// Damping, then friction.
    Losses([f64; 2]),
    Armature(f64),
    Stiffness(f64),
    SpringReference(f64),
    Place(SE3, JointKind),
    Position(Vec3),
    Rotation(SO3),
    Kind(JointKind),
}

/// A cause.
#[derive(Clone, Debug)]
pub struct Cause {
    /// "damping", "inertia", "limits" …
    pub kind: &'static str,
    /// The joint or link.
    pub name: String,
    /// The change, with the reason if one is known.
    pub sentence: String,
    pub has_reason: bool,
    pub change: Change,
    /// Effect of the change alone: "gravity torque of `joint6` by up to 0.97 N m".
    pub effect: Option<String>,
    /// The size of the difference apart from its forces: relative lengths and angles of a place, the part of a limit,
    /// infinite of another change without forces, 0 of others.
    pub size: f64,
}

impl Cause {
    pub fn new(kind: &'static str, name: &str, sentence: String, has_reason: bool, change: Change) -> Self {
        let size = if matches!(change, Change::NoForce) { f64::INFINITY } else { 0.0 };
        Cause { kind, name: name.to_string(), sentence, has_reason, change, effect: None, size }
    }
}

impl Change {
    pub fn apply(&self, robot: &mut Description) {
        match self {
            Change::Gravity(gravity) => robot.gravity = *gravity,
            Change::Joint(name, property) => {
                robot.joints.iter_mut().filter(|joint| joint.name == *name).for_each(|joint| property.set(joint));
            }
            Change::Parent(name, parent, origin, kind) => {
                robot.joints.iter_mut().filter(|joint| joint.name == *name).for_each(|joint| {
                    joint.parent.clone_from(parent);
                    (joint.origin, joint.kind) = (*origin, *kind);
                });
            }
            Change::Inertia(links) => {
                for (name, inertia) in links {
                    robot.links.iter_mut().filter(|link| link.name == *name).for_each(|link| link.inertia = *inertia);
                }
            }
            Change::Rotor(name, other) => {
                robot.rotors.retain(|rotor| rotor.name != *name);
                robot.rotors.extend(other.clone().map(|other| Rotor { name: name.clone(), ..other }));
            }
            Change::Names(names) => exchange(robot, names),
            Change::Order(names) => reorder(robot, names),
            Change::NoForce => {}
        }
    }
}

/// Gives each of two joints the other's name.
pub fn exchange(robot: &mut Description, [one, two]: &[String; 2]) {
    rename_joints(robot, |name| match name {
        name if name == one => Some(two.clone()),
        name if name == two => Some(one.clone()),
        _ => None,
    });
}

/// Puts the second joint before the first one, which carries it.
fn reorder(robot: &mut Description, names: &[String; 2]) {
    let place = |name: &String| robot.joints.iter().position(|joint| joint.name == *name);
    let [Some(one), Some(two)] = names.each_ref().map(place) else { return };
    let [mut x, mut y] = [one, two].map(|k| robot.joints[k].clone());
    let T = y.origin;
    (x.kind, y.kind) = (seen_from(x.kind, T.inverse()), seen_from(y.kind, T));
    std::mem::swap(&mut x.parent, &mut y.parent);
    std::mem::swap(&mut x.child, &mut y.child);
    std::mem::swap(&mut x.origin, &mut y.origin);
    (robot.joints[one], robot.joints[two]) = (y, x);
}

/// A joint's motion in the coordinates of a frame in which its own is `T`.
pub fn seen_from(kind: JointKind, T: SE3) -> JointKind {
    match kind {
        JointKind::Screw(A) => JointKind::Screw(A.transformed(T)),
        JointKind::Ball(center) => JointKind::Ball(T * center),
        kind => kind,
    }
}

/// Gives joints other names, also where rotors have them.
pub fn rename_joints(robot: &mut Description, other: impl Fn(&str) -> Option<String>) {
    let of_rotors = robot.rotors.iter_mut().flat_map(|rotor| &mut rotor.gears).map(|gear| &mut gear.joint);
    for name in robot.joints.iter_mut().map(|joint| &mut joint.name).chain(of_rotors) {
        if let Some(other) = other(name) {
            *name = other;
        }
    }
}

impl Property {
    fn set(self, joint: &mut Joint) {
        match self {
            Property::Damping(x) => joint.damping = x,
            Property::Friction(x) => joint.friction = x,
            Property::Losses(both) => [joint.damping, joint.friction] = both,
            Property::Armature(x) => joint.armature = x,
            Property::Stiffness(x) => joint.stiffness = x,
            Property::SpringReference(x) => joint.spring_reference = x,
            Property::Place(origin, kind) => (joint.origin, joint.kind) = (origin, kind),
            Property::Position(p) => joint.origin.p = p,
            Property::Rotation(R) => joint.origin.R = R,
            Property::Kind(kind) => joint.kind = kind,
        }
    }
}
