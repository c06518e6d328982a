//! `<axis>`: the direction of a joint.

use crate::report::finding::Finding;
use crate::text::context::Context;
use crate::text::element::Element;
use crate::urdf::vocabulary::AXIS;
use mozzi::{ScrewAxis, Twist, Vec3};

/// Tolerance on an axis' length before a warning; truncated digits stay below it.
const SLACK: f64 = 1e-3;

/// The joint's screw in the child's frame; None, with a diagnostic, if there is no direction. URDF's default is x.
pub(crate) fn read(kind: &str, axis: Option<&Element>, joint: &Element, cx: &mut Context) -> Option<ScrewAxis> {
    let x = Vec3([1.0, 0.0, 0.0]);
    let Some(axis) = axis else { return screw(kind, x).map(|(screw, _)| screw) };
    axis.check_attributes(&AXIS, cx);
    axis.check_children(&AXIS, cx);
    let value = axis.required("xyz", cx)?;
    let given = Vec3(axis.vector::<3>("xyz", &value, cx)?);
    let Some((screw, length)) = screw(kind, given) else {
        let message = format!("{}: axis: is `{}`, expected a direction", joint.subject, value.text.trim());
        cx.findings.add(Finding::error("zero_axis", value.span, message));
        return None;
    };
    if (length - 1.0).abs() > SLACK {
        let message = format!("{}: axis: `{}` has the length {length}, expected 1", joint.subject, value.text.trim());
        cx.findings.add(Finding::warning("non_unit_axis", value.span, message));
    }
    Some(screw)
}

/// The unit screw along a direction, and the direction's length.
pub(crate) fn screw(kind: &str, given: Vec3) -> Option<(ScrewAxis, f64)> {
    // lengths whose square overflows or vanishes are scaled first
    let largest = given.0.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let scale = if largest > 0.0 && !(1e-100..1e100).contains(&largest) { largest } else { 1.0 };
    let direction = given.map(|x| x / scale);
    let twist = match kind {
        "prismatic" => Twist { w: Vec3::zero(), v: direction },
        _ => Twist { w: direction, v: Vec3::zero() },
    };
    let (screw, length) = ScrewAxis::normalize(twist).ok()?;
    Some((screw, length * scale))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_direction_has_a_screw() {
        for size in [1e-300, 1e-3, 1.0, 1e300] {
            let (A, length) = screw("revolute", Vec3([0.0, 3.0 * size, 4.0 * size])).expect("a direction");
            assert!((A.twist().w - Vec3([0.0, 0.6, 0.8])).norm() < 1e-15);
            assert!((length / (5.0 * size) - 1.0).abs() < 1e-15);
        }
        assert!(screw("prismatic", Vec3::zero()).is_none());
    }
}
