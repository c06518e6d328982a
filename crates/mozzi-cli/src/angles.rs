//! `--deg`: angles on the command line and on pages in degrees. Files, tables and JSON stay in radians.

use crate::failure::note;
use mozzi::model::description::JointKind;
use mozzi::{Freedom, Model};
use std::sync::atomic::{AtomicBool, Ordering};

static DEGREES: AtomicBool = AtomicBool::new(false);

/// Sets the unit of this run of the program.
pub fn set_degrees(are_degrees: bool) {
    DEGREES.store(are_degrees, Ordering::Relaxed);
}

/// Whether angles are in degrees.
pub fn are_degrees() -> bool {
    DEGREES.load(Ordering::Relaxed)
}

/// Which entries of θ are angles: neither those of quaternions nor lengths.
pub fn of_positions(model: &Model) -> Vec<bool> {
    let mut are_angles = vec![false; model.nq()];
    for (joint, place) in model.joints().zip(model.places()) {
        let is_turning = place.freedom == Freedom::One && turns(joint.kind);
        place.positions().for_each(|k| are_angles[k] = is_turning);
    }
    are_angles
}

/// Which entries of θ̇ and θ̈ are of angles.
pub fn of_velocities(model: &Model) -> Vec<bool> {
    let mut are_angles: Vec<bool> = (0..model.n()).map(|k| k < 3 && model.is_floating()).collect();
    for (joint, place) in model.joints().zip(model.places()) {
        for (k, j) in place.velocities().enumerate() {
            are_angles[j] = match place.freedom {
                Freedom::One => turns(joint.kind),
                Freedom::Ball => true,
                Freedom::Free => k < 3,
            };
        }
    }
    are_angles
}

/// Whether a joint of one axis turns.
pub fn turns(kind: JointKind) -> bool {
    matches!(kind, JointKind::Screw(A) if A.twist().w.0 != [0.0; 3])
}

/// A joint's position or rate, or a ball's angle, of a page: in degrees with `--deg`.
pub fn of_joint(kind: JointKind, x: f64) -> f64 {
    if turns(kind) || matches!(kind, JointKind::Ball(_)) { of_turn(x) } else { x }
}

/// An angle of a page.
pub fn of_turn(x: f64) -> f64 {
    if are_degrees() { x.to_degrees() } else { x }
}

/// Positions or rates of a page: in degrees with `--deg`.
pub fn shown(values: &[f64], are_angles: &[bool]) -> Vec<f64> {
    let one = |(&x, &is_angle): (&f64, &bool)| if is_angle { of_turn(x) } else { x };
    values.iter().zip(are_angles).map(one).collect()
}

/// "deg/s" for "rad/s" with `--deg`.
pub fn unit(unit: &str) -> String {
    if are_degrees() { unit.replace("rad", "deg") } else { unit.to_string() }
}

/// The unit of numbers that are in radians even with `--deg`.
pub fn in_radians(unit: &str) -> String {
    if are_degrees() { unit.replace("deg", "rad") } else { unit.to_string() }
}

/// Files are in radians, whatever the flags are in.
pub fn of_file(file: &str) {
    if are_degrees() {
        note(&format!("{file} is read in radians: --deg is for the angles of flags and of printed text"));
    }
}

/// Questions angles, in radians, that are more than two turns: they may be meant in degrees.
pub fn question(flag: &str, text: &str, found: &[f64], are_angles: &[bool]) {
    let is_large = |(x, is_angle): (&f64, &bool)| *is_angle && x.abs() > 4.0 * std::f64::consts::PI;
    if are_degrees() || has_unit(text) {
        return;
    }
    if let Some((x, _)) = found.iter().zip(are_angles).find(|pair| is_large((pair.0, pair.1))) {
        let unit = match flag {
            "--dtheta" => "rad/s",
            "--ddtheta" => "rad/s²",
            _ => "radians",
        };
        let turns = x / std::f64::consts::TAU;
        if x.abs() > 1e6 || unit != "radians" {
            return note(&format!("{flag} is in {unit}, and {x:e} is large; degrees: --deg"));
        }
        note(&format!("{flag} is in radians, and {x} rad are {turns:.1} turns; degrees: --deg, or {x}deg"));
    }
}

/// Whether a number or a name states the unit of an angle.
pub fn has_unit(text: &str) -> bool {
    ["deg", "°", "pi", "π", "rad"].iter().any(|unit| text.contains(unit))
}
