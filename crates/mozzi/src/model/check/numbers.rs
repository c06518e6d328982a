//! Finite numbers, masses, frictions and stiffnesses of the right sign.

use super::{Element, Report};
use crate::model::description::JointKind;
use crate::spatial::SpatialInertia;
use alloc::format;
use alloc::string::ToString;

/// True if all ten numbers are finite, and so are the centre of mass and the inertia about it.
pub(super) fn is_finite(inertia: &SpatialInertia) -> bool {
    let c = inertia.center_of_mass();
    let at_c = inertia.about_center_of_mass().to_mat3().rows();
    let made = c.0.iter().chain(at_c.as_flattened());
    inertia.to_matrix().as_flattened().iter().chain(made).all(|x| x.is_finite())
}

impl Report<'_> {
    /// Finite numbers, masses and frictions of the right sign.
    pub(super) fn numbers(&mut self) {
        let d = self.description;
        if !d.gravity.iter().all(|x| x.is_finite()) {
            self.error(Element::Robot, "gravity", "not_finite", format!("is {:?}, expected finite numbers", d.gravity));
        }
        for (i, link) in d.links.iter().enumerate() {
            let (mass, element) = (link.inertia.mass, Element::Link(i));
            if !is_finite(&link.inertia) {
                let message = "is not finite: mass, centre of mass or a moment is infinite, NaN or too large";
                self.error(element, "inertia", "not_finite", message.to_string());
            } else if mass < 0.0 {
                self.error(element, "mass", "negative_mass", format!("is {mass} kg, expected at least 0"));
            }
        }
        for (i, joint) in d.joints.iter().enumerate() {
            let element = Element::Joint(i);
            if !joint.origin.to_matrix().as_flattened().iter().all(|x| x.is_finite()) {
                self.error(element, "origin", "not_finite", "has entries that are not finite".to_string());
            }
            if let JointKind::Ball(center) = joint.kind
                && !center.0.iter().all(|x| x.is_finite())
            {
                self.error(
                    element,
                    "kind",
                    "not_finite",
                    format!("is a ball at {:?}, expected finite numbers", center.0),
                );
            }
            if joint.kind == JointKind::Free && joint.stiffness != 0.0 {
                let message = format!(
                    "is {} of a free joint, expected 0: springs of free joints are not supported",
                    joint.stiffness
                );
                self.error(element, "stiffness", "unsupported_spring", message);
            }
            if matches!(joint.kind, JointKind::Ball(_)) && joint.spring_reference != 0.0 {
                let message = format!(
                    "is {} of a ball, expected 0: its spring is at rest where its positions are (1, 0, 0, 0)",
                    joint.spring_reference
                );
                self.error(element, "spring reference", "unsupported_spring", message);
            }
            for (attribute, x) in [
                ("damping", joint.damping),
                ("friction", joint.friction),
                ("armature", joint.armature),
                ("stiffness", joint.stiffness),
            ] {
                if !(x >= 0.0 && x.is_finite()) {
                    self.error(
                        element,
                        attribute,
                        "negative_friction",
                        format!("is {x}, expected a finite number, at least 0"),
                    );
                }
            }
            if !joint.spring_reference.is_finite() {
                let message = format!("is {}, expected a finite number", joint.spring_reference);
                self.error(element, "spring reference", "not_finite", message);
            }
            if let Some([low, high]) = joint.limits.position
                && !(low <= high)
                && !matches!(joint.kind, JointKind::Ball(_) | JointKind::Free)
            {
                self.error(
                    element,
                    "limits",
                    "reversed_limits",
                    format!("go from {low} to {high}, expected the lower bound first"),
                );
            }
            match (joint.kind, joint.limits.position) {
                (JointKind::Ball(_), Some([low, high])) if !(low == 0.0 && high >= 0.0) => {
                    let message = format!("go from {low} to {high}, expected 0 and the ball's largest angle");
                    self.error(element, "limits", "reversed_limits", message);
                }
                (JointKind::Free, Some([low, high])) => {
                    let message = format!("go from {low} to {high}, expected none for a free joint");
                    self.error(element, "limits", "reversed_limits", message);
                }
                _ => {}
            }
            for (attribute, limit) in [
                ("velocity limit", joint.limits.velocity),
                ("effort limit", joint.limits.effort),
                ("acceleration limit", joint.limits.acceleration),
            ] {
                if limit.is_some_and(|x| !(x >= 0.0)) {
                    self.error(
                        element,
                        attribute,
                        "negative_limit",
                        format!("is {}, expected at least 0", limit.unwrap_or_default()),
                    );
                }
            }
        }
        for (i, frame) in d.frames.iter().enumerate() {
            if !frame.T.to_matrix().as_flattened().iter().all(|x| x.is_finite()) {
                self.error(Element::Frame(i), "T", "not_finite", "has entries that are not finite".to_string());
            }
        }
    }
}
