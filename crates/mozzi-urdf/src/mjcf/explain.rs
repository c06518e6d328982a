//! The meaning and remedy of the codes specific to MJCF.

use crate::report::explain::Entry;

#[rustfmt::skip] // code, meaning, remedy
pub(crate) const CODES: [Entry; 43] = [
    ("actuator_armature",
        "An actuator has an armature, but drives neither a joint nor a tendon to which it could be added. MuJoCo \
         refuses it, too.",
        "give it a `joint` or a `tendon`, or remove the armature"),
    ("circular_mimic",
        "Joints are coupled (equality) in a circle. Their positions are then undefined.",
        "remove one of the couplings"),
    ("constraint_of_several_axes",
        "An equality of joints includes a ball or a free joint, which do not have one position.",
        "couple joints of one axis only; `connect` and `weld` suit any joint"),
    ("contradictory_key",
        "A key gives a mimic joint (equality) a position or velocity that disagrees with the coupling. In mozzi \
         the coupling is rigid: the state has the numbers of the independent joints, and the coupling gives the \
         others. MuJoCo starts with the key's numbers, and its solver pulls the joints together.",
        "use the value that polycoef gives for the source joint's value"),
    ("contradictory_limits",
        "Two coupled joints (equality) have ranges that no position satisfies together. mozzi computes the \
         coupling as given; limits do not enter the dynamics.",
        "check polycoef, and the ranges of both joints"),
    ("duplicate_name",
        "Two bodies, joints, sites or default classes have the same name.",
        "rename one of them"),
    ("global_coordinates",
        "The compiler uses global coordinates, which MuJoCo dropped in 2.3.4. MuJoCo 2.3.3 can read such a file \
         and write it with local coordinates.",
        "save the model with MuJoCo 2.3.3 or older, which writes local coordinates"),
    ("ignored_attribute",
        "Attributes do not affect the dynamics of the tree: contacts, settings of MuJoCo's solver and compiler, \
         file names, groups, a key's numbers for actuators and mocap bodies, appearance. Also an actuator's force \
         range that is not symmetric. They are counted, not warned of; the strict policy accepts them.",
        "no action is needed; they concern contacts, appearance, files, or MuJoCo's solver"),
    ("ignored_element",
        "An element does not affect the dynamics of the tree: actuators (their torques are arguments), sensors, \
         contacts, appearance. It is counted once per kind, not warned of; the strict policy accepts it.",
        "no action is needed; the tree is read without it"),
    ("ignored_force",
        "MuJoCo would apply a force that mozzi does not compute: a nonlinear spring or damper, gravity \
         compensation, a fluid, a plugin. The mass matrix, Coriolis and gravity terms are right without it; \
         inverse and forward dynamics omit it. Reported once per kind.",
        "add its effect to the joint torques"),
    ("ignored_limit",
        "A tendon is limited. Like the limits of joints, its limits do not enter the dynamics; MuJoCo applies a force \
         beyond them. Reported once.",
        "add the force beyond the limit to the joint torques, if the motion reaches it"),
    ("ignored_mesh",
        "A body that does not move has a mesh of unknown mass. It does not affect the dynamics; its mass is taken \
         as 0. For the page: a mesh that has no file, because the model gives its vertices, is not drawn.",
        "no action is needed, unless you need the total mass"),
    ("include",
        "An included file cannot be read. Files are searched in the folder of the main file, then next to the file \
         that includes them.",
        "files are searched in the folder of the main file, then next to the file that includes them"),
    ("indefinite_inertia",
        "The inertia of a rigid body has a negative principal moment about its centre of mass. Rotation about \
         that axis would have a negative kinetic energy, and forward dynamics would be meaningless. All bodies \
         without a joint between them are judged as one body.",
        "check the signs, and that the moments are about the centre of mass; the lenient policy uses the nearest \
         physical inertia instead"),
    ("key_quaternion",
        "The length of a quaternion in the qpos of a key differs from 1 by more than 0.001. It is normalized, as \
         in MuJoCo; one of length 0 is (1, 0, 0, 0).",
        "write a unit quaternion (w, x, y, z); in the qpos of a free joint it follows the position"),
    ("long_value",
        "A value in a default class is longer than 256 bytes. No attribute needs this; the file is refused to \
         bound time.",
        "check that this is the right file"),
    ("massless_leaf",
        "The last body of a branch moves but has no inertia about its joint's axis. Inverse dynamics works; \
         forward dynamics would divide by zero and returns an error that names the joint.",
        "give the body an <inertial>, or a geom with a mass"),
    ("mesh_inertia",
        "A moving body has no <inertial>, and one of the geoms that define its inertia is a mesh whose inertia cannot be \
         computed: its file is missing or is no STL, OBJ or MSH, it bounds no volume, or a plugin makes it. MuJoCo can \
         compute the inertia and write it into the file (saveinertial).",
        "give the body an <inertial>, or the geom mass=\"0\""),
    ("mimic_of_several_axes",
        "A coupling includes a ball or a free joint. These have several positions, and the coupling is not defined.",
        "couple joints of one axis only"),
    ("misplaced_joint",
        "A joint is in the world, which does not move. It belongs in the body that it moves.",
        "move it into the body that it moves"),
    ("missing_attribute",
        "A required attribute is missing, or two attributes exclude each other.",
        "write exactly one of them"),
    ("missing_size",
        "A geom that defines its body's inertia has no size, or a size that is not above 0.",
        "write as many numbers above 0 as the shape needs"),
    ("negative_mass",
        "A mass or a density is negative.",
        "write masses in kilograms and densities in kg/m³, at least 0"),
    ("no_mass",
        "settotalmass scales all masses, but the bodies have no mass.",
        "give the bodies masses, or remove settotalmass"),
    ("renamed_site",
        "A site has the name of a body. MuJoCo keeps their names apart; in mozzi both are frames, so the site \
         gets another name.",
        "no action is needed; the site's new name combines both names"),
    ("repeated_include",
        "A file is included twice, or includes itself. MuJoCo refuses this, too.",
        "include each file once"),
    ("reversed_limits",
        "The lower end of a range is above its upper end. Limits do not enter the dynamics; the range is not used.",
        "exchange the two numbers"),
    ("rotor_of_several_axes",
        "A fixed tendon with an armature acts on a ball or a free joint, which do not have one position.",
        "let the tendon act on joints of one axis only"),
    ("several_orientations",
        "An orientation is given in two ways.",
        "keep one of them"),
    ("too_deep",
        "Elements are nested deeper than 256 levels. No robot needs this; the file is refused to bound time and \
         memory.",
        "check for missing closing tags"),
    ("too_many_constraints",
        "The equalities have more rows together than mozzi allows (a `weld` has six); each solution takes time and \
         memory by their square.",
        "remove equalities that repeat others, or lock joints instead"),
    ("too_many_keys",
        "The keys of a model have more than a million positions in total. No robot needs this; the file is \
         refused to bound memory.",
        "keep the keys that you use; store recorded motions in a table"),
    ("unclear_limit",
        "A joint has a range but no `limited`, and autolimits is off.",
        "write `limited`, true or false"),
    ("unknown_class",
        "An element names a default class that does not exist.",
        "use the `class` of a <default>, with the same spelling"),
    ("unknown_joint",
        "A coupling names a joint that does not exist.",
        "use the joint's `name`, with the same spelling"),
    ("unknown_word",
        "The value of an attribute is not one of its allowed keywords.",
        "write one of the allowed keywords"),
    ("unsupported_attribute",
        "An attribute requires something that mozzi does not compute and that would change its results.",
        "remove it, and write the resulting numbers instead"),
    ("unsupported_element",
        "An element requires something that mozzi does not compute or expand: flexible bodies, or copies of parts \
         of the tree; or it is a plane that joints move, which MuJoCo refuses, too.",
        "let MuJoCo expand or remove it, and save the model from there"),
    ("unsupported_equality",
        "An equality of spatial tendons or flexible bodies. Equalities of joints, bodies and fixed tendons are computed; \
         ignoring others would give wrong results, so the file is refused.",
        "remove it, or set active=\"false\", if you want to compute the robot without it"),
    ("unsupported_joint",
        "A free joint is inside the tree, or its body has other joints, too; or a ball is followed by a ball or a hinge; \
         or the joints of one body have more than six degrees of freedom. MuJoCo refuses these, too.",
        "put joints into bodies of their own; a ball and three slides in one body move like a free joint"),
    ("unsupported_tendon",
        "A tendon has a force of its own, or is spatial and has an armature: its effect then varies \
         with the joints. The armature of a fixed tendon is computed, as a rotor that several joints turn.",
        "remove it, if you want to compute the tree without it"),
    ("wrong_root",
        "The root element of an MJCF model must be <mujoco>.",
        "<mujocoinclude> is a part of a model: open the file that includes it"),
    ("zero_axis",
        "A direction or an orientation has length 0.",
        "write a vector with a length other than 0, such as `0 0 1`"),
];

/// The codes specific to MJCF, without `mozzi::mjcf::`, in alphabetical order.
pub fn codes() -> impl Iterator<Item = &'static str> {
    CODES.iter().map(|&(code, ..)| code)
}
