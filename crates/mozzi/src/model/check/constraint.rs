//! Every constraint has anchors that exist and can move relative to each other, joints of one axis, finite numbers.

use super::tree::Tree;
use super::{Element, Report};
use crate::model::description::{Anchor, Closure, Constraint, ConstraintKind, Gear, JointKind};
use crate::model::error::names;
use crate::model::{Base, Description};
use alloc::collections::{BTreeMap, BTreeSet};
use alloc::format;
use alloc::string::ToString;

/// Maximum number of rows: the dense matrix A M⁻¹Aᵀ then fills 128 MiB.
const MOST_ROWS: usize = 4096;

impl Report<'_> {
    /// See the module.
    pub(super) fn constraints(
        &mut self,
        frames: &BTreeMap<&str, Element>,
        joints: &BTreeMap<&str, Element>,
        tree: Option<&Tree>,
    ) {
        let d = self.description;
        self.unique(d.constraints.iter().enumerate().map(|(i, one)| (Element::Constraint(i), one.name.as_str())));
        let rows: usize = d.constraints.iter().map(|one| one.row_names().len()).sum();
        if rows > MOST_ROWS {
            let message =
                format!("has {} constraints of {rows} rows, expected at most {MOST_ROWS}", d.constraints.len());
            self.error(Element::Robot, "constraints", "too_many_constraints", message);
        }
        for (i, constraint) in d.constraints.iter().enumerate() {
            let element = Element::Constraint(i);
            match &constraint.kind {
                ConstraintKind::Frames { a, b, closure } => {
                    if let Some(&length) = closure.length()
                        && !(length > 0.0 && length.is_finite())
                    {
                        let message = format!("is {length} m, expected a positive, finite number");
                        let what = if matches!(closure, Closure::Rolling(_)) { "radius" } else { "length" };
                        self.error(element, what, "bad_length", message);
                    }
                    let known = [("a", a), ("b", b)].map(|(which, anchor)| self.anchor(element, which, anchor, frames));
                    if known == [true, true]
                        && let Some(tree) = tree
                    {
                        self.can_move(element, constraint, [a, b], frames, tree);
                    }
                }
                ConstraintKind::Joint { joints: sum, source, polynomial } => {
                    if polynomial.iter().any(|x| !x.is_finite()) {
                        let message = format!("is {polynomial:?}, expected finite numbers");
                        self.error(element, "polynomial", "not_finite", message);
                    }
                    if sum.is_empty() {
                        let message = "is missing, expected the joint that is held".to_string();
                        self.error(element, "joint", "unknown_joint", message);
                    }
                    let mut seen = BTreeSet::new();
                    for (attribute, gear) in
                        sum.iter().map(|gear| ("joint", gear)).chain(source.iter().map(|gear| ("source", gear)))
                    {
                        let Gear { joint, ratio } = gear;
                        self.one_axis(element, attribute, joint, joints);
                        if !(ratio.is_finite() && *ratio != 0.0) {
                            let message = format!("has `{joint}` times {ratio}, expected a finite number other than 0");
                            self.error(element, attribute, "not_finite", message);
                        }
                        if !seen.insert(joint) {
                            let message = format!("has `{joint}` twice, expected each joint once");
                            self.error(element, attribute, "self_constraint", message);
                        }
                    }
                }
            }
        }
        for name in d.motors.iter().flatten() {
            match joints.get(name.as_str()) {
                Some(&Element::Joint(k)) if matches!(d.joints[k].kind, JointKind::Fixed) => {
                    let message = format!("hold `{name}`, a fixed joint, expected joints that move");
                    self.error(Element::Robot, "motors", "fixed_motor", message);
                }
                Some(&Element::Joint(k)) if d.joints[k].mimic.is_some() => {
                    let message = format!("hold `{name}`, a mimic joint, expected its source joint");
                    self.error(Element::Robot, "motors", "mimic_motor", message);
                }
                Some(_) => {}
                None => {
                    let message = format!("hold `{name}`, which does not exist, expected some of {}", names(&d.joints));
                    self.error(Element::Robot, "motors", "unknown_joint", message);
                }
            }
        }
    }

    /// Checks that the anchor's frame exists and its configuration is finite; false if it reported an error.
    fn anchor(
        &mut self,
        element: Element,
        which: &'static str,
        anchor: &Anchor,
        frames: &BTreeMap<&str, Element>,
    ) -> bool {
        let rows = anchor.T.to_matrix();
        if rows.as_flattened().iter().any(|x| !x.is_finite()) {
            self.error(
                element,
                which,
                "not_finite",
                "has a configuration with numbers that are not finite".to_string(),
            );
            return false;
        }
        match &anchor.frame {
            Some(name) if !frames.contains_key(name.as_str()) => {
                let message = format!("there is no link or frame `{name}`");
                self.error(element, which, "unknown_frame", message);
                false
            }
            _ => true,
        }
    }

    /// Reports anchors that are fixed to each other.
    fn can_move(
        &mut self,
        element: Element,
        constraint: &Constraint,
        [a, b]: [&Anchor; 2],
        frames: &BTreeMap<&str, Element>,
        tree: &Tree,
    ) {
        let d = self.description;
        let body = |anchor: &Anchor| match &anchor.frame {
            None if d.base == Base::Floating => None,
            None => Some(tree.order[0]),
            Some(name) => {
                let link = match frames.get(name.as_str())? {
                    Element::Link(i) => *i,
                    Element::Frame(i) => match frames.get(d.frames[*i].link.as_str())? {
                        Element::Link(i) => *i,
                        _ => return None,
                    },
                    _ => return None,
                };
                Some(rigid(d, tree, link))
            }
        };
        if body(a) == body(b) {
            let name = |anchor: &Anchor| anchor.frame.as_ref().map_or("{s}".to_string(), |name| format!("`{name}`"));
            let message = format!(
                "{} and {} are fixed to each other, expected two anchors that can move relative to each other",
                name(a),
                name(b)
            );
            self.error(element, constraint.kind_name(), "self_constraint", message);
        }
    }

    /// Reports a joint that does not exist, or does not have exactly one axis.
    fn one_axis(&mut self, element: Element, attribute: &'static str, name: &str, joints: &BTreeMap<&str, Element>) {
        let d = self.description;
        match joints.get(name) {
            Some(&Element::Joint(k)) if matches!(d.joints[k].kind, JointKind::Screw(_)) => {}
            Some(&Element::Joint(k)) => {
                let message = format!("is `{name}`, a {} joint, expected a joint of one axis", d.joints[k].kind.name());
                self.error(element, attribute, "constraint_of_several_axes", message);
            }
            _ => {
                let message = format!("`{name}` does not exist, expected one of {}", names(&d.joints));
                self.error(element, attribute, "unknown_joint", message);
            }
        }
    }
}

/// The link closest to the base to which this one is fixed.
fn rigid(d: &Description, tree: &Tree, mut link: usize) -> usize {
    while let Some(joint) = tree.joint[link]
        && matches!(d.joints[joint].kind, JointKind::Fixed)
    {
        link = tree.parent[link];
    }
    link
}
