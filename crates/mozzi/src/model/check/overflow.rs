//! Finite numbers whose products overflow.

use super::{Element, Report};
use crate::model::Model;
use crate::model::build::normal_form;
use crate::model::description::JointKind;
use crate::spatial::Rounded;
use alloc::format;
use core::cell::Cell;

/// Below this, no constant of a model overflows, except with long chains of mimic joints.
const LARGE: f64 = 1e30;
/// Ratios of mimic joints multiply along their chains, and enter squared.
const LARGE_RATIO: f64 = 1e100;

impl Report<'_> {
    /// Reports an error at the largest number of a robot whose model is not finite. Only robots with very large numbers
    /// are built for this check.
    pub(super) fn overflow(&mut self) {
        let d = self.description;
        let (mut largest, mut ratios) = ((0.0, Element::Robot, ""), 1.0);
        let mut see = |numbers: &[f64], element, attribute| {
            for x in numbers {
                if x.abs() > largest.0 {
                    largest = (x.abs(), element, attribute);
                }
            }
        };
        for (i, link) in d.links.iter().enumerate() {
            let (element, G) = (Element::Link(i), &link.inertia);
            see(&[G.mass], element, "mass");
            see(G.to_matrix().as_flattened(), element, "inertia");
        }
        for (i, joint) in d.joints.iter().enumerate() {
            let element = Element::Joint(i);
            see(&joint.origin.p.0, element, "origin");
            see(&[joint.damping], element, "damping");
            see(&[joint.friction], element, "friction");
            see(&[joint.armature], element, "armature");
            see(&[joint.stiffness], element, "stiffness");
            see(&[joint.spring_reference], element, "spring reference");
            match joint.kind {
                JointKind::Screw(A) => see(&A.twist().to_array(), element, "kind"),
                JointKind::Ball(center) => see(&center.0, element, "kind"),
                JointKind::Fixed | JointKind::Free => {}
            }
            if let Some(mimic) = &joint.mimic {
                see(&[mimic.ratio, mimic.offset], element, "mimic");
                ratios *= 1.0 + mimic.ratio * mimic.ratio;
            }
        }
        for (i, rotor) in d.rotors.iter().enumerate() {
            see(&[rotor.armature], Element::Rotor(i), "armature");
            rotor.gears.iter().for_each(|gear| see(&[gear.ratio], Element::Rotor(i), "ratio"));
        }
        for (i, frame) in d.frames.iter().enumerate() {
            see(&frame.T.p.0, Element::Frame(i), "T");
        }
        let (size, element, attribute) = largest;
        if self.errors == 0 && !(size <= LARGE && ratios <= LARGE_RATIO) && !is_finite(&normal_form(d, d.clone())) {
            let message = format!(
                "holds a number of the size {}: results computed with it exceed the range of double precision",
                Rounded(size)
            );
            self.error(element, attribute, "too_large_number", message);
        }
    }
}

/// True if all constants of the model are finite, and all lists computed from them.
fn is_finite(model: &Model) -> bool {
    let finite = Cell::new(true);
    model.map(|c: f64| {
        finite.set(finite.get() && c.is_finite());
        c
    });
    finite.get()
}
