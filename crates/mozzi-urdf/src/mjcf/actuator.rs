//! `<actuator>`, `gravcomp` and the controls of keys, which move a simulated robot as in MuJoCo. They are no part of a
//! [`Description`](mozzi::Description): the torques of joints are arguments of its functions.

use super::attributes::Item;
use super::{Model, Wanted, is_mjcf, read_pages};
use crate::report::error::LoadError;
use crate::report::finding::Findings;
use crate::report::spelling::counted;
use crate::text::context::Context;
use crate::text::dialect::Dialect;
use crate::text::element::Element;
use crate::text::number::all_numbers;
use crate::text::source::Source;
use crate::text::{bytes, syntax};
use crate::urdf::vocabulary::shown;
use crate::{XacroArguments, file_bytes};
use mozzi::model::description::JointKind;
use std::collections::BTreeMap;
use std::path::Path;

/// An actuator of joints or of a fixed tendon: the force (g₀ + g₁l + g₂l̇)u + b₀ + b₁l + b₂l̇, with l = Σ gear θ.
#[derive(Clone, Debug, PartialEq)]
pub struct Actuator {
    /// Its name, or a generated one.
    pub name: String,
    /// Joints of one axis, each with ∂l/∂θ.
    pub gears: Vec<(String, f64)>,
    /// (g₀, g₁, g₂).
    pub gain: [f64; 3],
    /// (b₀, b₁, b₂).
    pub bias: [f64; 3],
    /// Bounds of the control u.
    pub control_range: Option<[f64; 2]>,
    /// Bounds of the force.
    pub force_range: Option<[f64; 2]>,
}

/// The actuators of an MJCF file, its controls, and its gravity compensation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Actuation {
    /// In the order of the file, which is that of MuJoCo's `ctrl`; None for one that is left out.
    pub actuators: Vec<Option<Actuator>>,
    /// The controls of a key, by the state's name.
    pub controls: BTreeMap<String, Vec<f64>>,
    /// Links whose weight is compensated, each with the compensated part.
    pub compensated: Vec<(String, f64)>,
    /// Actuators and controls that are not computed, each with the reason.
    pub left_out: Vec<String>,
}

/// The actuation of a file, or of an embedded robot by its name; none unless it is MJCF.
///
/// # Errors
/// [`LoadError::File`] when it cannot be read.
pub fn actuation(name_or_path: &str, given: &XacroArguments) -> Result<Actuation, LoadError> {
    let path = Path::new(name_or_path);
    if !path.is_file() {
        return Ok(Actuation::default());
    }
    Ok(actuation_of(path.parent(), name_or_path, &file_bytes(path)?, given))
}

/// The actuation of a text; files that it includes are searched in a folder.
pub fn actuation_of(folder: Option<&Path>, file_name: &str, text: &[u8], given: &XacroArguments) -> Actuation {
    // the model's reader reports what it finds
    let text = bytes::read(text, &mut Findings::default());
    if !is_mjcf(text) {
        return Actuation::default();
    }
    let source = syntax::mended(Source::new(file_name, text), Dialect::Mjcf, &mut Findings::default());
    let mut cx = Context::new(Findings::default(), Dialect::Mjcf);
    let read = read_pages(&mut vec![source], (folder, given), Wanted::Actuation, &mut cx);
    read.and_then(|read| read.actuation).unwrap_or_default()
}

impl<'a> Model<'a> {
    /// Notes an actuator; those that are not computed keep their place among the controls.
    pub fn drive(&mut self, item: &Item<'a>, joints: &BTreeMap<String, usize>, cx: &mut Context) {
        let Some(mut actuation) = self.actuation.take() else { return };
        let given = item.element.attribute("name").map(|value| value.text.to_string());
        let name = given.unwrap_or_else(|| format!("actuator{}", actuation.actuators.len()));
        if self.options.idle_groups.contains(&item.number("group", 0.0, cx)) {
            actuation.actuators.push(None);
            self.actuation = Some(actuation);
            return;
        }
        let found = self.actuator_of(&name, item, joints, cx);
        if let Err(why) = &found {
            actuation.left_out.push(format!("actuator `{}`: {why}, which is not computed", shown(&name)));
        }
        actuation.actuators.push(found.ok());
        self.actuation = Some(actuation);
    }

    fn actuator_of(
        &self,
        name: &str,
        item: &Item<'a>,
        joints: &BTreeMap<String, usize>,
        cx: &mut Context,
    ) -> Result<Actuator, String> {
        let mut law = self.classes.law(&item.element);
        law.apply(&item.element, cx);
        let [gain, bias] = law.parameters()?;
        if item.number("delay", 0.0, cx) > 0.0 {
            return Err("has a delay".to_string());
        }
        let [gear, ..] = if item.has("gear") { item.overlaid::<6>("gear", cx) } else { [1.0; 6] };
        let joint = ["joint", "jointinparent"].into_iter().find_map(|word| item.element.attribute(word));
        let tendon = item.element.attribute("tendon");
        let (mut gears, mut range) = (Vec::new(), None);
        if let Some(value) = joint {
            let Some(&index) = joints.get(value.text) else { return Err("drives an unknown joint".to_string()) };
            let joint = &self.tree.joints[index].joint;
            if !matches!(joint.kind, JointKind::Screw(_)) {
                return Err(format!("drives joint `{}`, which has several axes", shown(value.text)));
            }
            range = joint.limits.position;
            gears.push((value.text.to_string(), gear));
        } else if let Some(value) = tendon {
            let rotor = self.tree.rotors.iter().find(|rotor| rotor.name.given.as_deref() == Some(value.text));
            match rotor {
                Some(rotor) if rotor.clamps => {
                    return Err(format!("drives tendon `{}`, which clamps its actuators' force", shown(value.text)));
                }
                Some(rotor) if rotor.is_fixed => {
                    gears.extend(rotor.gears.iter().map(|one| (one.joint.clone(), gear * one.ratio)));
                }
                _ => return Err(format!("drives tendon `{}`, whose ratios vary", shown(value.text))),
            }
        } else {
            let other = ["site", "body", "slidersite", "cranksite"];
            let what = other.into_iter().find(|word| item.has(word)).unwrap_or("joint");
            return Err(format!("drives a {what}"));
        }
        let mut bounds = |limited: &str, name: &str| {
            let range = item.vector::<2>(name, cx)?;
            let is_limited = match item.word(limited, &["auto", "true", "false"], cx).unwrap_or("auto") {
                "auto" => self.compiler.of(&item.element).autolimits && range[0] < range[1],
                word => word == "true",
            };
            is_limited.then_some(range)
        };
        let mut control_range = bounds("ctrllimited", "ctrlrange");
        let force_range = bounds("forcelimited", "forcerange");
        // a share of the joint's range about its middle
        let share = item.number("inheritrange", 0.0, cx);
        if let (true, Some([low, high])) = (share > 0.0 && bias[1] != 0.0, range) {
            let (middle, half) = (0.5 * (low + high), 0.5 * share * (high - low));
            control_range = Some([middle - half, middle + half]);
        }
        let control_range = control_range.filter(|_| self.options.clamps);
        Ok(Actuator { name: name.to_string(), gears, gain, bias, control_range, force_range })
    }

    /// The actuation when all actuators are read.
    pub fn settled(
        &mut self,
        links: &[mozzi::model::description::Link],
        keys: &[(String, Element)],
    ) -> Option<Actuation> {
        let mut actuation = self.actuation.take()?;
        if !self.options.actuation {
            (actuation.actuators, actuation.left_out) = (Vec::new(), Vec::new());
        }
        let compensated = links.iter().zip(&self.compensations).filter(|(_, part)| **part != 0.0);
        actuation.compensated = compensated.map(|(link, part)| (link.name.clone(), *part)).collect();
        for (name, key) in keys {
            let Some(value) = key.attribute("ctrl") else { continue };
            let (found, expected) = (all_numbers(value.text).unwrap_or_default(), actuation.actuators.len());
            if found.len() == expected {
                actuation.controls.insert(name.clone(), found);
            } else if self.options.actuation && !value.text.trim().is_empty() {
                let (name, text) = (shown(name), shown(value.text));
                let expected = counted(expected, "number");
                let message = format!("key `{name}`: ctrl: is `{text}`, expected {expected}; it is not used");
                actuation.left_out.push(message);
            }
        }
        Some(actuation)
    }
}
