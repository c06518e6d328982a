//! What each code means in MJCF, at more length, where URDF does not have it or means something else by it.

/// Code, without `mozzi::mjcf::`, and explanation.
pub(crate) const CODES: [(&str, &str); 27] = [
    (
        "actuator_armature",
        "An actuator has an inertia of its own, which MuJoCo adds to that of its joint, times the square of its gear. It would change the mass matrix, so it is not ignored. Give it as the joint's armature.",
    ),
    ("duplicate_name", "Two bodies, joints, sites or default classes have the same name."),
    (
        "global_coordinates",
        "The compiler is told that positions are global, a notation that MuJoCo gave up in 2.3.4. MuJoCo 2.3.3 can read such a file and write it with local coordinates.",
    ),
    (
        "ignored_element",
        "An element says nothing about the dynamics of the tree: actuators (their torques are arguments), sensors, contacts, keyframes, and what is for the eye only. Said once per kind; the strict policy lets it pass.",
    ),
    (
        "ignored_force",
        "MuJoCo would apply a force that mozzi does not compute: a spring, damping that is not linear, compensation of gravity, a fluid, a plugin. The mass matrix, Coriolis and gravity terms are right without it; inverse and forward dynamics leave it out. Add it to the joints' torques. Said once per kind.",
    ),
    (
        "ignored_mesh",
        "A body that no joint moves has a mesh, whose mass is not known. It enters no dynamics; its mass is taken as 0.",
    ),
    (
        "include",
        "A file that the model includes cannot be read. Files are searched in the folder of the main file, also those that are named in an included file.",
    ),
    ("loop_closure", "Two bodies are tied to each other, so that the bodies form a loop. mozzi computes trees."),
    (
        "mesh_inertia",
        "A body that moves has no <inertial>, and one of the geoms that its inertia is to be computed from is a mesh. mozzi reads no meshes. MuJoCo can compute the inertia and write it into the file (saveinertial).",
    ),
    ("misplaced_joint", "A joint stands in the world, which does not move. It belongs into the body that it moves."),
    ("missing_attribute", "An attribute that has to be there is not, or two that exclude each other are."),
    ("missing_size", "A geom that gives its body an inertia has no size, or one that is not above 0."),
    ("negative_mass", "A mass or a density is negative."),
    (
        "no_mass",
        "The compiler is told to scale all masses to a total, but the bodies have no mass that could be scaled.",
    ),
    (
        "renamed_site",
        "A site has the name of a body. In MuJoCo they are kept apart; here both are frames, and the site is called otherwise.",
    ),
    (
        "repeated_include",
        "A file is included twice, or includes itself. MuJoCo refuses this as well: an included file stands in a model once.",
    ),
    ("several_orientations", "An orientation is written in two ways. One of them is to be removed."),
    ("unclear_limit", "A joint has a range, but it is not said whether it is limited, and autolimits is switched off."),
    ("unknown_class", "An element names a default class that does not exist."),
    ("unknown_joint", "A coupling names a joint that does not exist."),
    ("unknown_word", "The value of an attribute is not one of the words that it can be."),
    (
        "unsupported_attribute",
        "An attribute asks for something that mozzi does not compute, and that would change what it computes.",
    ),
    (
        "unsupported_element",
        "An element asks for something that mozzi does not compute or expand: flexible bodies, or copies of parts of the tree.",
    ),
    (
        "unsupported_equality",
        "An equality is not a straight line between the positions of two joints. Only that is a follower; anything else would be lost in silence, so the file is refused.",
    ),
    (
        "unsupported_joint",
        "Free and ball joints have six and three freedoms. mozzi computes joints of one freedom, or none.",
    ),
    (
        "unsupported_tendon",
        "A tendon has a force, an inertia or limits of its own, and would act on several joints at once.",
    ),
    ("wrong_root", "The root element of a model in MJCF is <mujoco>."),
];
