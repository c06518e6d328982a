//! Every rotor has a physical inertia, and joints of one axis that turn it.

use super::{Element, Report};
use crate::model::description::JointKind;
use crate::model::error::names;
use alloc::collections::{BTreeMap, BTreeSet};
use alloc::format;
use alloc::string::ToString;

impl Report<'_> {
    /// Every rotor has a physical inertia, and joints of one axis that turn it.
    pub(super) fn rotors(&mut self, joints: &BTreeMap<&str, Element>) {
        let d = self.description;
        self.unique(d.rotors.iter().enumerate().map(|(i, rotor)| (Element::Rotor(i), rotor.name.as_str())));
        for (i, rotor) in d.rotors.iter().enumerate() {
            let element = Element::Rotor(i);
            if !(rotor.armature >= 0.0 && rotor.armature.is_finite()) {
                let message = format!("is {}, expected a finite number, at least 0", rotor.armature);
                self.error(element, "armature", "negative_friction", message);
            }
            if rotor.gears.is_empty() {
                self.error(element, "joints", "idle_rotor", "are missing, expected those that turn it".to_string());
            }
            let mut turning = BTreeSet::new();
            for gear in &rotor.gears {
                if !gear.ratio.is_finite() {
                    let message = format!("is {} at `{}`, expected a finite number", gear.ratio, gear.joint);
                    self.error(element, "ratio", "not_finite", message);
                }
                if !turning.insert(gear.joint.as_str()) {
                    let message = format!("hold `{}` twice, expected one ratio for each joint", gear.joint);
                    self.error(element, "joints", "duplicate_name", message);
                }
                match joints.get(gear.joint.as_str()) {
                    Some(&Element::Joint(k)) => {
                        let kind = d.joints[k].kind;
                        if matches!(kind, JointKind::Ball(_) | JointKind::Free) {
                            let message =
                                format!("hold `{}`, a {} joint, expected joints of one axis", gear.joint, kind.name());
                            self.error(element, "joints", "rotor_of_several_axes", message);
                        }
                    }
                    _ => {
                        let message = format!(
                            "hold `{}`, which does not exist, expected some of {}",
                            gear.joint,
                            names(&d.joints)
                        );
                        self.error(element, "joints", "unknown_joint", message);
                    }
                }
            }
        }
    }
}
