//! The words of MJCF.

use crate::urdf::vocabulary::{NOTHING, Vocabulary};

pub(crate) const MUJOCO: Vocabulary = Vocabulary {
    attributes: &["model"],
    many: &[
        "compiler",
        "option",
        "size",
        "statistic",
        "visual",
        "default",
        "extension",
        "custom",
        "asset",
        "worldbody",
        "deformable",
        "contact",
        "tendon",
        "equality",
        "actuator",
        "sensor",
        "keyframe",
    ],
    ..NOTHING
};
pub(crate) const ATTACH: Vocabulary = Vocabulary { attributes: &["model", "body", "frame", "prefix"], ..NOTHING };
pub(crate) const COMPILER: Vocabulary = Vocabulary {
    attributes: &[
        "angle",
        "alignfree",
        "autolimits",
        "balanceinertia",
        "boundinertia",
        "boundmass",
        "assetdir",
        "coordinate",
        "eulerseq",
        "fitaabb",
        "inertiafromgeom",
        "inertiagrouprange",
        "meshdir",
        "settotalmass",
        "strippath",
    ],
    once: &["lengthrange"],
    listed: &[
        "conflict",
        "convexhull",
        "discardvisual",
        "exactmeshinertia",
        "fusestatic",
        "passthrough",
        "savecanonical",
        "savecompiled",
        "saveinertial",
        "texturedir",
        "usethread",
    ],
    ..NOTHING
};
pub(crate) const OPTION: Vocabulary = Vocabulary {
    attributes: &["gravity", "density", "viscosity", "actuatorgroupdisable"],
    once: &["flag"],
    listed: &[
        "apirate",
        "ccd_iterations",
        "ccd_tolerance",
        "collision",
        "cone",
        "impratio",
        "integrator",
        "iterations",
        "jacobian",
        "ls_iterations",
        "ls_tolerance",
        "magnetic",
        "mpr_iterations",
        "mpr_tolerance",
        "noslip_iterations",
        "noslip_tolerance",
        "o_friction",
        "o_margin",
        "o_solimp",
        "o_solref",
        "sdf_initpoints",
        "sdf_iterations",
        "sleep_tolerance",
        "solver",
        "timestep",
        "tolerance",
        "wind",
    ],
    ..NOTHING
};
pub(crate) const FLAG: Vocabulary = Vocabulary {
    attributes: &[
        "gravity",
        "damper",
        "spring",
        "passive",
        "frictionloss",
        "equality",
        "constraint",
        "actuation",
        "clampctrl",
    ],
    listed: &[
        "autoreset",
        "contact",
        "diagexact",
        "energy",
        "eulerdamp",
        "filterparent",
        "fwdinv",
        "invdiscrete",
        "ipc",
        "island",
        "limit",
        "midphase",
        "multiccd",
        "nativeccd",
        "override",
        "refsafe",
        "sensor",
        "sensornoise",
        "sleep",
        "speculative",
        "warmstart",
    ],
    ..NOTHING
};
/// Children of a default class besides further classes.
pub(crate) const ACTUATORS: [&str; 14] = [
    "general",
    "motor",
    "position",
    "velocity",
    "intvelocity",
    "orientation",
    "pid",
    "damper",
    "cylinder",
    "muscle",
    "adhesion",
    "dcmotor",
    "plugin",
    "actuator",
];
pub(crate) const DEFAULT: Vocabulary = Vocabulary {
    attributes: &["class"],
    many: &[
        "default",
        "mesh",
        "texture",
        "material",
        "joint",
        "geom",
        "site",
        "camera",
        "light",
        "pair",
        "equality",
        "tendon",
        "general",
        "motor",
        "position",
        "velocity",
        "intvelocity",
        "orientation",
        "pid",
        "damper",
        "cylinder",
        "muscle",
        "adhesion",
        "dcmotor",
    ],
    ..NOTHING
};
const INSIDE: [&str; 10] =
    ["joint", "geom", "site", "body", "frame", "camera", "light", "replicate", "attach", "composite"];
pub(crate) const WORLD: Vocabulary = Vocabulary {
    many: &INSIDE,
    silent: &["flexcomp", "plugin"],
    attributes: BODY.attributes,
    listed: BODY.listed,
    ..NOTHING
};
pub(crate) const BODY: Vocabulary = Vocabulary {
    attributes: &["name", "pos", "quat", "axisangle", "euler", "xyaxes", "zaxis", "childclass", "mocap", "gravcomp"],
    once: &["inertial", "freejoint"],
    many: &INSIDE,
    silent: &["flexcomp", "plugin"],
    listed: &["user", "sleep", "simple", "fuse"],
};
pub(crate) const FRAME: Vocabulary = Vocabulary {
    attributes: &["name", "pos", "quat", "axisangle", "euler", "xyaxes", "zaxis", "childclass"],
    many: &INSIDE,
    silent: &["flexcomp"],
    ..NOTHING
};
pub(crate) const REPLICATE: Vocabulary = Vocabulary {
    attributes: &["count", "offset", "euler", "sep", "childclass"],
    many: &INSIDE,
    silent: &["flexcomp"],
    ..NOTHING
};
pub(crate) const INERTIAL: Vocabulary = Vocabulary {
    attributes: &["pos", "quat", "axisangle", "euler", "xyaxes", "zaxis", "mass", "diaginertia", "fullinertia"],
    ..NOTHING
};
pub(crate) const FREE_JOINT: Vocabulary = Vocabulary { attributes: &["name", "align"], listed: &["group"], ..NOTHING };
pub(crate) const JOINT: Vocabulary = Vocabulary {
    attributes: &[
        "name",
        "class",
        "type",
        "pos",
        "axis",
        "range",
        "limited",
        "ref",
        "armature",
        "damping",
        "frictionloss",
        "stiffness",
        "springref",
        "springyield",
        "springdamper",
        "actuatorfrclimited",
        "actuatorfrcrange",
    ],
    listed: &[
        "actuatorgravcomp",
        "group",
        "margin",
        "solimpfriction",
        "solimplimit",
        "solreffriction",
        "solreflimit",
        "solimp",
        "solref",
        "user",
    ],
    ..NOTHING
};
pub(crate) const GEOM: Vocabulary = Vocabulary {
    attributes: &[
        "name",
        "class",
        "type",
        "size",
        "fromto",
        "pos",
        "quat",
        "axisangle",
        "euler",
        "xyaxes",
        "zaxis",
        "mass",
        "density",
        "mesh",
        "fitscale",
        "group",
        "shellinertia",
    ],
    listed: &[
        "adhesion",
        "castshadow",
        "conaffinity",
        "condim",
        "contype",
        "fluidcoef",
        "fluidshape",
        "friction",
        "gap",
        "hfield",
        "margin",
        "material",
        "priority",
        "rgba",
        "solimp",
        "solmix",
        "solref",
        "surfacevel",
        "user",
    ],
    silent: &["plugin"],
    ..NOTHING
};
pub(crate) const SITE: Vocabulary = Vocabulary {
    attributes: &["name", "class", "pos", "quat", "axisangle", "euler", "xyaxes", "zaxis", "fromto"],
    listed: &["group", "material", "mesh", "rgba", "size", "type", "user"],
    ..NOTHING
};
pub(crate) const EQUALITY: Vocabulary = Vocabulary {
    many: &["connect", "weld", "joint", "tendon", "flex", "flexvert", "flexstrain", "distance"],
    ..NOTHING
};
pub(crate) const COUPLING: Vocabulary = Vocabulary {
    attributes: &["name", "class", "active", "joint1", "joint2", "polycoef"],
    listed: &["solimp", "solref"],
    ..NOTHING
};
pub(crate) const TENDON_COUPLING: Vocabulary = Vocabulary {
    attributes: &["name", "class", "active", "tendon1", "tendon2", "polycoef"],
    listed: &["solimp", "solref"],
    ..NOTHING
};
pub(crate) const CONNECT: Vocabulary = Vocabulary {
    attributes: &["name", "class", "active", "body1", "body2", "anchor", "site1", "site2"],
    listed: &["solimp", "solref"],
    ..NOTHING
};
pub(crate) const WELD: Vocabulary = Vocabulary {
    attributes: &["name", "class", "active", "body1", "body2", "anchor", "relpose", "site1", "site2", "torquescale"],
    listed: &["solimp", "solref"],
    ..NOTHING
};
pub(crate) const TENDONS: Vocabulary = Vocabulary { many: &["spatial", "fixed"], ..NOTHING };
pub(crate) const TENDON: Vocabulary = Vocabulary {
    attributes: &["name", "class", "stiffness", "damping", "frictionloss", "armature", "limited", "range"],
    silent: &[
        "actuatorfrclimited",
        "actuatorfrcrange",
        "group",
        "margin",
        "material",
        "rgba",
        "solimpfriction",
        "solimplimit",
        "solreffriction",
        "solreflimit",
        "springlength",
        "springyield",
        "user",
        "width",
        "site",
        "geom",
        "pulley",
        "joint",
    ],
    ..NOTHING
};
pub(crate) const KEYFRAME: Vocabulary = Vocabulary { many: &["key"], ..NOTHING };
pub(crate) const KEY: Vocabulary = Vocabulary {
    attributes: &["name", "time", "qpos", "qvel"],
    listed: &["act", "ctrl", "mpos", "mquat", "plastic"],
    ..NOTHING
};
/// Attributes of an actuator that are read in addition to its law, and kept of its default class.
pub(crate) const ACTUATOR: Vocabulary = Vocabulary {
    attributes: &[
        "class",
        "armature",
        "damping",
        "gear",
        "joint",
        "tendon",
        "ctrllimited",
        "ctrlrange",
        "forcelimited",
        "forcerange",
        "inheritrange",
        "delay",
        "group",
    ],
    ..NOTHING
};

/// Attributes of a default class that only shapes use.
pub(crate) const LOOKS: [&str; 12] = [
    "rgba",
    "material",
    "contype",
    "conaffinity",
    "friction",
    "condim",
    "priority",
    "margin",
    "gap",
    "solref",
    "solimp",
    "solmix",
];
