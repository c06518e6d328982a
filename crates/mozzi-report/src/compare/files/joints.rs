//! Differences in the numbers of joints.

use super::RobotFile;
use super::cause::{Cause, Change, Property};
use super::matching::twin;
use super::number::{Angle, instead, reason, same, shown, ten};
use super::places::Places;
use crate::compare::vocabulary;
use mozzi::Description;
use mozzi::model::description::{Joint, JointKind};

/// Joints in another order, or else on another body.
pub fn tree(places: &Places, other: &str) -> Vec<Cause> {
    let [a, b] = places.robots;
    let pairs = a.joints.iter().flat_map(|one| a.joints.iter().map(move |two| (one, two)));
    let orders: Vec<Cause> = pairs.filter_map(|(one, two)| places.of_order(one, two, other)).collect();
    let parents = || a.joints.iter().filter_map(|joint| places.of_parent(joint, twin(joint, b)?, other)).collect();
    if orders.is_empty() { parents() } else { orders }
}

/// Gravity, friction, springs, armature and places, which enter the forces; `is_held` if one of the bases is free.
pub fn causes(places: &Places, other: &str, is_held: bool) -> Vec<Cause> {
    let [a, b] = places.robots;
    let mut causes = Vec::new();
    if a.gravity.iter().zip(b.gravity).any(|(x, y)| !same(*x, y)) {
        let sentence = format!("gravity is {:?} in {other}, {:?} here", b.gravity, a.gravity);
        causes.push(Cause::new("gravity", "", sentence, true, Change::Gravity(b.gravity)));
    }
    for joint in &a.joints {
        let Some(there) = twin(joint, b) else { continue };
        let moves = joint.kind != JointKind::Fixed;
        type Make = fn(f64) -> Property;
        let numbers: [(&str, f64, f64, Make, Angle); 5] = [
            ("damping", joint.damping, there.damping, Property::Damping, Angle::Per),
            ("friction", joint.friction, there.friction, Property::Friction, Angle::None),
            ("armature", joint.armature, there.armature, Property::Armature, Angle::None),
            ("stiffness", joint.stiffness, there.stiffness, Property::Stiffness, Angle::Per),
            ("spring reference", joint.spring_reference, there.spring_reference, Property::SpringReference, Angle::Of),
        ];
        let [damping, friction] = [joint.damping, joint.friction];
        let is_exchanged = same(damping, there.friction) && same(friction, there.damping) && !same(damping, friction);
        if moves && is_exchanged {
            let sentence = format!("{other} has damping and friction of `{}` exchanged", joint.name);
            let change = Change::Joint(joint.name.clone(), Property::Losses([friction, damping]));
            causes.push(Cause::new("damping", &joint.name, sentence, true, change));
        }
        let is_told = |what: &str| is_exchanged && ["damping", "friction"].contains(&what);
        let numbers = numbers.into_iter().filter(|(what, ..)| !is_told(what));
        for (what, x, y, make, angle) in numbers.filter(|(_, x, y, ..)| moves && !same(*x, *y)) {
            let unit = || reason(x, y, of_kind(joint, angle));
            let why = if what == "armature" { gear(x, y).or_else(unit) } else { unit() };
            let has_reason = why.is_some();
            let why = why.unwrap_or_else(|| "differs".to_string());
            let sentence = format!("{what} of `{}` {why} in {other}: {}", joint.name, instead(x, y));
            let change = Change::Joint(joint.name.clone(), make(y));
            causes.push(Cause::new(kind(what), &joint.name, sentence, has_reason, change));
        }
        causes.extend(places.causes(joint, there, other));
    }
    causes.extend(places.of_base(other, is_held));
    causes
}

/// Positions of a prismatic joint are no angles.
fn of_kind(joint: &Joint, angle: Angle) -> Angle {
    if joint.kind.name() == "prismatic" { Angle::None } else { angle }
}

fn kind(what: &str) -> &'static str {
    ["damping", "friction", "armature", "stiffness"].into_iter().find(|known| *known == what).unwrap_or("spring")
}

/// A lost gear: the rotor's inertia without the square of a whole ratio.
fn gear(a: f64, b: f64) -> Option<String> {
    let ratio = (a / b).sqrt();
    let is_whole = b > 0.0 && ratio > 1.5 && ratio.round() <= 1000.0 && same(ratio / ratio.round(), 1.0);
    let is_ten = ten(a / b).is_some_and(|power| power % 2 != 0);
    (is_whole && !is_ten).then(|| format!("lacks the square of the gear ratio {}", ratio.round()))
}

/// Limits and couplings, which enter no force of independent joints, and a note on limits that a format does not hold.
pub fn silent(
    a: &Description,
    b: &Description,
    names: &dyn Fn(&str) -> String,
    files: [&RobotFile; 2],
) -> (Vec<Cause>, Option<String>) {
    let other = &files[1].name;
    let (mut causes, mut unheld) = (Vec::new(), Vec::new());
    for joint in a.joints.iter().filter(|joint| joint.kind != JointKind::Fixed) {
        let name = names(&joint.name);
        let Some(there) = b.joints.iter().find(|there| there.name == name && there.kind != JointKind::Fixed) else {
            continue;
        };
        let mut add = |size: f64, kind, sentence: String, has_reason| {
            causes.push(Cause { size, ..Cause::new(kind, &joint.name, sentence, has_reason, Change::NoForce) });
        };
        let part = |x: f64, y: f64| (x - y).abs() / x.abs().max(y.abs());
        let rates = [
            ("velocity limit", joint.limits.velocity, there.limits.velocity, Angle::Of),
            ("effort limit", joint.limits.effort, there.limits.effort, Angle::None),
            ("acceleration limit", joint.limits.acceleration, there.limits.acceleration, Angle::Of),
            ("lower limit", joint.limits.position.map(|p| p[0]), there.limits.position.map(|p| p[0]), Angle::Of),
            ("upper limit", joint.limits.position.map(|p| p[1]), there.limits.position.map(|p| p[1]), Angle::Of),
        ];
        let [v, f, w, g] = [joint.limits.velocity, joint.limits.effort, there.limits.velocity, there.limits.effort];
        let is_exchanged = v != f && v == g && f == w;
        if is_exchanged {
            add(
                f64::INFINITY,
                "limits",
                format!("{other} has the limits of velocity and effort of `{}` exchanged", joint.name),
                true,
            );
        }
        let is_negated = matches!((joint.limits.position, there.limits.position), (Some([p, q]), Some([r, s]))
            if same(r, -q) && same(s, -p) && !same(p, r));
        if is_negated {
            let words = "are negated and exchanged, as with the reversed axis,";
            add(f64::INFINITY, "limits", format!("limits of position of `{}` {words} in {other}", joint.name), true);
        }
        let rates = rates.into_iter().take(if is_negated { 3 } else { 5 });
        for (what, x, y, angle) in rates.skip(if is_exchanged { 2 } else { 0 }) {
            let subject = format!("{what} of `{}`", joint.name);
            let is_rate = ["velocity limit", "acceleration limit"].contains(&what);
            if is_rate && [x, y].iter().zip(files).any(|(limit, file)| limit.is_none() && !file.has_rates) {
                unheld.extend(x.or(y).map(|_| subject));
                continue;
            }
            match (x, y) {
                (Some(x), None) => {
                    add(f64::INFINITY, "limits", format!("{subject} is dropped in {other}: it was {}", shown(x)), true)
                }
                (None, Some(y)) => {
                    add(f64::INFINITY, "limits", format!("{subject} appears in {other}: {}", shown(y)), true)
                }
                (Some(x), Some(y)) if !same(x, y) => {
                    let unit = || reason(x, y, of_kind(joint, angle));
                    let why = if y == 0.0 { Some("is 0".to_string()) } else { unit() };
                    let has_reason = why.is_some();
                    let why = why.unwrap_or_else(|| "differs".to_string());
                    add(part(x, y), "limits", format!("{subject} {why} in {other}: {}", instead(x, y)), has_reason);
                }
                _ => {}
            }
        }
        let Some((x, y)) = joint.mimic.as_ref().map(|x| (x, there.mimic.as_ref())) else {
            if there.mimic.is_some() {
                add(f64::INFINITY, "mimic", format!("`{}` follows another joint in {other} only", joint.name), true);
            }
            continue;
        };
        match y {
            None => add(
                f64::INFINITY,
                "mimic",
                format!("`{}` follows `{}` here, and moves freely in {other}", joint.name, x.joint),
                true,
            ),
            Some(y) if names(&x.joint) != y.joint => {
                add(
                    f64::INFINITY,
                    "mimic",
                    format!("`{}` follows `{}` in {other}, `{}` here", joint.name, y.joint, x.joint),
                    true,
                );
            }
            Some(y) => {
                for (what, p, q, neutral, angle) in [
                    ("multiplier", x.ratio, y.ratio, 1.0, Angle::None),
                    ("offset", x.offset, y.offset, 0.0, of_kind(joint, Angle::Of)),
                ] {
                    if !same(p, q) {
                        let is_lost = q == neutral;
                        let why = if is_lost {
                            "is lost".to_string()
                        } else {
                            reason(p, q, angle).unwrap_or_else(|| "differs".into())
                        };
                        let sentence = format!(
                            "{what} of the mimic joint `{}` {why} in {other}: {} instead of {}",
                            joint.name,
                            shown(q),
                            shown(p)
                        );
                        add(part(p, q), "mimic", sentence, is_lost || reason(p, q, angle).is_some());
                    }
                }
            }
        }
    }
    let without = || &files.iter().find(|file| !file.has_rates).unwrap_or(&files[1]).name;
    let list = || vocabulary::some(&unheld, String::clone);
    let note = (!unheld.is_empty()).then(|| format!("not held by the format of {}: {}", without(), list()));
    (causes, note)
}
