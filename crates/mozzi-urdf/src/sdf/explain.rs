//! The meaning and remedy of the codes that SDFormat alone has, or in which it has other words.

use crate::report::explain::Entry;

#[rustfmt::skip] // code, meaning, remedy
pub(crate) const CODES: [Entry; 15] = [
    ("circular_frames",
        "The pose of a frame is relative to itself, or a frame is attached to itself, directly or over other frames. Its \
         place is then undefined.",
        "let one of them be relative to `__model__`"),
    ("contradictory_pitch",
        "A screw has both `screw_thread_pitch`, the travel per turn, and the older `thread_pitch`, which is -2π over it, \
         and they disagree.",
        "keep one of them"),
    ("default_inertia",
        "A link has no mass or no moments of inertia. SDFormat then gives it 1 kg and moments of 1 kg m², as Gazebo and \
         Drake do, and so does mozzi.",
        "write <mass> and <inertia>"),
    ("duplicate_name",
        "Two links, joints, frames or models in one model have the same name.",
        "rename one of them"),
    ("ignored_element",
        "A static model of a world is no part of the robot: nothing in it moves. It is counted, not warned of.",
        "no action is needed"),
    ("ignored_plugin",
        "A plugin is a program that Gazebo runs. It may apply forces, which mozzi does not know. Reported once for each \
         program.",
        "add its forces, if it has any, to the joint torques or applied wrenches"),
    ("include",
        "An included model cannot be read. It must be on this machine, in SDFormat, and have one model.",
        "write the name of a file or folder next to this file, or model://NAME with the folder NAME beside or above it"),
    ("inertia_from_shapes",
        "An inertia is to be computed from shapes and their density (`auto`), which mozzi does not do for SDFormat.",
        "write <mass> and <inertia>"),
    ("misplaced_joint",
        "The child of a joint is the world, which does not move.",
        "exchange <parent> and <child>"),
    ("no_model",
        "The file has no model, or only static ones, in which nothing moves.",
        "check that this is the right file"),
    ("static_model",
        "The robot, or a model in it, is static: nothing in it would move.",
        "remove <static>, or fix the model to the world by a fixed joint"),
    ("unknown_frame",
        "A pose, an axis, a frame or a model names a frame that does not exist in its model.",
        "use the name of a link, joint, frame or model of the same model, with the same spelling, or `__model__`"),
    ("unknown_joint_type",
        "The type of a joint is not one of SDFormat's.",
        "revolute, continuous, prismatic, screw, ball, universal, revolute2 and fixed are read"),
    ("unsupported_joint",
        "A joint is a gearbox, which couples two other joints, or a <drake:joint> of another type than planar.",
        "couple joints by a <mimic> in the <axis> of one of them"),
    ("unsupported_version",
        "The version of an SDFormat file is 1.4 to 1.12.",
        "`gz sdf -p FILE` writes an older file in the newest version"),
];

/// All codes that are specific to SDFormat, without `mozzi::sdf::`.
pub fn codes() -> impl Iterator<Item = &'static str> {
    CODES.iter().map(|&(code, ..)| code)
}
