//! Named states have existing joints, the right number of finite values for each, and unit quaternions.

use super::{Element, Report};
use crate::lie::length_off_unit;
use crate::model::description::{Joint, NamedState};
use crate::model::error::names;
use crate::model::{Base, Freedom};
use alloc::collections::{BTreeMap, BTreeSet};
use alloc::format;

impl Report<'_> {
    /// Every state fits this robot, and the start is one of them.
    pub(super) fn states(&mut self, joints: &BTreeMap<&str, Element>) {
        let d = self.description;
        self.unique(d.states.iter().enumerate().map(|(i, state)| (Element::State(i), state.name.as_str())));
        for (i, state) in d.states.iter().enumerate() {
            self.state(i, state, joints);
        }
        if let Some(start) = &d.start
            && !d.states.iter().any(|state| state.name == *start)
        {
            let message = format!("there is no state `{start}`, expected one of {}", names(&d.states));
            self.error(Element::Robot, "start", "unknown_state", message);
        }
    }

    fn state(&mut self, i: usize, state: &NamedState, joints: &BTreeMap<&str, Element>) {
        let (d, element) = (self.description, Element::State(i));
        if !state.time.is_finite() {
            self.error(element, "time", "not_finite", format!("is {}, expected a finite number", state.time));
        }
        if let Some(base) = &state.base {
            if d.base == Base::Fixed {
                let message = "is given, but the robot's base is fixed, expected none";
                self.error(element, "base", "fixed_base", message.into());
            }
            self.numbers_of("the base", Freedom::Free, [&base.pose, &base.twist], element);
        }
        let mut seen = BTreeSet::new();
        for joint in &state.joints {
            let name = joint.name.as_str();
            let Some(&Element::Joint(k)) = joints.get(name) else {
                let message = format!("there is no joint `{name}`, expected one of {}", names(&d.joints));
                self.error(element, "joints", "unknown_joint", message);
                continue;
            };
            if !seen.insert(name) {
                let message = format!("names `{name}` twice, expected once");
                self.error(element, "joints", "repeated_joint", message);
            }
            match &d.joints[k] {
                Joint { mimic: Some(mimic), .. } => {
                    let message = format!("`{name}` follows `{}`, expected independent joints alone", mimic.joint);
                    self.error(element, "joints", "mimic_in_state", message);
                }
                Joint { kind, .. } => match kind.freedom() {
                    Some(freedom) => {
                        let numbers = [joint.positions.as_slice(), &joint.velocities];
                        self.numbers_of(&format!("joint `{name}`"), freedom, numbers, element);
                    }
                    None => {
                        let message = format!("`{name}` is fixed, expected joints that move");
                        self.error(element, "joints", "fixed_in_state", message);
                    }
                },
            }
        }
    }

    /// The right number of values, all finite, and a unit quaternion.
    fn numbers_of(&mut self, owner: &str, freedom: Freedom, numbers: [&[f64]; 2], element: Element) {
        let counts = [("positions", freedom.positions()), ("velocities", freedom.velocities())];
        for (found, (attribute, expected)) in numbers.into_iter().zip(counts) {
            if found.len() != expected {
                let message = format!("{owner} has {} numbers, expected {expected}", found.len());
                self.error(element, attribute, "wrong_count", message);
            } else if let Some(x) = found.iter().find(|x| !x.is_finite()) {
                let message = format!("{owner} has {x}, expected finite numbers");
                self.error(element, attribute, "not_finite", message);
            } else if attribute == "positions"
                && let Some(q) = freedom.quaternion(found)
                && let Some(length) = length_off_unit(q)
            {
                let message =
                    format!("{owner} has {q:?}, of length {length}, expected a unit quaternion (w, x, y, z), to 1e-3");
                self.error(element, attribute, "invalid_quaternion", message);
            }
        }
    }
}
