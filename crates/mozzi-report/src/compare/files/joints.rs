//! Differences in the numbers of joints.

use super::cause::{Cause, Change, Property};
use super::matching::Matched;
use super::number::{Angle, instead, reason, same, shown, ten};
use super::place::Places;
use crate::compare::Result;
use mozzi::Description;
use mozzi::model::description::{Joint, JointKind};

/// Gravity, friction, springs, armature and places, which enter the forces; `is_held` if one of the bases is free.
pub fn causes(matched: &Matched, other: &str, is_held: bool) -> Result<Vec<Cause>> {
    let (a, b) = (&matched.a, &matched.b);
    let mut causes = Vec::new();
    if a.gravity.iter().zip(b.gravity).any(|(x, y)| !same(*x, y)) {
        let sentence = format!("gravity is {:?} in {other}, {:?} here", b.gravity, a.gravity);
        causes.push(Cause::new("gravity", "", sentence, true, Change::Gravity(b.gravity)));
    }
    let places = Places::of([a, b])?;
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
        causes.extend(places.cause(joint, there, other));
    }
    if !causes.iter().any(|cause| cause.kind == "place") {
        causes.extend(places.of_base(other, is_held)); // no joint below it was named
    }
    Ok(causes)
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

/// The corresponding joint of the other robot: by name if it moves, by its child if it is fixed.
pub fn twin<'b>(joint: &Joint, b: &'b Description) -> Option<&'b Joint> {
    match joint.kind {
        JointKind::Fixed => b.joints.iter().find(|there| there.kind == JointKind::Fixed && there.child == joint.child),
        _ => b.joints.iter().find(|there| there.name == joint.name && there.kind != JointKind::Fixed),
    }
}

/// Limits and couplings, which enter no force of independent joints.
pub fn silent(a: &Description, b: &Description, names: &dyn Fn(&str) -> String, other: &str) -> Vec<Cause> {
    let mut causes = Vec::new();
    for joint in a.joints.iter().filter(|joint| joint.kind != JointKind::Fixed) {
        let name = names(&joint.name);
        let Some(there) = b.joints.iter().find(|there| there.name == name && there.kind != JointKind::Fixed) else {
            continue;
        };
        let mut add = |kind, sentence: String, has_reason| {
            causes.push(Cause::new(kind, &joint.name, sentence, has_reason, Change::NoForce));
        };
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
            add("limits", format!("{other} has the limits of velocity and effort of `{}` exchanged", joint.name), true);
        }
        for (what, x, y, angle) in rates.into_iter().skip(if is_exchanged { 2 } else { 0 }) {
            let subject = format!("{what} of `{}`", joint.name);
            match (x, y) {
                (Some(x), None) => add("limits", format!("{subject} is dropped in {other}: it was {}", shown(x)), true),
                (None, Some(y)) => add("limits", format!("{subject} appears in {other}: {}", shown(y)), true),
                (Some(x), Some(y)) if !same(x, y) => {
                    let unit = || reason(x, y, of_kind(joint, angle));
                    let why = if y == 0.0 { Some("is 0".to_string()) } else { unit() };
                    let has_reason = why.is_some();
                    let why = why.unwrap_or_else(|| "differs".to_string());
                    add("limits", format!("{subject} {why} in {other}: {}", instead(x, y)), has_reason);
                }
                _ => {}
            }
        }
        let Some((x, y)) = joint.mimic.as_ref().map(|x| (x, there.mimic.as_ref())) else {
            if there.mimic.is_some() {
                add("mimic", format!("`{}` follows another joint in {other} only", joint.name), true);
            }
            continue;
        };
        match y {
            None => {
                add("mimic", format!("`{}` follows `{}` here, and moves freely in {other}", joint.name, x.joint), true)
            }
            Some(y) if names(&x.joint) != y.joint => {
                add("mimic", format!("`{}` follows `{}` in {other}, `{}` here", joint.name, y.joint, x.joint), true);
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
                        add("mimic", sentence, is_lost || reason(p, q, angle).is_some());
                    }
                }
            }
        }
    }
    causes
}
