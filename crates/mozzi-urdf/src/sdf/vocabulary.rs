//! The words of SDFormat 1.4 to 1.12.

use crate::urdf::vocabulary::{NOTHING, Vocabulary};

pub(crate) const SDF: Vocabulary = Vocabulary {
    attributes: &["version"],
    many: &["model", "world"],
    silent: &["light", "actor", "include"],
    ..NOTHING
};
pub(crate) const WORLD: Vocabulary = Vocabulary {
    attributes: &["name"],
    once: &["gravity"],
    many: &["model", "include", "joint", "frame", "plugin"],
    silent: &[
        "physics",
        "scene",
        "light",
        "gui",
        "state",
        "population",
        "road",
        "spherical_coordinates",
        "atmosphere",
        "magnetic_field",
        "wind",
        "audio",
        "actor",
    ],
    ..NOTHING
};
pub(crate) const MODEL: Vocabulary = Vocabulary {
    attributes: &["name", "canonical_link", "placement_frame"],
    once: &["static", "pose"],
    many: &["link", "joint", "frame", "model", "include", "plugin"],
    silent: &["self_collide", "allow_auto_disable", "enable_wind", "gripper"],
    ..NOTHING
};
pub(crate) const INCLUDE: Vocabulary = Vocabulary {
    attributes: &["merge"],
    once: &["uri", "name", "pose", "placement_frame", "static"],
    many: &["plugin"],
    ..NOTHING
};
pub(crate) const LINK: Vocabulary = Vocabulary {
    attributes: &["name"],
    once: &["pose", "inertial", "gravity", "kinematic", "velocity_decay"],
    many: &["collision", "visual", "plugin"],
    silent: &[
        "enable_wind",
        "self_collide",
        "must_be_base_link",
        "sensor",
        "projector",
        "audio_sink",
        "audio_source",
        "battery",
        "light",
        "particle_emitter",
        "material",
    ],
    ..NOTHING
};
pub(crate) const INERTIAL: Vocabulary = Vocabulary {
    attributes: &["auto"],
    once: &["pose", "mass", "inertia", "fluid_added_mass"],
    silent: &["density", "auto_inertia_params"],
    ..NOTHING
};
pub(crate) const INERTIA: Vocabulary = Vocabulary { once: &["ixx", "ixy", "ixz", "iyy", "iyz", "izz"], ..NOTHING };
pub(crate) const FRAME: Vocabulary = Vocabulary { attributes: &["name", "attached_to"], once: &["pose"], ..NOTHING };
pub(crate) const JOINT: Vocabulary = Vocabulary {
    attributes: &["name", "type"],
    once: &["pose", "parent", "child", "axis", "axis2", "thread_pitch", "screw_thread_pitch"],
    silent: &["physics", "sensor", "gearbox_ratio", "gearbox_reference_body"],
    ..NOTHING
};
pub(crate) const AXIS: Vocabulary = Vocabulary {
    once: &["xyz", "use_parent_model_frame", "dynamics", "limit", "mimic", "initial_position"],
    ..NOTHING
};
pub(crate) const DYNAMICS: Vocabulary =
    Vocabulary { once: &["damping", "friction", "spring_reference", "spring_stiffness"], ..NOTHING };
pub(crate) const LIMIT: Vocabulary =
    Vocabulary { once: &["lower", "upper", "effort", "velocity"], silent: &["stiffness", "dissipation"], ..NOTHING };
pub(crate) const MIMIC: Vocabulary =
    Vocabulary { attributes: &["joint", "axis"], once: &["multiplier", "offset", "reference"], ..NOTHING };
/// An element that is a text alone.
pub(crate) const POSE: Vocabulary =
    Vocabulary { attributes: &["relative_to", "rotation_format", "degrees", "frame"], ..NOTHING };
pub(crate) const XYZ: Vocabulary = Vocabulary { attributes: &["expressed_in"], ..NOTHING };

/// The types of joints, without Drake's.
pub(crate) const JOINT_TYPES: [&str; 9] =
    ["revolute", "continuous", "prismatic", "fixed", "ball", "screw", "universal", "revolute2", "gearbox"];
