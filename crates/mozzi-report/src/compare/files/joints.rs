//! Differences in the numbers of joints.

use super::cause::{Cause, Change, Property};
use super::matching::Matched;
use super::number::{reason, same, shown, ten};
use crate::compare::Result;
use crate::compare::constants::home;
use mozzi::model::description::{Joint, JointKind};
use mozzi::{Description, SE3, Vec3};

/// Gravity, friction, springs, armature and places, which enter the forces.
pub fn causes(matched: &Matched, other: &str) -> Result<Vec<Cause>> {
    let (a, b) = (&matched.a, &matched.b);
    let mut causes = Vec::new();
    if a.gravity.iter().zip(b.gravity).any(|(x, y)| !same(*x, y)) {
        let sentence = format!("gravity is {:?} in {other}, {:?} here", b.gravity, a.gravity);
        causes.push(Cause::new("gravity", "", sentence, true, Change::Gravity(b.gravity)));
    }
    let (home_a, home_b) = (home(a)?, home(b)?);
    for joint in &a.joints {
        let Some(there) = twin(joint, b) else { continue };
        let moves = joint.kind != JointKind::Fixed;
        type Make = fn(f64) -> Property;
        let numbers: [(&str, f64, f64, Make); 5] = [
            ("damping", joint.damping, there.damping, Property::Damping),
            ("friction", joint.friction, there.friction, Property::Friction),
            ("armature", joint.armature, there.armature, Property::Armature),
            ("stiffness", joint.stiffness, there.stiffness, Property::Stiffness),
            ("spring reference", joint.spring_reference, there.spring_reference, Property::SpringReference),
        ];
        for (what, x, y, make) in numbers.into_iter().filter(|(_, x, y, _)| moves && !same(*x, *y)) {
            let why = if what == "armature" { gear(x, y).or_else(|| reason(x, y)) } else { reason(x, y) };
            let has_reason = why.is_some();
            let why = why.unwrap_or_else(|| "differs".to_string());
            let sentence = format!("{what} of `{}` {why} in {other}: {} instead of {}", joint.name, shown(y), shown(x));
            let change = Change::Joint(joint.name.clone(), make(y));
            causes.push(Cause::new(kind(what), &joint.name, sentence, has_reason, change));
        }
        causes.extend(place(joint, there, [&home_a, &home_b], other));
    }
    Ok(causes)
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
fn twin<'b>(joint: &Joint, b: &'b Description) -> Option<&'b Joint> {
    match joint.kind {
        JointKind::Fixed => b.joints.iter().find(|there| there.kind == JointKind::Fixed && there.child == joint.child),
        _ => b.joints.iter().find(|there| there.name == joint.name && there.kind != JointKind::Fixed),
    }
}

type Home = std::collections::BTreeMap<String, SE3>;

/// Another origin or axis, if the joint is elsewhere at home, too.
fn place(a: &Joint, b: &Joint, homes: [&Home; 2], other: &str) -> Option<Cause> {
    let close = |x: f64, y: f64| (x - y).abs() <= 1e-9 * (1.0 + x.abs());
    let same_place = |x: SE3, y: SE3| (0..4).all(|i| (0..4).all(|j| close(x.to_matrix()[i][j], y.to_matrix()[i][j])));
    let screw = |kind: JointKind| match kind {
        JointKind::Screw(A) => A.twist().to_array(),
        JointKind::Ball(c) => [0.0, 0.0, 0.0, c.0[0], c.0[1], c.0[2]],
        _ => [0.0; 6],
    };
    let same_screw = |x: [f64; 6], y: [f64; 6]| x.iter().zip(y).all(|(x, y)| close(*x, y));
    let origins = same_place(a.origin, b.origin);
    if origins && same_screw(screw(a.kind), screw(b.kind)) {
        return None;
    }
    let at_home = |joint: &Joint, home: &Home| match joint.kind {
        JointKind::Screw(A) => A.transformed(home[&joint.child]).twist().to_array(),
        JointKind::Ball(c) => {
            let c = home[&joint.child] * c;
            [0.0, 0.0, 0.0, c.0[0], c.0[1], c.0[2]]
        }
        _ => [0.0; 6],
    };
    let is_moving = a.kind != JointKind::Fixed;
    if is_moving && same_screw(at_home(a, homes[0]), at_home(b, homes[1]))
        || !is_moving && same_place(homes[0][&a.child], homes[1][&b.child])
    {
        return None; // other link frames, the same motion
    }
    let name = &a.name;
    let change = Change::Joint(name.clone(), Property::Place(b.origin, b.kind));
    if a.parent != b.parent || a.child != b.child {
        let sentence = format!(
            "`{name}` joins `{}` and `{}` in {other}, `{}` and `{}` here",
            b.parent, b.child, a.parent, a.child
        );
        return Some(Cause::new("place", name, sentence, false, change));
    }
    let why = if origins { of_axis(screw(a.kind), screw(b.kind)) } else { of_origin(a.origin, b.origin) };
    let has_reason = why.is_some();
    let why = why.unwrap_or_else(|| if origins { "has another axis" } else { "is elsewhere" }.to_string());
    Some(Cause::new("place", name, format!("`{name}` {why} in {other}"), has_reason, change))
}

fn of_axis(a: [f64; 6], b: [f64; 6]) -> Option<String> {
    let reversed = a.iter().zip(b).all(|(x, y)| (x + y).abs() <= 1e-9 * (1.0 + x.abs()));
    reversed.then(|| "has the reversed axis".to_string())
}

fn of_origin(a: SE3, b: SE3) -> Option<String> {
    let turned = (a.R.inverse() * b.R).log().norm() > 1e-9;
    let near = |x: Vec3, y: Vec3| (x - y).norm() <= 1e-9 * (1.0 + x.norm());
    if !turned {
        let ratio = b.p.norm() / a.p.norm();
        let along = near(a.p * (1.0 / a.p.norm()), b.p * (1.0 / b.p.norm()));
        return match ten(ratio).filter(|_| along) {
            Some(3) => Some("has its origin in mm".to_string()),
            Some(power) => Some(format!("has its origin off by a factor 1e{power}, a unit")),
            None if b.p == Vec3::zero() => Some("has no origin".to_string()),
            None => None,
        };
    }
    if !near(a.p, b.p) {
        return None;
    }
    let (x, y) = (Vec3(a.R.to_rpy()), Vec3(b.R.to_rpy()));
    let as_degrees = |x: Vec3, y: Vec3| {
        let [r, p, q] = x.0.map(f64::to_degrees);
        (mozzi::SO3::from_rpy(r, p, q).inverse() * mozzi::SO3::from_rpy(y.0[0], y.0[1], y.0[2])).log().norm() < 1e-6
    };
    if (a.R * b.R).log().norm() < 1e-9 {
        return Some("is rotated by the inverse".to_string());
    }
    if b.R == SE3::identity().R {
        return Some("is not rotated".to_string());
    }
    if as_degrees(x, y) {
        return Some("has its angles in degrees".to_string());
    }
    as_degrees(y, x).then(|| "has its angles in radians, read as degrees".to_string())
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
            ("velocity limit", joint.limits.velocity, there.limits.velocity),
            ("effort limit", joint.limits.effort, there.limits.effort),
            ("acceleration limit", joint.limits.acceleration, there.limits.acceleration),
            ("lower limit", joint.limits.position.map(|p| p[0]), there.limits.position.map(|p| p[0])),
            ("upper limit", joint.limits.position.map(|p| p[1]), there.limits.position.map(|p| p[1])),
        ];
        for (what, x, y) in rates {
            let subject = format!("{what} of `{}`", joint.name);
            match (x, y) {
                (Some(x), None) => add("limits", format!("{subject} is dropped in {other}: it was {}", shown(x)), true),
                (None, Some(y)) => add("limits", format!("{subject} appears in {other}: {}", shown(y)), true),
                (Some(x), Some(y)) if !same(x, y) => {
                    let why = if y == 0.0 { Some("is 0".to_string()) } else { reason(x, y) };
                    let has_reason = why.is_some();
                    let why = why.unwrap_or_else(|| "differs".to_string());
                    add(
                        "limits",
                        format!("{subject} {why} in {other}: {} instead of {}", shown(y), shown(x)),
                        has_reason,
                    );
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
                for (what, p, q, neutral) in
                    [("multiplier", x.ratio, y.ratio, 1.0), ("offset", x.offset, y.offset, 0.0)]
                {
                    if !same(p, q) {
                        let is_lost = q == neutral;
                        let why = if is_lost {
                            "is lost".to_string()
                        } else {
                            reason(p, q).unwrap_or_else(|| "differs".into())
                        };
                        let sentence = format!(
                            "{what} of the mimic joint `{}` {why} in {other}: {} instead of {}",
                            joint.name,
                            shown(q),
                            shown(p)
                        );
                        add("mimic", sentence, is_lost || reason(p, q).is_some());
                    }
                }
            }
        }
    }
    causes
}
