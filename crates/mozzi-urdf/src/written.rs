//! The result of writing a robot in a format.

use mozzi::Description;
use mozzi::model::description::Joint;
use std::fmt;

/// A robot's text in a format, and the properties that the format cannot express.
#[derive(Clone, Debug, PartialEq)]
pub struct Written {
    /// The text.
    pub text: String,
    /// Properties that the text omits or changes, each with its element: "joint `a`: effort limit 0". Empty if
    /// reading the text gives the same robot up to rounding.
    pub losses: Vec<String>,
    /// Elements that some readers of the format may refuse.
    pub remarks: Vec<String>,
}

/// The parts of a robot without which it would be another one, and which a format cannot express.
#[derive(Clone, Debug, PartialEq)]
pub struct NotWritten {
    /// The format: "SDFormat" or "MJCF".
    pub language: &'static str,
    /// Each with its element.
    pub reasons: Vec<String>,
}

impl fmt::Display for NotWritten {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} cannot express {}", self.language, self.reasons.join(", nor "))
    }
}

impl std::error::Error for NotWritten {}

/// The names that are lost, as one line: "the names of 3 fixed joints (`a`, `b`, …)".
pub(crate) fn names_of(what: &str, names: &[&str]) -> Option<String> {
    const SHOWN: usize = 4;
    let mut shown: Vec<String> = names.iter().take(SHOWN).map(|name| format!("`{name}`")).collect();
    if names.len() > SHOWN {
        shown.push("…".to_string());
    }
    match names.len() {
        0 => None,
        1 => Some(format!("{what} {}", shown.join(", "))),
        count => Some(format!("{what} {} ({count})", shown.join(", "))),
    }
}

/// The choice of the end effector, as the loss of a format without it.
pub fn chosen_end_effector(robot: &Description) -> Option<String> {
    robot.end_effector.as_ref().map(|name| format!("the choice of the end effector, `{name}`"))
}

/// The robot's named states, as the loss of a format without them: "the named states `home`".
pub fn named_states(robot: &Description) -> Option<String> {
    names_of("the named states", &robot.states.iter().map(|state| state.name.as_str()).collect::<Vec<_>>())
}

/// The forces and the rotor of a free joint, for formats without them: "joint `f`: damping 1 of a free joint".
pub(crate) fn of_free_joint(joint: &Joint) -> Option<String> {
    let all = [("damping", joint.damping), ("friction", joint.friction), ("armature", joint.armature)];
    let found = all.into_iter().filter(|(_, value)| *value != 0.0).map(|(what, value)| format!("{what} {value}"));
    let found: Vec<String> = found.collect();
    (!found.is_empty()).then(|| format!("joint `{}`: {} of a free joint", joint.name, found.join(", ")))
}
