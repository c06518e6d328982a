//! Every mimic joint follows a joint that moves, and not itself.

use super::{Element, Report, Severity};
use crate::model::description::{Joint, JointKind, Mimic};
use crate::model::error::names;
use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;

impl Report<'_> {
    /// Every mimic joint follows a joint that moves, and not itself.
    pub(super) fn mimics(&mut self, joints: &BTreeMap<&str, Element>) {
        let d = self.description;
        let source = |i: usize| {
            let mimic = d.joints[i].mimic.as_ref()?;
            match joints.get(mimic.joint.as_str()) {
                Some(&Element::Joint(k)) => Some(k),
                _ => None,
            }
        };
        let circular = circular(d.joints.len(), source);
        for (i, joint) in d.joints.iter().enumerate() {
            let (Some(mimic), element) = (&joint.mimic, Element::Joint(i)) else { continue };
            if !(mimic.ratio.is_finite() && mimic.offset.is_finite()) {
                let message = format!("ratio {} and offset {}, expected finite numbers", mimic.ratio, mimic.offset);
                self.error(element, "mimic", "not_finite", message);
            }
            let Some(k) = source(i) else {
                let message = format!("there is no joint `{}`, expected one of {}", mimic.joint, names(&d.joints));
                self.error(element, "mimic", "unknown_joint", message);
                continue;
            };
            if joint.kind == JointKind::Fixed {
                let message = format!("follows `{}`, but is a fixed joint, which does not move", mimic.joint);
                self.add(Severity::Warning, element, "mimic", "fixed_mimic", message);
            } else if d.joints[k].kind == JointKind::Fixed {
                self.error(
                    element,
                    "mimic",
                    "fixed_source",
                    format!("joint `{}` is fixed, expected one that moves", mimic.joint),
                );
            }
            for other in [i, k].into_iter().filter(|&other| is_of_several_axes(d.joints[other].kind)) {
                let Joint { name, kind, .. } = &d.joints[other];
                let message = format!("`{name}` is a {} joint, expected joints of one axis", kind.name());
                self.error(element, "mimic", "mimic_of_several_axes", message);
            }
            if circular[i] {
                let message = if k == i {
                    format!("follows itself, `{}`, expected another joint", mimic.joint)
                } else {
                    format!(
                        "following `{}` leads back in a circle, expected an independent joint at the end",
                        mimic.joint
                    )
                };
                self.error(element, "mimic", "circular_mimic", message);
            } else if let Some(message) = contradiction(joint, mimic, &d.joints[k]) {
                self.add(Severity::Warning, element, "mimic", "contradictory_limits", message);
            }
        }
    }
}

fn is_of_several_axes(kind: JointKind) -> bool {
    matches!(kind, JointKind::Ball(_) | JointKind::Free)
}

/// Which joints lead into a cycle; each joint is visited twice at most.
fn circular(n: usize, source: impl Fn(usize) -> Option<usize>) -> Vec<bool> {
    let (mut known, mut circular) = (vec![false; n], vec![false; n]);
    let mut walked = vec![n; n]; // the joint from which this one was last visited
    for start in 0..n {
        let (mut path, mut at, mut in_circle) = (Vec::new(), Some(start), false);
        while let Some(i) = at {
            if known[i] || walked[i] == start {
                in_circle = !known[i] || circular[i];
                break;
            }
            walked[i] = start;
            path.push(i);
            at = source(i);
        }
        for i in path {
            (known[i], circular[i]) = (true, in_circle);
        }
    }
    circular
}

/// A message if no position of the source joint keeps both joints within their limits.
fn contradiction(joint: &Joint, mimic: &Mimic, source: &Joint) -> Option<String> {
    let ([low, high], [a, b]) = (joint.limits.position?, source.limits.position?);
    let (x, y) = (mimic.ratio * a + mimic.offset, mimic.ratio * b + mimic.offset);
    let (x, y) = (x.min(y), x.max(y));
    (y < low || high < x).then(|| {
        format!(
            "moves from {x} to {y} as `{}` moves within its limits, but its own limits are {low} and {high}",
            mimic.joint
        )
    })
}
