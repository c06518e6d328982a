//! Rotations that are misread or lost.

use super::number::decimals;
use mozzi::{SO3, Vec3};

/// Rotations that converters make of one, with the words of the error and of its reverse.
pub fn misread(R: SO3) -> [(SO3, [&'static str; 2]); 6] {
    let [r, p, y] = R.to_rpy();
    let [a, b, c] = [r, p, y].map(f64::to_degrees);
    // Rot(x, roll) Rot(y, pitch) Rot(z, yaw)
    let other_order = SO3::from_rpy(r, 0.0, 0.0) * SO3::from_rpy(0.0, p, 0.0) * SO3::from_rpy(0.0, 0.0, y);
    let (w, Vec3([x, y, z])) = R.quaternion();
    let order = "roll, pitch and yaw in the other order";
    let [swapped, read] = ["quaternion in the order x y z w", "quaternion read in the order x y z w"];
    [
        (R.inverse(), ["", ""]),
        (SO3::identity(), ["", ""]),
        (SO3::from_rpy(a, b, c), ["angles in degrees", "angles in radians, read as degrees"]),
        (other_order, [order, order]),
        (SO3::from_quaternion(x, Vec3([y, z, w])), [swapped, read]),
        (SO3::from_quaternion(z, Vec3([w, x, y])), [read, swapped]),
    ]
}

/// The error that makes one rotation the other, in words that follow a name.
pub fn reason(a: SO3, b: SO3) -> Option<String> {
    let is_near = |x: SO3, y: SO3| (x.inverse() * y).log().norm() < 1e-6;
    if is_near(a.inverse(), b) {
        return Some("is rotated by the inverse".to_string());
    }
    if is_near(SO3::identity(), b) {
        return Some("is not rotated".to_string());
    }
    let forward = misread(a).into_iter().skip(2).find(|(R, _)| is_near(*R, b)).map(|(_, [words, _])| words);
    let back = || misread(b).into_iter().skip(2).find(|(R, _)| is_near(*R, a)).map(|(_, [_, words])| words);
    let named = forward.or_else(back).map(|words| format!("has its {words}"));
    named.or_else(|| decimals(&a.to_rpy(), &b.to_rpy()).map(|count| format!("is rounded to {count} decimals")))
}
