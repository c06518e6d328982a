//! The names of a robot in SDFormat: one space of names for links, joints and frames, without SDFormat's own.

use super::base::has_world;
use crate::urdf::write::{escaped, free};
use crate::written::names_of;
use mozzi::Description;
use std::collections::{BTreeMap, BTreeSet};

/// Links, joints and frames, by their names in the robot.
pub(super) struct Names {
    model: String,
    links: BTreeMap<String, String>,
    joints: BTreeMap<String, String>,
    frames: BTreeMap<String, String>,
}

impl Names {
    /// The names, and a line for each kind of names that are changed.
    pub fn of(d: &Description) -> (Self, Vec<String>) {
        let (mut taken, mut changed) =
            (BTreeSet::from(["world".to_string(), super::FIXED_BASE.to_string()]), Vec::new());
        let mut settle = |name: &str, ending: &str| {
            let plain = plain(name);
            // a name of SDFormat's own, or of something else, gets an ending
            let written =
                if taken.contains(&plain) { free(&format!("{plain}{ending}"), |n| taken.contains(n)) } else { plain };
            if written != name {
                changed.push((name.to_string(), written.clone()));
            }
            taken.insert(written.clone());
            (name.to_string(), safe(&written))
        };
        let has_world = has_world(d);
        let is_world = |name: &str| has_world && name == "world";
        let links =
            d.links.iter().filter(|link| !is_world(&link.name)).map(|link| settle(&link.name, "_link")).collect();
        let frames = d.frames.iter().map(|frame| settle(&frame.name, "_frame")).collect();
        let joints = d.joints.iter().map(|joint| settle(&joint.name, "_joint")).collect();
        let model = match d.name.as_str() {
            "" | "world" => "robot".to_string(),
            name => plain(name),
        };
        if model != d.name {
            changed.push((d.name.clone(), model.clone()));
        }
        let written: Vec<String> = changed.iter().map(|(name, written)| format!("{name}` → `{written}")).collect();
        let written: Vec<&str> = written.iter().map(String::as_str).collect();
        let losses = names_of("names that SDFormat has for itself or once only:", &written).into_iter().collect();
        (Names { model: safe(&model), links, joints, frames }, losses)
    }

    pub fn model(&self) -> &str {
        &self.model
    }

    pub fn link(&self, name: &str) -> &str {
        self.links.get(name).map_or("", String::as_str)
    }

    pub fn joint(&self, name: &str) -> &str {
        self.joints.get(name).map_or("", String::as_str)
    }

    pub fn frame(&self, name: &str) -> &str {
        self.frames.get(name).map_or("", String::as_str)
    }
}

/// Without SDFormat's separator, and not between double underscores, which are reserved.
fn plain(name: &str) -> String {
    let name = name.replace("::", ".");
    if name.starts_with("__") && name.ends_with("__") { name.trim_matches('_').to_string() } else { name }
}

/// As the value of an attribute or an element.
pub(super) fn safe(name: &str) -> String {
    escaped(name).replace('>', "&gt;")
}
