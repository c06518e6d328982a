//! Joints that are elsewhere, or have another axis or type.

use super::cause::{Cause, Change, Property, seen_from};
use super::inertia::vector;
use super::matching::twin;
use super::number::{decimals, length, shown};
use super::places::{Places, apart, distance, same_place, same_screw, screw, unit};
use super::rotation;
use mozzi::model::description::{Joint, JointKind};
use mozzi::{Base, SE3, SO3, ScrewAxis, Vec3};

/// A joint as the first robot would have it with the second one's place and axis.
struct There {
    origin: SE3,
    kind: JointKind,
}

impl Places<'_> {
    /// The second robot's joint in the first one's link frames, on a link of the first one.
    fn there(&self, a: &Joint, b: &Joint, parent: &str) -> There {
        let [carried, shift] = [parent, &a.child].map(|link| self.shift(link));
        let [link, child] = [parent, &a.child].map(|link| self.homes[0][link]);
        let (origin, into) = ((carried * link).inverse() * shift * child, (shift * child).inverse());
        let frame = into * self.homes[1][&b.child];
        let kind = match b.kind {
            kind if same_place(frame, SE3::identity()) => kind,
            kind => seen_from(kind, frame),
        };
        let own = |known: SE3| same_place(origin, known).then_some(known);
        There { origin: own(a.origin).or_else(|| own(b.origin)).unwrap_or(origin), kind }
    }

    /// The second robot's frame of a link on a fixed joint; those of others may be anywhere on their bodies.
    fn frame(&self, link: &str) -> SE3 {
        let is_fixed = |joint: &&Joint| joint.child == link && joint.kind == JointKind::Fixed;
        let fixed = self.robots[0].joints.iter().find(is_fixed);
        fixed.and_then(|joint| self.seen(&joint.child)).unwrap_or(self.homes[0][link])
    }

    /// Another parent of a joint, on another body.
    pub fn of_parent(&self, a: &Joint, b: &Joint, other: &str) -> Option<Cause> {
        if !self.is_carried_elsewhere(a, b) {
            return None;
        }
        let [here, there] = [&a.parent, &b.parent];
        let sentence = format!("`{}` is on `{there}` in {other}, on `{here}` here", a.name);
        let change = match self.robots[0].links.iter().any(|link| link.name == *there) {
            true => {
                let place = self.there(a, b, there);
                Change::Parent(a.name.clone(), there.clone(), place.origin, place.kind)
            }
            false => Change::NoForce,
        };
        Some(Cause { size: 1.0, ..Cause::new("place", &a.name, sentence, true, change) })
    }

    /// Another type, origin or axis of a joint, each a cause, unless the robots only have other link frames.
    pub fn causes(&self, a: &Joint, b: &Joint, other: &str) -> Vec<Cause> {
        let mut there = self.there(a, b, &a.parent);
        let [x, y] = [a.kind, there.kind].map(|kind| screw(kind, SE3::identity()));
        let (type_a, type_b) = (a.kind.name(), b.kind.name());
        let has_axis = same_screw(x, y) && type_a == type_b;
        // a frame on a fixed joint may be elsewhere while the mass, and what it carries, are not
        let is_frame = has_axis && a.kind == JointKind::Fixed && same_place(a.origin, there.origin);
        if is_frame && let Some(child) = self.seen(&a.child) {
            there.origin = self.frame(&a.parent).inverse() * child;
        }
        let [p, q] = [a.origin, there.origin];
        if has_axis && same_place(p, q) {
            return Vec::new();
        }
        let size = distance(p, q).max(apart(x, y));
        let new = |kind, size: f64, words: String, has_reason, property| {
            let sentence = format!("`{}` {words}", a.name);
            let change = if is_frame { Change::NoForce } else { Change::Joint(a.name.clone(), property) };
            Cause { size, ..Cause::new(kind, &a.name, sentence, has_reason, change) }
        };
        if rounded(size) && type_a == type_b {
            let words = format!("is rounded in {other}: its place differs by {size:.0e}");
            return vec![new("place", size, words, true, Property::Place(q, there.kind))];
        }
        if is_frame {
            let why = of_origin(p, q).unwrap_or_else(|| format!("is elsewhere, {},", away(p, q)));
            let words = format!("{why} in {other}, with the same mass");
            return vec![new("place", size, words, of_origin(p, q).is_some(), Property::Place(q, there.kind))];
        }
        let mut causes = Vec::new();
        if type_a != type_b {
            let words = format!("is {type_b} in {other}, {type_a} here");
            causes.push(new("type", 1.0, words, true, Property::Kind(there.kind)));
        } else if !has_axis {
            let (words, has_reason) = axis(a, there.kind, other);
            causes.push(new("place", apart(x, y), words, has_reason, Property::Kind(there.kind)));
        }
        let at = |p: Vec3| SE3::new(SO3::identity(), p);
        if !same_place(at(p.p), at(q.p)) {
            let elsewhere = || format!("is elsewhere in {other}: {} instead of {}", vector(q.p), vector(p.p));
            let why = of_position(p.p, q.p).map(|why| format!("{why} in {other}"));
            let (has_reason, words) = (why.is_some(), why.unwrap_or_else(elsewhere));
            causes.push(new("place", distance(at(p.p), at(q.p)), words, has_reason, Property::Position(q.p)));
        }
        let turn = (p.R.inverse() * q.R).log().norm();
        if turn > 1e-9 {
            let why = rotation::reason(p.R, q.R).map(|why| format!("{why} in {other}"));
            let own = (p.R.inverse() * q.R).log() * (1.0 / turn);
            let is_own = matches!(a.kind, JointKind::Screw(A) if (A.twist().w.dot(own).abs() - 1.0).abs() < 1e-9);
            let about = if is_own { " about its axis: another zero" } else { "" };
            let turned = || format!("is elsewhere in {other}, turned by {}°{about}", shown(turn.to_degrees()));
            let (has_reason, words) = (why.is_some(), why.unwrap_or_else(turned));
            causes.push(new("place", turn, words, has_reason, Property::Rotation(q.R)));
        }
        causes
    }

    /// Two joints at one place, of which the second robot has the other first.
    pub fn of_order(&self, one: &Joint, two: &Joint, other: &str) -> Option<Cause> {
        let [first, second] = [twin(one, self.robots[1])?, twin(two, self.robots[1])?];
        let is_only = |joint: &&Joint| joint.parent == one.child && joint.name != two.name;
        let is_alone = !self.robots[0].joints.iter().any(|joint| is_only(&joint));
        let is_other = two.parent == one.child && first.parent == second.child && two.kind != JointKind::Fixed;
        let sentence = || format!("{other} has `{}` and `{}` in the other order", one.name, two.name);
        let change = || Change::Order([one.name.clone(), two.name.clone()]);
        (is_other && is_alone)
            .then(|| Cause { size: 1.0, ..Cause::new("place", &one.name, sentence(), true, change()) })
    }

    /// A base that stands elsewhere: its turn is that of gravity, seen from the base. A free base that `is_held` stands
    /// nowhere in its file.
    pub fn of_base(&self, other: &str, is_held: bool) -> Option<Cause> {
        let [one, two] = self.robots;
        let moves = |joint: &&Joint| joint.kind != JointKind::Fixed && self.carrier(0, &joint.parent).is_none();
        let first = one.joints.iter().find(moves).filter(|_| one.base == Base::Fixed)?;
        let here = self.homes[0][&first.parent];
        let shift = self.shift("");
        let there = shift * here;
        let turn = shift.R.log();
        if same_place(shift, SE3::identity()) || is_held && turn.norm() <= 1e-9 {
            return None;
        }
        let at = |T: SE3| vector(T.p);
        let turned = match turn.norm() {
            angle if angle > 1e-9 => format!(", and turned by {}°", shown(angle.to_degrees())),
            _ => String::new(),
        };
        let sentence = format!("the base is at {} in {other}, at {} here{turned}", at(there), at(here));
        let gravity = shift.R.inverse() * Vec3(two.gravity);
        let size = turn.norm().max((there.p - here.p).norm());
        Some(Cause { size, ..Cause::new("place", "", sentence, true, Change::Gravity(gravity.0)) })
    }

    /// Whether the parents of a joint are other links, which move with other joints that both robots have.
    fn is_carried_elsewhere(&self, a: &Joint, b: &Joint) -> bool {
        let (Some(here), Some(there)) = (self.carrier(0, &a.parent), self.carrier(1, &b.parent)) else { return false };
        let [one, two] = self.robots;
        let names = || one.joints.iter().filter_map(|joint| Some((&joint.name, &twin(joint, two)?.name)));
        a.parent != b.parent
            && names().any(|(_, name)| name == there)
            && names().any(|(own, name)| own == here && name != there)
    }
}

/// Whether places whose numbers have six digits differ by as little as this.
pub fn rounded(by: f64) -> bool {
    by > 0.0 && by <= 2e-5
}

/// "by 0.8 m and turned by 30°".
pub fn away(a: SE3, b: SE3) -> String {
    let (far, turn) = ((a.p - b.p).norm(), (a.R.inverse() * b.R).log().norm());
    let words = [(far, format!("by {} m", shown(far))), (turn, format!("turned by {}°", shown(turn.to_degrees())))];
    let words: Vec<String> = words.into_iter().filter(|(x, _)| *x > 1e-9).map(|(_, words)| words).collect();
    words.join(" and ")
}

/// Another axis in words, and whether it has a reason.
fn axis(a: &Joint, there: JointKind, other: &str) -> (String, bool) {
    if let Some(why) = of_axis(a, there) {
        return (format!("{why} in {other}"), true);
    }
    let (JointKind::Screw(A), JointKind::Screw(B)) = (a.kind, there) else {
        return (format!("has another centre in {other}"), false);
    };
    let direction = |A: ScrewAxis| if A.is_prismatic() { A.twist().v } else { A.twist().w };
    let [x, y] = [direction(A), direction(B)];
    let angle = x.dot(y).clamp(-1.0, 1.0).acos();
    if angle > 1e-7 {
        let words = format!("has another axis in {other}: {} instead of {}", vector(y), vector(x));
        return (format!("{words}, turned by {}°", shown(angle.to_degrees())), false);
    }
    let far = (A.twist().v - B.twist().v).norm();
    (format!("has its axis elsewhere in {other}, by {} m", shown(far)), false)
}

fn of_axis(a: &Joint, there: JointKind) -> Option<String> {
    let JointKind::Screw(own) = a.kind else { return None };
    let turned = |R: SO3| screw(a.kind, SE3::new(R, Vec3::zero()));
    let (R, axis) = (a.origin.R, screw(there, SE3::identity()));
    if same_screw(turned(SO3::identity()).map(|x| -x), axis) {
        return Some("has the reversed axis".to_string());
    }
    if same_screw(turned(R), axis) {
        return Some("has its axis in the parent's frame, not in the joint's,".to_string());
    }
    let x = [1.0, 0.0, 0.0];
    let default = if own.is_prismatic() { ScrewAxis::prismatic(x) } else { ScrewAxis::from_line(x, [0.0; 3], 0.0) };
    if default.is_ok_and(|default| same_screw(default.twist().to_array(), axis)) {
        return Some("has the default axis (1, 0, 0)".to_string());
    }
    let is_back = same_screw(turned(R.inverse()), axis);
    is_back.then(|| "has its axis turned back by its origin, as if it were given in the parent's frame,".to_string())
}

/// The error that makes one origin the other.
pub fn of_origin(a: SE3, b: SE3) -> Option<String> {
    if (a.R.inverse() * b.R).log().norm() <= 1e-9 {
        return of_position(a.p, b.p);
    }
    let is_there = (a.p - b.p).norm() <= 1e-9 * (1.0 + a.p.norm());
    if is_there { rotation::reason(a.R, b.R) } else { None }
}

fn of_position(a: Vec3, b: Vec3) -> Option<String> {
    if let Some(unit) = unit(a, b).and_then(length) {
        return Some(format!("has its origin {unit}"));
    }
    if b.norm() <= 1e-12 && a != Vec3::zero() {
        return Some("has no origin".to_string());
    }
    decimals(&a.0, &b.0).map(|count| format!("is rounded to {count} decimals"))
}
