//! Causes in words.

use crate::compare::answer::{Answer, Fault, Unavailable, Workaround};
use crate::compare::bodies::{BodyChange, Reason};
use crate::compare::cause::{Cause, Change};
use crate::text::{about, scalar, tuple};

/// More items than this are only counted.
const LISTED: usize = 4;

/// The first few items, and the number of further ones.
pub fn some<T>(list: &[T], say: impl Fn(&T) -> String) -> String {
    let mut words: Vec<String> = list.iter().take(LISTED).map(say).collect();
    if list.len() > LISTED {
        words.push(format!("and {} more", list.len() - LISTED));
    }
    words.join(", ")
}

/// The difference and its cause.
pub fn cause(cause: &Cause, answer: &Answer) -> String {
    let library = answer.library;
    match cause {
        Cause::Mimics(list) => {
            let names = some(list, |freed| format!("`{}` follows `{}`", freed.joint, freed.source));
            let there = if list.iter().all(|freed| freed.constrained) {
                "is a joint of its own, which a constraint force (equality) pulls towards its source joint"
            } else if library == "Pinocchio" {
                "is a joint of its own: its reader drops <mimic> unless called with mimic=True"
            } else {
                "is a joint of its own"
            };
            format!("mimic joints: {names} here; in {library} each {there}")
        }
        Cause::Held(list) => {
            format!("joints: {} move here but not in {library}; held at 0", some(list, |name| format!("`{name}`")))
        }
        Cause::Gravity { mozzi, theirs } => {
            format!("gravity: {} here, {} in {library}, m/s²", tuple(mozzi), tuple(theirs))
        }
        Cause::Armature(list) => format!("armature (rotor inertia), here and in {library}: {}", changes(list)),
        Cause::Damping(list) if library == "Pinocchio" => {
            format!("damping: τ contains it here, Pinocchio's rnea omits it: {}", changes(list))
        }
        Cause::Damping(list) => format!("damping, here and in {library}: {}", changes(list)),
        Cause::Friction(list) if library == "Pinocchio" => {
            format!("friction: τ contains it here, Pinocchio's rnea omits it: {}", changes(list))
        }
        Cause::Friction(list) => {
            format!("friction: μ sgn θ̇ here, a constraint force (frictionloss) in {library}: {}", changes(list))
        }
        Cause::Stiffness(list) => {
            let none = if library == "Pinocchio" { "has none" } else { "reads none from this file" };
            format!("springs: τ contains k(θ − θ₀) here, {library} {none}: {}", changes(list))
        }
        Cause::Constraints(kinds) => format!(
            "constraints: τ of {library} contains the forces (qfrc_constraint) of {}; mozzi computes none",
            kinds.join(", ")
        ),
        Cause::Force(name) => force(name, library),
        Cause::Bodies(reason, list) => bodies(*reason, list, library),
        Cause::Axes(list) => {
            format!(
                "screw axes: {library} has different ones: {}",
                some(list, |(name, axis)| format!("`{name}` {}", tuple(axis)))
            )
        }
    }
}

fn changes(list: &[Change]) -> String {
    some(list, |change| format!("`{}` {} / {}", change.joint, scalar(change.mozzi), scalar(change.theirs)))
}

fn force(name: &str, library: &str) -> String {
    let what = match name {
        "spring" => "nonlinear springs (qfrc_spring)",
        "gravcomp" => "gravity compensation of bodies (qfrc_gravcomp)",
        "fluid" => "the drag of a fluid (qfrc_fluid)",
        other => other,
    };
    format!("{name}: τ of {library} contains {what}, which mozzi does not compute")
}

fn bodies(reason: Reason, list: &[BodyChange], library: &str) -> String {
    let mut list: Vec<&BodyChange> = list.iter().collect();
    if reason == Reason::BothShapes {
        list.sort_by(|x, y| y.moments_apart().total_cmp(&x.moments_apart()));
    }
    let why = match reason {
        Reason::Balanced => {
            "inertias that break the triangle inequality are those of spheres in MuJoCo (balanceinertia); as given here"
        }
        Reason::Dropped => "MuJoCo drops the moments of massless links that are fixed to others; included here",
        Reason::Bounded => "bodies without mass or inertia get some in MuJoCo (boundmass, boundinertia); as given here",
        Reason::Shapes => "MuJoCo computes inertias from the shapes (inertiafromgeom); no <inertial>, no mass here",
        Reason::BothShapes => "both compute inertias from the shapes (inertiafromgeom), with a difference of",
        Reason::Scaled => "MuJoCo scales all masses to a sum (settotalmass); as given here",
        Reason::Unknown => "bodies differ for an unknown reason",
    };
    let here = |change: &&BodyChange| {
        let (a, b) = (&change.mozzi, &change.theirs);
        let by = change.joint.as_str();
        let name = change.links.first().map_or(by, String::as_str);
        if reason == Reason::BothShapes {
            return format!("{:.1e} of the moments of `{name}`", change.moments_apart());
        }
        let moments = |inertia: &mozzi::SpatialInertia| inertia.verdict().principal_moments.map(about).join(", ");
        let centers = [a.center_of_mass().0, b.center_of_mass().0];
        let far = (0..3).any(|k| (centers[0][k] - centers[1][k]).abs() > 1e-9);
        let mut words = Vec::new();
        if (a.mass - b.mass).abs() > 1e-9 * a.mass.abs() {
            words.push(format!("{} / {} kg", scalar(a.mass), scalar(b.mass)));
        }
        if far && a.mass != 0.0 {
            let [a, b] = centers.map(|center| center.map(about).join(", "));
            words.push(format!("centre ({a}) / ({b}) m"));
        }
        if words.is_empty() || reason == Reason::Balanced {
            words.push(format!("moments ({}) / ({}) kg m²", moments(a), moments(b)));
        }
        let more = match change.links.len() {
            0 | 1 => String::new(),
            many => format!(" with {} fixed to it", many - 1),
        };
        format!("`{name}`{more} {}", words.join(", "))
    };
    let colon = if reason == Reason::BothShapes { "" } else { ":" };
    format!("inertia, here and in {library}: {why}{colon} {}", some(&list, here))
}

/// Names for balls and free joints.
pub fn coordinates(library: &str) -> &'static str {
    match library {
        "Pinocchio" => {
            "Pinocchio takes the quaternion of a ball or free joint as (x, y, z, w), a free joint's origin before it, and its velocity as (v, ω)"
        }
        _ => {
            "MuJoCo takes a free joint's origin before its quaternion, and its velocity as (ṗ, ω), ṗ in the world's axes"
        }
    }
}

/// The change that made the library accept the file.
pub fn workaround(workaround: Workaround) -> &'static str {
    match workaround {
        Workaround::Geometry => "without <visual> and <collision>",
        Workaround::Fixed => "without the <inertial> of links that no joint moves",
        Workaround::Balance => "with balanceinertia=\"true\"",
        Workaround::Bound => "with boundmass and boundinertia = 1e-9",
    }
}

pub fn unavailable(unavailable: &Unavailable, library: &str) -> String {
    let package = if library == "Pinocchio" { "pin" } else { "mujoco" };
    match unavailable {
        Unavailable::NotInstalled(message) => format!("not installed: {message}; pip install {package}"),
        Unavailable::Refuses(message) => format!("refuses the file: {message}"),
        Unavailable::Died(message, fault) => {
            let whose = match fault {
                Fault::Library => format!("the fault is {library}'s, or that of its installation"),
                Fault::Python => "the fault is that of the program called as Python".to_string(),
                Fault::Mozzi => "the fault is that of mozzi's script; please report it".to_string(),
            };
            format!("returned no result: {message}; {whose}")
        }
    }
}
