//! The keys of each object of the file.

use super::entry::At;
use super::file::Misplaced;

/// The required and the optional keys of an object, and the objects, or lists of objects, in it.
#[derive(Clone, Copy, Debug)]
pub struct Object {
    required: &'static [&'static str],
    optional: &'static [&'static str],
    children: &'static [(&'static str, Object)],
}

const fn object(required: &'static [&'static str]) -> Object {
    Object::of(required)
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
    optional: &["A", "ball", "free", "stiffness", "spring_reference", "acceleration"],
    children: &[("mimic", object(&["joint", "ratio", "offset"]))],
};

const ROTOR: Object = Object { required: &["name", "armature", "gears"], optional: &[], children: &[("gears", GEAR)] };

/// A joint and its ratio.
pub(crate) const GEAR: Object = object(&["joint", "ratio"]);

const STATE: Object = Object {
    required: &["name", "joints"],
    optional: &["time", "base"],
    children: &[("base", object(&["pose", "twist"])), ("joints", object(&["name", "positions", "velocities"]))],
};

impl Object {
    /// An object with these required keys.
    pub const fn of(required: &'static [&'static str]) -> Self {
        Object { required, optional: &[], children: &[] }
    }

    /// Sets the optional keys.
    #[must_use]
    pub const fn optional(self, optional: &'static [&'static str]) -> Self {
        Object { optional, ..self }
    }

    /// Sets the keys whose values are objects, or lists of objects.
    #[must_use]
    pub const fn children(self, children: &'static [(&'static str, Object)]) -> Self {
        Object { children, ..self }
    }

    /// Checks that a value is an object with the required keys.
    ///
    /// # Errors
    /// All missing keys; a value that is no object.
    pub fn check_required(&self, at: &At) -> Result<(), Vec<Misplaced>> {
        if !at.value.is_object() {
            return at.wrong("an object").map_err(|error| vec![error]);
        }
        let errors = at.missing(self.required);
        if errors.is_empty() { Ok(()) } else { Err(errors) }
    }

    /// Checks a value, which must be an object, and all objects in it.
    ///
    /// # Errors
    /// All unknown and missing keys; a value that is no object, where one is expected.
    pub fn check_all(&self, at: &At) -> Result<(), Vec<Misplaced>> {
        if !at.value.is_object() {
            return at.wrong("an object").map_err(|error| vec![error]);
        }
        let mut errors = Vec::new();
        self.check(at, &mut errors);
        if errors.is_empty() { Ok(()) } else { Err(errors) }
    }

    /// All unknown and missing keys of a value that is such an object or a list of them.
    pub fn check(&self, at: &At, errors: &mut Vec<Misplaced>) {
        if let Ok(list) = at.list() {
            for entry in list {
                match entry.value.is_object() {
                    true => self.check(&entry, errors),
                    false => errors.extend(entry.wrong::<()>("an object").err()),
                }
            }
        } else if at.value.is_object() {
            errors.extend(at.unknown(&[self.required, self.optional].concat()));
            errors.extend(at.missing(self.required));
            self.children.iter().for_each(|(key, child)| child.check(&at.get(key), errors));
        }
    }
}
