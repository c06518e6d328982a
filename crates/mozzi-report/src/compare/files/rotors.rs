//! Rotors that several joints turn, which one file lacks or has with other numbers.

use super::cause::{Cause, Change};
use super::matching::Matched;
use super::number::{Angle, instead, reason, same, shown};
use mozzi::Description;
use mozzi::model::description::{JointKind, Rotor};
use std::collections::BTreeMap;

/// Makes of each rotor that turns with one moving joint only that joint's armature, which acts alike.
pub fn to_armature(robot: &mut Description) {
    let moves: Vec<String> =
        robot.joints.iter().filter(|j| j.kind != JointKind::Fixed).map(|joint| joint.name.clone()).collect();
    for mut rotor in std::mem::take(&mut robot.rotors) {
        rotor.gears.retain(|gear| moves.contains(&gear.joint) && gear.ratio != 0.0);
        match rotor.gears.as_slice() {
            _ if rotor.armature == 0.0 => {}
            [] => {}
            [gear] => {
                let own = robot.joints.iter_mut().filter(|joint| joint.name == gear.joint);
                own.for_each(|joint| joint.armature += rotor.armature * gear.ratio * gear.ratio);
            }
            _ => robot.rotors.push(rotor),
        }
    }
}

/// The rotors of both robots, paired by what they do, else by name, else by their joints.
pub fn causes(matched: &Matched, other: &str) -> Vec<Cause> {
    let (mut lone, mut lone_there): (Vec<&Rotor>, Vec<&Rotor>) =
        (matched.a.rotors.iter().collect(), matched.b.rotors.iter().collect());
    let mut pairs = Vec::new();
    let fits: [fn(&Rotor, &Rotor) -> bool; 3] =
        [are_same, |x, y| x.name == y.name, |x, y| ratios(x).keys().eq(ratios(y).keys())];
    for fits in fits {
        lone.retain(|x| {
            let Some(k) = lone_there.iter().position(|y| fits(x, y)) else { return true };
            pairs.push((*x, lone_there.remove(k)));
            false
        });
    }
    let new = |rotor: &Rotor, sentence: String, has_reason: bool, there: Option<&Rotor>| {
        let change = Change::Rotor(rotor.name.clone(), there.cloned());
        Cause::new("rotor", &rotor.name, sentence, has_reason, change)
    };
    let dropped = lone.into_iter().map(|x| {
        let sentence = format!("rotor `{}` is dropped in {other}: {}", x.name, words(x));
        new(x, sentence, true, None)
    });
    let differing = pairs.into_iter().filter(|(x, y)| !are_same(x, y)).map(|(x, y)| {
        let (sentence, has_reason) = difference(x, y, other);
        new(x, sentence, has_reason, Some(y))
    });
    let appearing = lone_there.into_iter().map(|y| {
        // its name may be that of another rotor here
        let mut name = y.name.clone();
        while matched.a.rotors.iter().any(|rotor| rotor.name == name) {
            name.push('\'');
        }
        let sentence = format!("rotor `{}` appears in {other}: {}", y.name, words(y));
        new(&Rotor { name, ..y.clone() }, sentence, true, Some(y))
    });
    dropped.chain(differing).chain(appearing).collect()
}

fn ratios(rotor: &Rotor) -> BTreeMap<&str, f64> {
    rotor.gears.iter().map(|gear| (gear.joint.as_str(), gear.ratio)).collect()
}

/// Whether all ratios of `y` are `factor` times those of `x`.
fn is_multiple(x: &Rotor, y: &Rotor, factor: f64) -> bool {
    let (x, y) = (ratios(x), ratios(y));
    x.keys().eq(y.keys()) && x.values().zip(y.values()).all(|(x, y)| same(x * factor, *y))
}

/// Whether both add the same to M: r times the ratios and 1/r² times the inertia is the same rotor.
fn are_same(x: &Rotor, y: &Rotor) -> bool {
    let factor = (x.armature / y.armature).sqrt();
    is_multiple(x, y, factor) || is_multiple(x, y, -factor)
}

/// "0.3 kg m², turned by 2 `j1` and -1 `j2`".
fn words(rotor: &Rotor) -> String {
    format!("inertia {}, turned by {}", shown(rotor.armature), gears(rotor))
}

fn gears(rotor: &Rotor) -> String {
    rotor.gears.iter().map(|gear| format!("{} `{}`", shown(gear.ratio), gear.joint)).collect::<Vec<_>>().join(" and ")
}

/// The sentence of two rotors that are not the same, and whether it has a reason.
fn difference(x: &Rotor, y: &Rotor, other: &str) -> (String, bool) {
    let name = &x.name;
    if is_multiple(x, y, 1.0) {
        let (p, q) = (x.armature, y.armature);
        let why = reason(p, q, Angle::None);
        let has_reason = why.is_some();
        let why = why.unwrap_or_else(|| "differs".to_string());
        return (format!("inertia of rotor `{name}` {why} in {other}: {}", instead(p, q)), has_reason);
    }
    (format!("rotor `{name}` is another in {other}: {}; here {}", words(y), words(x)), false)
}
