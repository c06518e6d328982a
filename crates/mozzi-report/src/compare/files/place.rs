//! Joints that are elsewhere, or have another axis or type.

use super::cause::{Cause, Change, Property};
use super::inertia::vector;
use super::joints::twin;
use super::number::{shown, ten};
use crate::compare::Result;
use crate::compare::constants::{home, same_body};
use mozzi::model::description::{Joint, JointKind};
use mozzi::{Base, Description, SE3, SO3, SpatialInertia, Twist, Vec3};
use std::collections::BTreeMap;

/// Both robots with their links' poses at home.
pub struct Places<'d> {
    robots: [&'d Description; 2],
    homes: [BTreeMap<String, SE3>; 2],
    /// The links that move with each joint's child, without another joint.
    bodies: [BTreeMap<String, Vec<String>>; 2],
}

fn close(x: f64, y: f64) -> bool {
    (x - y).abs() <= 1e-9 * (1.0 + x.abs())
}

pub fn same_place(x: SE3, y: SE3) -> bool {
    (0..4).all(|i| (0..4).all(|j| close(x.to_matrix()[i][j], y.to_matrix()[i][j])))
}

fn same_screw(x: [f64; 6], y: [f64; 6]) -> bool {
    x.iter().zip(y).all(|(x, y)| close(*x, y))
}

/// The axis or the centre of a joint whose child's frame is at `T`.
fn screw(kind: JointKind, T: SE3) -> [f64; 6] {
    match kind {
        JointKind::Screw(A) => A.transformed(T).twist().to_array(),
        JointKind::Ball(center) => Twist { w: Vec3::zero(), v: T * center }.to_array(),
        _ => [0.0; 6],
    }
}

impl<'d> Places<'d> {
    pub fn of(robots: [&'d Description; 2]) -> Result<Self> {
        let bodies = |robot: &Description| -> Result<BTreeMap<String, Vec<String>>> {
            let model = robot.clone().build()?;
            let own = |links: &[(&str, f64)]| links.iter().map(|(name, _)| name.to_string()).collect::<Vec<_>>();
            Ok(model.folded_links().iter().filter_map(|b| Some((b.joint?.to_string(), own(&b.links)))).collect())
        };
        let [a, b] = robots;
        Ok(Places { robots, homes: [home(a)?, home(b)?], bodies: [bodies(a)?, bodies(b)?] })
    }

    /// Another type, origin or axis of a joint, unless the robots only have other link frames.
    pub fn cause(&self, a: &Joint, b: &Joint, other: &str) -> Option<Cause> {
        let identity = SE3::identity();
        let (origins, axes) =
            (same_place(a.origin, b.origin), same_screw(screw(a.kind, identity), screw(b.kind, identity)));
        let (type_a, type_b) = (a.kind.name(), b.kind.name());
        if self.is_carried_elsewhere(a, b) {
            let [here, there] = [&a.parent, &b.parent];
            let sentence = format!("`{}` is on `{there}` in {other}, on `{here}` here", a.name);
            let change = match self.robots[0].links.iter().any(|link| link.name == *there) {
                true => Change::Parent(a.name.clone(), there.clone(), b.origin, b.kind),
                false => Change::NoForce,
            };
            return Some(Cause { size: 1.0, ..Cause::new("place", &a.name, sentence, true, change) });
        }
        if origins && axes && type_a == type_b {
            return None;
        }
        let [here, there] = [self.homes[0][&a.child], self.homes[1][&b.child]];
        let is_moving = a.kind != JointKind::Fixed;
        let is_there = if is_moving {
            same_screw(screw(a.kind, here), screw(b.kind, there)) && !self.is_shifted(a, b)
        } else {
            same_place(here, there)
        };
        if is_there && type_a == type_b {
            return None; // other link frames, the same motion
        }
        let (sentence, has_reason) = match rounding(a, b) {
            Some(by) => (format!("`{}` is rounded in {other}: its place differs by {by:.0e}", a.name), true),
            None => sentence(a, b, origins, other),
        };
        let change = Change::Joint(a.name.clone(), Property::Place(b.origin, b.kind));
        let kind = if type_a == type_b { "place" } else { "type" };
        Some(Cause { size: size(a, b), ..Cause::new(kind, &a.name, sentence, has_reason, change) })
    }

    /// The bases' poses at home, if joints that begin there have the same origins, and yet are elsewhere.
    pub fn bases(&self) -> Option<[SE3; 2]> {
        let [one, two] = self.robots;
        let of = |joint: &Joint| {
            let there = twin(joint, two)?;
            let is_first = self.carrier(0, &joint.parent).is_none() && self.carrier(1, &there.parent).is_none();
            let poses = [self.homes[0][&joint.parent], self.homes[1][&there.parent]];
            (is_first && same_place(joint.origin, there.origin)).then_some(poses)
        };
        let moves = |joint: &&Joint| joint.kind != JointKind::Fixed;
        let [here, there] = one.joints.iter().filter(moves).find_map(of)?;
        (!same_place(here, there)).then_some([here, there])
    }

    /// A base that stands elsewhere: its turn is that of gravity, seen from the base. A free base that `is_held` stands
    /// nowhere in its file.
    pub fn of_base(&self, other: &str, is_held: bool) -> Option<Cause> {
        let [here, there] = self.bases().filter(|_| self.robots[0].base == Base::Fixed)?;
        let turn = (there.R * here.R.inverse()).log();
        if is_held && turn.norm() <= 1e-9 {
            return None;
        }
        let at = |T: SE3| vector(T.p);
        let turned = match turn.norm() {
            angle if angle > 1e-9 => format!(", and turned by {}°", shown(angle.to_degrees())),
            _ => String::new(),
        };
        let sentence = format!("the base is at {} in {other}, at {} here{turned}", at(there), at(here));
        let gravity = SO3::exp(turn).inverse() * Vec3(self.robots[1].gravity);
        let size = turn.norm().max((there.p - here.p).norm());
        Some(Cause { size, ..Cause::new("place", "", sentence, true, Change::Gravity(gravity.0)) })
    }

    /// The joint that moves a link.
    pub fn carrier(&self, k: usize, link: &str) -> Option<&str> {
        let with = |(_, links): &(&String, &Vec<String>)| links.iter().any(|name| name == link);
        self.bodies[k].iter().find(with).map(|(joint, _)| joint.as_str())
    }

    /// Whether the parents of a joint move with different joints, each of which both robots have.
    fn is_carried_elsewhere(&self, a: &Joint, b: &Joint) -> bool {
        let (Some(here), Some(there)) = (self.carrier(0, &a.parent), self.carrier(1, &b.parent)) else { return false };
        let [one, two] = self.robots;
        let names = || one.joints.iter().filter_map(|joint| Some((&joint.name, &twin(joint, two)?.name)));
        names().any(|(_, name)| name == there) && names().any(|(own, name)| own == here && name != there)
    }

    /// True if the child of a joint of the same axis is elsewhere: along or about a revolute joint's axis, or anywhere
    /// of a prismatic joint's.
    fn is_shifted(&self, a: &Joint, b: &Joint) -> bool {
        let [here, there] = [self.homes[0][&a.child], self.homes[1][&b.child]];
        if same_place(here, there) {
            return false;
        }
        self.is_body_shifted(a, b, here, there, unit(a.origin.p, b.origin.p).is_some())
    }

    /// Whether what a joint carries is elsewhere at home, and is the same in the frames `here` and `there`, or these
    /// have another unit.
    fn is_body_shifted(&self, a: &Joint, b: &Joint, here: SE3, there: SE3, is_unit: bool) -> bool {
        let (x, y) = (self.body(0, a), self.body(1, b));
        let seen = |G: &SpatialInertia, T: SE3| G.transformed(T.inverse());
        let is_massless = x == SpatialInertia::zero() && y == SpatialInertia::zero();
        if !is_massless && same_body(&x, &y) {
            return false;
        }
        if !is_massless && (is_unit || same_body(&seen(&x, here), &seen(&y, there))) {
            return true;
        }
        // massless, or of another inertia: the next joints and what they carry
        let no_links = Vec::new();
        let links = self.bodies[0].get(&a.name).unwrap_or(&no_links);
        let next = self.robots[0].joints.iter().filter(|joint| links.contains(&joint.parent));
        next.filter(|joint| joint.kind != JointKind::Fixed).any(|joint| {
            let Some(twin) = twin(joint, self.robots[1]) else { return false };
            let [p, q] = [self.homes[0][&joint.child], self.homes[1][&twin.child]];
            let [u, v] = [here.inverse() * p, there.inverse() * q];
            let is_same = is_unit || same_place(u, v) && same_screw(screw(joint.kind, u), screw(twin.kind, v));
            let is_elsewhere = || !same_screw(screw(joint.kind, p), screw(twin.kind, q));
            is_same && (is_elsewhere() || self.is_body_shifted(joint, twin, here, there, is_unit))
        })
    }

    /// The inertia of a joint's body at home.
    fn body(&self, k: usize, joint: &Joint) -> SpatialInertia {
        let no_links = Vec::new();
        let links = self.bodies[k].get(&joint.name).unwrap_or(&no_links);
        let own = self.robots[k].links.iter().filter(|link| links.contains(&link.name));
        own.fold(SpatialInertia::zero(), |sum, link| sum + link.inertia.transformed(self.homes[k][&link.name]))
    }
}

/// Lengths, as a part of 1 m or of the larger distance, and angles by which a joint differs.
fn size(a: &Joint, b: &Joint) -> f64 {
    let [x, y] = [a, b].map(|joint| screw(joint.kind, SE3::identity()));
    let axes = x.iter().zip(y).map(|(x, y)| (x - y).abs() / (1.0 + x.abs()));
    axes.fold(distance(a.origin, b.origin), f64::max)
}

/// Whether places whose numbers have six digits differ by as little as this.
pub fn rounded(by: f64) -> bool {
    by > 0.0 && by <= 2e-5
}

/// By how much a joint's numbers of six digits differ from those before.
fn rounding(a: &Joint, b: &Joint) -> Option<f64> {
    let by = size(a, b);
    (rounded(by) && a.kind.name() == b.kind.name()).then_some(by)
}

/// How far apart two places are, as [`Cause::size`].
pub fn distance(p: SE3, q: SE3) -> f64 {
    ((p.p - q.p).norm() / (1.0 + p.p.norm())).max((p.R.inverse() * q.R).log().norm())
}

/// "by 0.8 m and turned by 30°".
pub fn away(a: SE3, b: SE3) -> String {
    let (far, turn) = ((a.p - b.p).norm(), (a.R.inverse() * b.R).log().norm());
    let words = [(far, format!("by {} m", shown(far))), (turn, format!("turned by {}°", shown(turn.to_degrees())))];
    let words: Vec<String> = words.into_iter().filter(|(x, _)| *x > 1e-9).map(|(_, words)| words).collect();
    words.join(" and ")
}

/// The difference of a joint in words, and whether it has a reason; `origins` is true if its origin is the same.
fn sentence(a: &Joint, b: &Joint, origins: bool, other: &str) -> (String, bool) {
    let (name, type_a, type_b) = (&a.name, a.kind.name(), b.kind.name());
    if a.parent != b.parent || a.child != b.child {
        let [here, there] = [a, b].map(|joint| format!("`{}` and `{}`", joint.parent, joint.child));
        return (format!("`{name}` joins {there} in {other}, {here} here"), false);
    }
    if type_a != type_b {
        return (format!("`{name}` is {type_b} in {other}, {type_a} here"), true);
    }
    let why = if origins { of_axis(a, b) } else { of_origin(a.origin, b.origin) };
    match why {
        Some(why) => (format!("`{name}` {why} in {other}"), true),
        None if origins => (format!("`{name}` has another axis in {other}"), false),
        None if a.origin.R == b.origin.R => {
            let [here, there] = [a, b].map(|joint| vector(joint.origin.p));
            (format!("`{name}` is elsewhere in {other}: {there} instead of {here}"), false)
        }
        None => (format!("`{name}` is elsewhere in {other}, {}", away(a.origin, b.origin)), false),
    }
}

fn of_axis(a: &Joint, b: &Joint) -> Option<String> {
    if !matches!(a.kind, JointKind::Screw(_)) {
        return None;
    }
    let turned = |joint: &Joint, R: SO3| screw(joint.kind, SE3::new(R, Vec3::zero()));
    let (R, axis) = (a.origin.R, turned(b, SO3::identity()));
    if same_screw(turned(a, SO3::identity()).map(|x| -x), axis) {
        return Some("has the reversed axis".to_string());
    }
    if same_screw(turned(a, R), axis) {
        return Some("has its axis in the parent's frame, not in the joint's,".to_string());
    }
    let is_back = same_screw(turned(a, R.inverse()), axis);
    is_back.then(|| "has its axis turned back by its origin, as if it were given in the parent's frame,".to_string())
}

/// The error that makes one origin the other.
pub fn of_origin(a: SE3, b: SE3) -> Option<String> {
    if (a.R.inverse() * b.R).log().norm() <= 1e-9 {
        let has_none = b.p == Vec3::zero() && a.p != Vec3::zero();
        return unit(a.p, b.p).or_else(|| has_none.then(|| "has no origin".to_string()));
    }
    let is_there = (a.p - b.p).norm() <= 1e-9 * (1.0 + a.p.norm());
    if is_there { of_rotation(a.R, b.R) } else { None }
}

/// Two origins of the same direction in other units.
fn unit(a: Vec3, b: Vec3) -> Option<String> {
    let power = ten(b.norm() / a.norm())?;
    let is_along = (a * (1.0 / a.norm()) - b * (1.0 / b.norm())).norm() <= 1e-9;
    is_along.then(|| match power {
        3 => "has its origin in mm".to_string(),
        power => format!("has its origin off by a factor 1e{power}, a unit"),
    })
}

fn of_rotation(a: SO3, b: SO3) -> Option<String> {
    let is_b = |R: SO3| (R.inverse() * b).log().norm() < 1e-6;
    let [x, y] = [a, b].map(SO3::to_rpy);
    let rpy = |[r, p, y]: [f64; 3]| SO3::from_rpy(r, p, y);
    // Rot(x, roll) Rot(y, pitch) Rot(z, yaw)
    let other_order = |[r, p, y]: [f64; 3]| rpy([r, 0.0, 0.0]) * rpy([0.0, p, 0.0]) * rpy([0.0, 0.0, y]);
    let of_quaternion = |order: [usize; 4]| {
        let (w, v) = a.quaternion();
        let all = [w, v.0[0], v.0[1], v.0[2]];
        let [w, x, y, z] = order.map(|k| all[k]);
        SO3::from_quaternion(w, Vec3([x, y, z]))
    };
    let why = if is_b(a.inverse()) {
        "is rotated by the inverse"
    } else if is_b(SO3::identity()) {
        "is not rotated"
    } else if is_b(rpy(x.map(f64::to_degrees))) {
        "has its angles in degrees"
    } else if (a.inverse() * rpy(y.map(f64::to_degrees))).log().norm() < 1e-6 {
        "has its angles in radians, read as degrees"
    } else if is_b(other_order(x)) || (a.inverse() * other_order(y)).log().norm() < 1e-6 {
        "has its roll, pitch and yaw in the other order"
    } else if is_b(of_quaternion([1, 2, 3, 0])) {
        "has its quaternion in the order x y z w"
    } else if is_b(of_quaternion([3, 0, 1, 2])) {
        "has its quaternion read in the order x y z w"
    } else {
        return None;
    };
    Some(why.to_string())
}
