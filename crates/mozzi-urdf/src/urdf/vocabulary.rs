//! The words of URDF.

/// The attributes and children that an element may have.
pub(crate) struct Vocabulary {
    pub attributes: &'static [&'static str],
    /// Children that may occur once.
    pub once: &'static [&'static str],
    /// Children that may occur repeatedly.
    pub many: &'static [&'static str],
    /// Known extensions, attributes or children, which do not affect the dynamics here.
    pub silent: &'static [&'static str],
    /// Attributes that are not used, and counted: see [`Context::leave_out`](crate::text::context::Context::leave_out).
    pub listed: &'static [&'static str],
}

pub(crate) const NOTHING: Vocabulary = Vocabulary { attributes: &[], once: &[], many: &[], silent: &[], listed: &[] };

pub(crate) const ROBOT: Vocabulary = Vocabulary {
    attributes: &["name", "version"],
    many: &["link", "joint"],
    // a loop_joint and a constraint are refused where links and joints are read
    silent: &["material", "gazebo", "transmission", "sensor", "ros2_control", "mujoco", "loop_joint", "constraint"],
    ..NOTHING
};
pub(crate) const LINK: Vocabulary = Vocabulary {
    attributes: &["name"],
    once: &["inertial"],
    many: &["visual", "collision"],
    silent: &["type", "material", "gazebo", "sensor", "contact"],
    ..NOTHING
};
pub(crate) const INERTIAL: Vocabulary = Vocabulary { once: &["origin", "mass", "inertia"], ..NOTHING };
pub(crate) const MASS: Vocabulary = Vocabulary { attributes: &["value"], ..NOTHING };
pub(crate) const INERTIA: Vocabulary =
    Vocabulary { attributes: &["ixx", "ixy", "ixz", "iyy", "iyz", "izz"], ..NOTHING };
pub(crate) const ORIGIN: Vocabulary = Vocabulary { attributes: &["xyz", "rpy", "quat_xyzw"], ..NOTHING };
pub(crate) const JOINT: Vocabulary = Vocabulary {
    attributes: &["name", "type"],
    once: &["origin", "parent", "child", "axis", "limit", "dynamics", "mimic", "safety_controller", "calibration"],
    silent: &["gazebo", "sensor", "transmission", "actuator"],
    ..NOTHING
};
pub(crate) const PARENT: Vocabulary = Vocabulary { attributes: &["link"], ..NOTHING };
pub(crate) const AXIS: Vocabulary = Vocabulary { attributes: &["xyz"], ..NOTHING };
pub(crate) const LIMIT: Vocabulary = Vocabulary {
    attributes: &["lower", "upper", "effort", "velocity"],
    silent: &["acceleration", "deceleration", "jerk"],
    ..NOTHING
};
pub(crate) const DYNAMICS: Vocabulary =
    Vocabulary { attributes: &["damping", "friction", "spring_stiffness", "spring_reference", "armature"], ..NOTHING };
pub(crate) const MIMIC: Vocabulary = Vocabulary { attributes: &["joint", "multiplier", "offset"], ..NOTHING };

/// The types of joints that mozzi computes.
pub(crate) const JOINT_TYPES: [&str; 6] = ["revolute", "continuous", "prismatic", "fixed", "planar", "floating"];

/// At most forty characters of a text, on one line.
pub(crate) fn shown(text: &str) -> String {
    let line = |c: char| if c.is_control() { ' ' } else { c };
    let mut short: String = text.chars().take(40).map(line).collect();
    if short.len() < text.len() {
        short.push('…');
    }
    short
}

/// `a`, `b`, `c`
pub(crate) fn list(words: &[&str]) -> String {
    if words.is_empty() {
        return "none".to_string();
    }
    words.iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_texts_are_cut() {
        assert_eq!(shown("a\nb"), "a b");
        assert_eq!(shown(&"ä".repeat(41)), format!("{}…", "ä".repeat(40)));
        assert_eq!(list(&["a", "b"]), "`a`, `b`");
    }
}
