//! What each code means, at more length.

/// Code, without `mozzi::urdf::`, and explanation.
const CODES: [(&str, &str); 53] = [
    (
        "circular_mimic",
        "A joint that follows another (mimic) follows, over one or more steps, itself. Its position is then defined by nothing. Let one of the joints follow none.",
    ),
    (
        "continuous_limits",
        "A continuous joint turns without end; its lower and upper bounds mean nothing and are ignored. A joint with bounds is of type revolute.",
    ),
    (
        "contradictory_limits",
        "A joint follows another, and no position of the other keeps both within their limits. Multiplier, offset or one of the limits is wrong. mozzi computes the coupling as given; limits do not enter the dynamics.",
    ),
    (
        "decimal_comma",
        "A number contains a comma. Numbers have a decimal point, and the numbers of a vector are separated by spaces.",
    ),
    (
        "document_type",
        "The file declares a document type. Its entities could expand without bound or read other files, so such files are refused. URDF needs no document type.",
    ),
    (
        "duplicate_element",
        "An element stands twice where it may stand once. Other readers take the first or the last, so they read different robots.",
    ),
    ("duplicate_name", "Two links, or two joints, have the same name, so that a reference to it is ambiguous."),
    ("empty", "The file has no content."),
    ("empty_name", "A link or joint has the empty name."),
    (
        "fixed_follower",
        "A fixed joint follows another joint (mimic). It does not move, so this has no effect; was the joint meant to move?",
    ),
    ("fixed_master", "A joint follows a fixed joint, which never moves."),
    (
        "indefinite_inertia",
        "The inertia of a rigid body has a negative principal moment about its centre of mass: turning about that axis would have a negative kinetic energy, and forward dynamics would mean nothing. It is judged by the whole body of links that are fixed to each other. Usual reasons: a wrong sign of ixy, ixz or iyz, or moments given about the link's origin and not about the centre of mass.",
    ),
    ("loop_closure", "A link is the child of two joints, or a joint is said to close a loop. mozzi computes trees."),
    (
        "massless_leaf",
        "The last link of a branch moves by a joint but has no inertia about its axis. Inverse dynamics is fine; forward dynamics would divide by zero, and answers with an error that names the joint.",
    ),
    ("missing_attribute", "An attribute that has to be there is not. Nothing is assumed in its place."),
    (
        "missing_element",
        "An element that has to be there is not: the parent and the child of a joint, the mass and the inertia of an inertial.",
    ),
    (
        "missing_limit",
        "URDF demands a limit with lower, upper, effort and velocity of revolute and prismatic joints. Without lower and upper the joint is taken as unlimited; of the two, one that is missing is 0, URDF's default; without effort or velocity these are unlimited. Limits do not enter the dynamics.",
    ),
    (
        "misspelled_attribute",
        "An attribute that URDF does not know is one slip away from one that it knows. Ignored, the value meant would be lost in silence.",
    ),
    (
        "misspelled_element",
        "An element that URDF does not know is one slip away from one that it knows. Ignored, what it says would be lost in silence.",
    ),
    ("negative_friction", "Damping, friction and armature are at least 0; negative, they would drive the joint."),
    ("negative_limit", "The limits of velocity and effort are magnitudes, at least 0."),
    ("negative_mass", "A mass is negative."),
    ("no_base", "Every link is the child of a joint, so the robot hangs on nothing."),
    ("no_links", "The robot has no links."),
    (
        "non_unit_axis",
        "The axis of a joint is not of length 1. Only its direction is used: the joint's position stays in radians or metres. Say if the speed was meant to be scaled: that is a mimic joint's multiplier.",
    ),
    (
        "not_a_number",
        "A text that should be a number is none. The whole text has to be one: sign, digits, decimal point, exponent.",
    ),
    (
        "not_finite",
        "A number is not finite, or becomes so when the inertia is computed from it. For `no limit`, leave the limit out.",
    ),
    ("not_utf8", "The file is not encoded as UTF-8."),
    ("reversed_limits", "The lower limit of a joint is above the upper one."),
    ("self_parent", "A joint's parent and child are the same link."),
    ("several_bases", "Several links are no joint's child. One of them is the base; to the others no joint leads."),
    ("stray_text", "Text stands between elements. URDF keeps its values in attributes; the text is ignored."),
    ("syntax", "The file is not well-formed XML. Only the first such error is reported."),
    (
        "too_deep",
        "Elements are nested deeper than 256. No robot needs this; such files are refused to bound time and memory.",
    ),
    (
        "too_large",
        "The file is larger than 64 MiB or has more than two million elements and texts. Such files are refused to bound time and memory.",
    ),
    ("too_large_number", "A number is beyond the range of double precision."),
    (
        "too_many_attributes",
        "An element has more than 256 attributes. No robot needs this; such files are refused to bound time and memory.",
    ),
    (
        "too_many_namespaces",
        "More than 64 namespaces hold at one place, or more than 4096 are declared. No robot needs this; such files are refused to bound time and memory.",
    ),
    ("unknown_attribute", "An attribute is not of URDF, and near no word of it. It is ignored; said once per kind."),
    (
        "unknown_element",
        "An element is not of URDF, nor a known extension, and near no word of it. It is ignored; said once per kind.",
    ),
    ("unknown_frame", "The end effector is named after a link or frame that does not exist."),
    (
        "unknown_joint",
        "A joint follows a joint that does not exist. The coupling would be lost in silence, so the file is refused.",
    ),
    ("unknown_joint_type", "The type of a joint is not one of revolute, continuous, prismatic and fixed."),
    ("unknown_link", "A joint names a link that does not exist."),
    (
        "unphysical_inertia",
        "The inertia is not that of a rigid body: of the principal moments about the centre of mass, the largest exceeds the sum of the others; or one is negative, while the body of links that are fixed to each other is sound. It is computed as given: the equations hold, of a body that cannot be built. Usual reasons: rounded digits, moments about another point, guessed numbers.",
    ),
    ("unreachable_link", "A link hangs in a ring of joints that is not connected to the base."),
    (
        "unsupported_joint",
        "Floating and planar joints have six and three freedoms. mozzi computes joints of one freedom, or none.",
    ),
    ("wrong_count", "A vector has not as many numbers as it needs."),
    ("wrong_root", "The root element of a URDF is <robot>."),
    ("xacro", "The file is a xacro file that was not expanded."),
    ("zero_axis", "The axis of a joint that moves has no direction."),
    (
        "repaired_inertia",
        "Under the lenient policy, an inertia that no body can have was replaced by the nearest that a body can have.",
    ),
    ("long_name", "A name is longer than 256 bytes."),
];

/// What a code such as `mozzi::urdf::zero_axis`, or `zero_axis`, means.
pub fn explain(code: &str) -> Option<&'static str> {
    let short = code.strip_prefix("mozzi::urdf::").unwrap_or(code);
    CODES.iter().find(|(known, _)| *known == short).map(|&(_, text)| text)
}

/// All codes, without `mozzi::urdf::`, in alphabetical order.
pub fn codes() -> impl Iterator<Item = &'static str> {
    let mut codes: Vec<&str> = CODES.iter().map(|&(code, _)| code).collect();
    codes.sort_unstable();
    codes.into_iter()
}
