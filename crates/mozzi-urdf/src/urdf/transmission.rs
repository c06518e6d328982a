//! Rotors behind gears. Drake's actuators have `<drake:rotor_inertia>` and `<drake:gear_ratio>`; a `<transmission>` of
//! ROS has `<mechanicalReduction>` and, as an extension, `<motorInertia>`. The armature of the joint is ratio² ×
//! inertia.

use crate::report::finding::Finding;
use crate::report::places::Places;
use crate::report::spelling::did_you_mean;
use crate::text::context::Context;
use crate::text::element::{Element, Value};
use crate::urdf::drake;
use crate::urdf::vocabulary::shown;
use mozzi::Description;

/// Names of ROS's elements, in lower case without underscores.
const INERTIAS: [&str; 2] = ["motorinertia", "rotorinertia"];
const RATIOS: [&str; 2] = ["mechanicalreduction", "gearratio"];

/// Adds the rotors of all actuators to their joints.
pub(crate) fn rotors(root: &Element, description: &mut Description, places: &mut Places, cx: &mut Context) {
    for element in root.elements() {
        match element.written_name() {
            "transmission" => transmission(&element, description, places, cx),
            "ros2_control" => {
                for inner in element.elements().filter(|child| child.written_name() == "transmission") {
                    transmission(&inner, description, places, cx);
                }
            }
            "joint" | "drake:joint" => {
                let Some(name) = element.attribute("name") else { continue };
                let joint = element.called(format!("joint `{}`", shown(name.text)));
                // Drake's documentation puts them in an actuator of the joint
                for holder in joint.elements().filter(|child| child.written_name() == "actuator").chain([joint.clone()])
                {
                    if holder.name() == "actuator" {
                        drake::check_words(&holder, cx);
                    }
                    if let Some(rotor) = Rotor::of_drake(&holder, cx) {
                        rotor.add(name.text, description, places, cx);
                    }
                }
            }
            _ => {}
        }
    }
}

fn transmission(element: &Element, description: &mut Description, places: &mut Places, cx: &mut Context) {
    let named = element.attribute("name").map_or_else(String::new, |name| format!(" `{}`", shown(name.text)));
    let element = element.called(format!("transmission{named}"));
    let Some(actuator) = child(&element, "actuator") else { return };
    drake::check_words(&actuator, cx);
    let is_drake = child(&actuator, "drake:rotor_inertia").is_some();
    let found = match is_drake {
        true => Rotor::of_drake(&actuator, cx),
        false => Rotor::of_ros(&element, cx),
    };
    let Some(rotor) = found else { return };
    let ignored = |why: String, cx: &mut Context| {
        let message = format!("{}: its rotor is ignored: {why}", element.subject);
        cx.findings.add(Finding::warning("ignored_property", rotor.inertia.span(), message));
    };
    let kind = ["type", "plugin"].into_iter().find_map(|word| child(&element, word));
    let kind = kind.map_or_else(|| element.attribute("type").map_or("", |value| value.text), |kind| kind.text());
    if !kind.contains("SimpleTransmission") {
        return ignored(format!("the type is `{}`, expected a SimpleTransmission", shown(kind.trim())), cx);
    }
    let count = |name: &'static str| element.elements().filter(|child| child.written_name() == name).count();
    if !is_drake && (count("joint") > 1 || count("actuator") > 1) {
        return ignored("the transmission has several joints or actuators".to_string(), cx);
    }
    let Some(joint) = child(&element, "joint") else {
        let message = format!("{}: has a rotor and no <joint> that turns it", element.subject);
        cx.findings.error("missing_element", element.span(), message);
        return;
    };
    let Some(name) = joint.required_name("name", cx) else { return };
    let is_part = |joint: &str| joint.strip_prefix(name.text).is_some_and(|rest| rest.starts_with('.'));
    let found = find(description, name.text);
    if found.is_none() && !description.joints.iter().any(|joint| is_part(&joint.name)) {
        let message = format!("{}: joint: there is no joint `{}`", element.subject, shown(name.text));
        let help = did_you_mean(name.text, description.joints.iter().map(|joint| joint.name.as_str()).take(1000));
        cx.findings.add(Finding::error("unknown_joint", name.span, message).maybe_help(help));
        return;
    }
    if is_drake && found.is_some_and(|i| description.joints[i].limits.effort == Some(0.0)) {
        let why = format!("joint `{}` has the effort limit 0, and Drake gives it no actuator", shown(name.text));
        return ignored(why, cx);
    }
    rotor.add(name.text, description, places, cx);
}

/// A rotor and the element of its inertia.
struct Rotor<'a> {
    inertia: Element<'a>,
    armature: f64,
}

impl<'a> Rotor<'a> {
    /// In an actuator; None if it has none or, with a diagnostic, if a number is invalid.
    fn of_drake(holder: &Element<'a>, cx: &mut Context) -> Option<Self> {
        let inertia = child(holder, "drake:rotor_inertia")?;
        let ratio = child(holder, "drake:gear_ratio").map_or(Some([1.0]), |ratio| drake::value(&ratio, cx));
        let ([value], [ratio]) = (drake::value(&inertia, cx)?, ratio?);
        Some(Rotor { inertia, armature: ratio * ratio * value })
    }

    /// Anywhere in a transmission. Without a ratio it is 1; two ratios that differ are an error.
    fn of_ros(transmission: &Element<'a>, cx: &mut Context) -> Option<Self> {
        let (mut inertias, mut ratios) = (Vec::new(), Vec::new());
        gather(transmission, &mut |element| {
            let name = element.written_name().to_ascii_lowercase().replace('_', "");
            if INERTIAS.contains(&&*name) {
                inertias.push(element);
            } else if RATIOS.contains(&&*name) {
                ratios.push(element);
            }
        });
        let inertia = inertias.first()?.clone();
        let mut ratio = None;
        for element in &ratios {
            let found = number(element, cx)?;
            if ratio.is_some_and(|known| known != found) {
                let message = format!("{}: is {found}, but another reduction here is not", element.subject);
                cx.findings.error("contradictory_attribute", element.span(), message);
            }
            ratio = Some(found);
        }
        let ratio = ratio.unwrap_or(1.0);
        if inertias.len() > 1 {
            let message = format!("{}: is the second rotor of this transmission, expected one", inertias[1].subject);
            cx.findings.error("duplicate_element", inertias[1].span(), message);
        }
        Some(Rotor { armature: ratio * ratio * number(&inertia, cx)?, inertia })
    }

    /// Adds the armature to a joint of one axis.
    fn add(&self, joint: &str, description: &mut Description, places: &mut Places, cx: &mut Context) {
        let moving = find(description, joint)
            .filter(|&i| matches!(description.joints[i].kind.name(), "revolute" | "prismatic" | "helical"));
        match moving {
            Some(i) => {
                description.joints[i].armature += self.armature;
                places.joints[i].set("armature", self.inertia.span());
            }
            None if self.armature != 0.0 => {
                let message =
                    format!("{}: is ignored: joint `{}` has not one axis", self.inertia.subject, shown(joint));
                cx.findings.add(Finding::warning("ignored_property", self.inertia.span(), message));
            }
            None => {}
        }
    }
}

fn find(description: &Description, name: &str) -> Option<usize> {
    description.joints.iter().position(|joint| joint.name == name)
}

/// The first child with this name, prefix included.
fn child<'a>(element: &Element<'a>, name: &str) -> Option<Element<'a>> {
    element.elements().find(|child| child.written_name() == name)
}

/// All elements inside.
fn gather<'a>(element: &Element<'a>, take: &mut impl FnMut(Element<'a>)) {
    for child in element.elements() {
        gather(&child, take);
        take(child);
    }
}

/// The number that is an element's text.
fn number(element: &Element, cx: &mut Context) -> Option<f64> {
    let value = Value { text: element.text(), span: element.span() };
    element.vector::<1>("value", &value, cx).map(|[x]| x)
}
