//! The keys of each object of the file.

use super::entry::At;
use super::file::Misplaced;

/// The required and the optional keys of an object, and the objects, or lists of objects, in it.
pub struct Object {
    required: &'static [&'static str],
    optional: &'static [&'static str],
    children: &'static [(&'static str, Object)],
}

const fn object(required: &'static [&'static str]) -> Object {
    Object { required, optional: &[], children: &[] }
}

/// Quantities that most robots lack are optional.
pub const ROBOT: Object = Object {
    required: &["robot", "gravity", "links", "joints"],
    optional: &[
        "base",
        "free_joint",
        "end_effector",
        "rotors",
        "frames",
        "constraints",
        "motors",
        "states",
        "start",
        "lists",
    ],
    children: &[
        ("free_joint", object(&["name", "parent"])),
        ("links", object(&["name", "G"])),
        ("joints", JOINT),
        ("rotors", ROTOR),
        ("frames", object(&["name", "link", "T"])),
        ("states", STATE),
    ],
};

const JOINT: Object = Object {
    required: &[
        "name", "parent", "child", "M", "position", "velocity", "effort", "damping", "friction", "armature", "mimic",
    ],
    optional: &["A", "ball", "free", "stiffness", "spring_reference"],
    children: &[("mimic", object(&["joint", "ratio", "offset"]))],
};

const ROTOR: Object = Object {
    required: &["name", "armature", "gears"],
    optional: &[],
    children: &[("gears", object(&["joint", "ratio"]))],
};

const STATE: Object = Object {
    required: &["name", "joints"],
    optional: &["time", "base"],
    children: &[("base", object(&["pose", "twist"])), ("joints", object(&["name", "positions", "velocities"]))],
};

impl Object {
    /// All unknown and missing keys of a value that is such an object or a list of them.
    pub fn check(&self, at: &At, errors: &mut Vec<Misplaced>) {
        if let Ok(list) = at.list() {
            list.iter().for_each(|entry| self.check(entry, errors));
        } else if at.value.is_object() {
            errors.extend(at.unknown(&[self.required, self.optional].concat()));
            errors.extend(at.missing(self.required));
            self.children.iter().for_each(|(key, child)| child.check(&at.get(key), errors));
        }
    }
}
