//! The meaning and remedy of each diagnostic code.

use crate::mjcf::explain as mjcf;
use crate::report::spelling::nearest;
use crate::sdf;

/// A code, without `mozzi::urdf::`, `mozzi::mjcf::` or `mozzi::sdf::`; its meaning; its remedy.
pub(crate) type Entry = (&'static str, &'static str, &'static str);

#[rustfmt::skip] // code, meaning, remedy
const CODES: [Entry; 74] = [
    ("circular_mimic",
        "A mimic joint follows itself, directly or over other mimic joints. Its position is then undefined.",
        "remove one of the <mimic> elements"),
    ("continuous_limits",
        "A continuous joint turns without bounds; its lower and upper limits are ignored.",
        "a joint with bounds is of type `revolute`"),
    ("contradictory_attribute",
        "An inertia has an entry on both sides of its diagonal, such as `ixy` and `iyx`, with different values. The \
         matrix is symmetric, so one of them is wrong. Or two attributes exclude each other, such as `body` and \
         `frame` of `<attach>`.",
        "keep the right one, under the name that URDF defines: `ixy`, `ixz`, `iyz`"),
    ("contradictory_limits",
        "A mimic joint and its source joint have limits that no position satisfies together. mozzi computes the \
         coupling as given; limits do not enter the dynamics.",
        "check multiplier and offset of the mimic, and the limits of both joints"),
    ("decimal_comma",
        "A number contains a comma. Numbers have a decimal point, and the numbers of a vector are separated by spaces.",
        "write a decimal point, and spaces between numbers: `0.5`, not `0,5`"),
    ("degrees",
        "An angle is a whole number beyond two turns, which suggests degrees. Angles are in radians; the number \
         is used as given.",
        "angles are in radians: 90 degrees are 1.5708"),
    ("document_type",
        "The file declares a document type. Its entities could expand without bound or read other files, so the \
         file is refused. URDF needs no document type.",
        "remove the declaration"),
    ("duplicate_element",
        "An element occurs twice but is allowed once. Other readers take the first or the last, and so read \
         different robots.",
        "keep one of them"),
    ("duplicate_name",
        "Two links, or two joints, have the same name, so that a reference to it is ambiguous.",
        "rename one of them"),
    ("empty",
        "The file has no content.",
        "check that this is the right file and that it was written completely"),
    ("empty_name",
        "A link or joint has the empty name.",
        "give it a unique name"),
    ("fixed_mimic",
        "A fixed joint is declared as a mimic joint. It does not move, so the <mimic> has no effect.",
        "remove the <mimic>, or change the joint's type if it should move"),
    ("fixed_source",
        "A mimic joint follows a fixed joint, which never moves.",
        "follow a joint that moves, or make this joint fixed, too"),
    ("ignored_force",
        "Something acts on the robot that mozzi does not compute: a spring, a bushing, a tendon, a \
         controller in Drake's words; gravity that is switched off, or a spring, in Gazebo's settings; gravity, a \
         fluid or changed masses in MuJoCo's. The robot is computed without it.",
        "add its effect to the joint torques or applied wrenches; or remove it"),
    ("ignored_limit",
        "A limit that nothing here uses: of jerk; or of acceleration in a URDF of a version before 1.2, in which \
         urdfdom ignores it, too.",
        "remove it; or declare the version, <robot version=\"1.2\">"),
    ("ignored_property",
        "A planar or floating joint has limits, damping or friction. URDF has one number for them, but such a \
         joint both slides and turns, and URDF does not define which of the two is meant. Likewise limits and \
         friction of Drake's ball and universal joints; and rotors of transmissions (`drake:rotor_inertia`, \
         `motorInertia`) where Drake has none: in a transmission that is not simple, on a joint that has not one axis, or \
         (Drake's) whose effort limit is 0. The property is ignored.",
        "remove it, or build the joint from joints of one axis, each with its own property"),
    ("ignored_quaternion",
        "An origin has a quaternion, `quat_xyzw`, which URDF defines from version 1.1 on. The file declares an \
         earlier version, or none, which means 1.0: the quaternion is ignored, as urdfdom does, so the orientation \
         is that of `rpy`, or none.",
        "declare the version, <robot version=\"1.1\">, or write `rpy`"),
    ("implausible_inertia",
        "The moments of inertia are far too large for the mass: the radius of gyration is more than 10 m, and \
         more than ten times the longest distance between joints. The numbers are used as given.",
        "moments are in kg m²: those in kg mm² are a million times larger"),
    ("implausible_length",
        "A joint or a centre of mass is more than 50 m from the origin of the frame in which it is given. The \
         numbers are used as given. Only the farthest one is reported.",
        "lengths are in metres: 300 mm are 0.3"),
    ("implausible_mass",
        "A mass of more than 5 kg has moments of inertia so small that its density would be higher than that of \
         any material; or there are moments without a mass. The numbers are used as given.",
        "masses are in kilograms, moments in kg m²; a body needs both or neither"),
    ("indefinite_inertia",
        "The inertia of a rigid body has a negative principal moment about its centre of mass. Rotation about \
         that axis would have a negative kinetic energy, and forward dynamics would be meaningless. All links \
         that are fixed to each other are judged as one body. Usual reasons: a wrong sign of ixy, ixz or iyz, or \
         moments about the link's origin instead of the centre of mass.",
        "check the signs of ixy, ixz, iyz and that the moments are about the centre of mass; the lenient policy \
         uses the nearest physical inertia instead"),
    ("late_declaration",
        "There are blank lines, or a byte order mark, before the XML declaration. XML requires it at the beginning of \
         the file; other readers of robots accept it anywhere, and nothing is lost.",
        "remove what is before `<?xml`"),
    ("long_name",
        "A name is longer than 256 bytes.",
        "choose a shorter name; names are repeated in every message"),
    ("loop_closure",
        "A link is the child of two joints, or a joint closes a loop. The joints of a robot form a tree; constraints \
         close its loops.",
        "cut the loop at one joint, and close it by a constraint: <drake:ball_constraint>, or `--constraints FILE`"),
    ("massless_leaf",
        "The last link of a branch moves but has no inertia about its joint's axis. Inverse dynamics works; \
         forward dynamics would divide by zero and returns an error that names the joint.",
        "give the link its mass and inertia, or make the joint fixed"),
    ("mimic_of_several_axes",
        "A mimic joint, or the joint that it follows, is a ball or a free joint. These have several positions, \
         and the coupling is not defined.",
        "couple joints of one axis only"),
    ("missing_attribute",
        "A required attribute is missing. mozzi assumes no value.",
        "add the attribute with its value"),
    ("missing_element",
        "A required element is missing: parent and child of a joint, mass and inertia of an inertial.",
        "add the element with its value"),
    ("missing_limit",
        "URDF requires a limit with lower, upper, effort and velocity for revolute and prismatic joints. Without \
         lower and upper the joint is unlimited; if one of them is missing it is 0, URDF's default; missing \
         effort or velocity limits are unlimited. Limits do not enter the dynamics.",
        "add the limit; a joint that turns freely is of type `continuous`"),
    ("misspelled_attribute",
        "An unknown attribute differs from a URDF attribute by a typing error. Ignoring it would silently lose \
         its value, so the file is refused.",
        "correct the name"),
    ("misspelled_element",
        "An unknown element differs from a URDF element by a typing error. Ignoring it would silently lose its \
         content, so the file is refused.",
        "correct the name"),
    ("negative_friction",
        "Damping, friction, armature and stiffness must be at least 0; negative values would drive the joint.",
        "write the magnitude, without a sign: friction always opposes motion"),
    ("negative_limit",
        "Velocity and effort limits are magnitudes and must be at least 0.",
        "write the magnitude, without a sign: it holds in both directions"),
    ("negative_mass",
        "A mass is negative.",
        "write a mass in kilograms, at least 0"),
    ("no_base",
        "Every link is the child of a joint, so the robot has no base.",
        "correct the child of one joint, or remove a joint"),
    ("no_links",
        "The robot has no links.",
        "check that this is the right file; a robot has at least one <link name=\"…\"/>"),
    ("non_unit_axis",
        "The axis of a joint does not have length 1. Only its direction is used: the joint's position stays in \
         radians or metres. To scale a joint's motion, use the multiplier of a mimic joint.",
        "only its direction is used: the joint's position stays in radians or metres"),
    ("non_unit_quaternion",
        "The length of a quaternion differs from 1 by more than 0.001. It is normalized.",
        "write a unit quaternion (x, y, z, w)"),
    ("not_a_number",
        "A value is not a number. The whole text must be a number: sign, digits, decimal point, exponent.",
        "write digits only, such as `0.5` or `5e-1`"),
    ("not_finite",
        "A number is infinite or NaN, or the inertia computed from it is.",
        "write a finite number; for no limit, omit the limit"),
    ("not_utf8",
        "The file is not encoded as UTF-8.",
        "save the file as UTF-8"),
    ("redundant_attribute",
        "An unknown attribute resembles one that the element has as well, such as `k_velocity` next to `velocity`, or \
         `iyx` next to `ixy`. It is ignored; the known one is used.",
        "remove it, or correct its name"),
    ("repaired_inertia",
        "Under the lenient policy, an unphysical inertia was replaced by the nearest physical one.",
        "the lenient policy repairs this; correct the file to be sure of the numbers"),
    ("reversed_limits",
        "The lower limit of a joint is above the upper one. Limits do not enter the dynamics; the joint is treated as \
         unlimited.",
        "exchange `lower` and `upper`"),
    ("self_constraint",
        "A constraint is between a frame and itself, between two frames that are fixed to each other, or between a joint and \
         itself.",
        "constrain two frames, or joints, that can move relative to each other"),
    ("self_parent",
        "A joint's parent and child are the same link.",
        "the parent is the link that carries the joint, the child the link that it moves"),
    ("several_bases",
        "Several links are not the child of any joint. One of them is the base; no joint leads to the others.",
        "add a joint whose child is this link (of type `fixed` if it does not move), or remove the link"),
    ("several_orientations",
        "An origin has both `rpy` and `quat_xyzw`.",
        "keep one of them"),
    ("stray_text",
        "There is text between elements. URDF keeps its values in attributes; the text is ignored.",
        "remove it, or put it into a comment <!-- -->"),
    ("syntax",
        "The file is not well-formed XML. Only the first such error is reported.",
        "the error is at this place or just before it"),
    ("too_deep",
        "Elements are nested deeper than 256 levels. No robot needs this; the file is refused to bound time and \
         memory.",
        "links and joints are direct children of <robot>: check for missing closing tags"),
    ("too_large",
        "The file is larger than 64 MiB or has more than two million elements and texts. It is refused to bound \
         time and memory.",
        "check that this is the right file; meshes are separate files"),
    ("too_large_number",
        "A number is beyond the range of double precision.",
        "check its exponent"),
    ("too_many_attributes",
        "An element has more than 256 attributes. No robot needs this; the file is refused to bound time and memory.",
        "check that this is the right file"),
    ("too_many_namespaces",
        "More than 64 namespaces are in scope at one place, or more than 4096 are declared. No robot needs this; \
         the file is refused to bound time and memory.",
        "declare each namespace once, on the <robot>"),
    ("turned_inertia",
        "The moments of inertia of a link are those of its only collision shape, a box, cylinder or capsule, about other \
         axes. A usual reason: the shape was turned by its <origin>, such as a wheel's cylinder, and the inertia was not. \
         The numbers are used as given.",
        "turn the inertia, too: exchange its moments, or give <inertial> the orientation of the shape's <origin>"),
    ("undeclared_prefix",
        "A prefix of a namespace is used but not declared. Other readers of robots accept this; the name is read as if \
         the prefix were declared.",
        "declare it on the root: <robot xmlns:PREFIX=\"…\">"),
    ("unknown_attribute",
        "URDF does not define this attribute, nor one with a similar name. It is ignored; reported once per kind.",
        "remove it, or give it a namespace prefix of its own"),
    ("unknown_element",
        "Neither URDF nor a known extension defines this element, nor one with a similar name. It is ignored; \
         reported once per kind.",
        "remove it, or give it a namespace prefix of its own"),
    ("unknown_frame",
        "A constraint names a link or frame that does not exist. In MJCF: a body or site.",
        "use the frame's name, with the same spelling"),
    ("unknown_joint",
        "A mimic joint follows a joint that does not exist. Ignoring the coupling would give wrong results, so \
         the file is refused.",
        "use the source joint's `name`, with the same spelling"),
    ("unknown_joint_type",
        "The type of a joint is not one of revolute, continuous, prismatic, fixed, planar and floating.",
        "`revolute` turns between bounds, `continuous` without, `prismatic` slides, `fixed` does not move, \
         `planar` slides and turns in a plane, `floating` frees the base"),
    ("unknown_link",
        "A joint names a link that does not exist.",
        "use the link's `name`, with the same spelling, or add the link"),
    ("unphysical_inertia",
        "No rigid body has this inertia: the largest principal moment about the centre of mass exceeds the sum of \
         the other two; or one is negative, while the body of all links fixed to each other is positive definite. \
         The numbers are used as given: the equations of motion are sound, but no such body can be built. Usual \
         reasons: rounded digits, moments about another point, guessed numbers.",
        "the numbers are used as given; in a rigid body each principal moment is at most the sum of the other \
         two: check the units, the signs, and that the moments are about the centre of mass"),
    ("unreachable_link",
        "A link is part of a ring of joints that is not connected to the base.",
        "correct the parent of one joint of the ring"),
    ("unsupported_constraint",
        "The robot has a <constraint>. It is a proposal for URDF that no version defines; ignoring it would give wrong \
         results, so the file is refused.",
        "write a <drake:ball_constraint>, or the constraints in a file of their own (`--constraints FILE`)"),
    ("unsupported_joint",
        "A joint is a ball, which URDF does not define and other readers do not support; or a planar or floating \
         joint is a mimic joint.",
        "MJCF and mozzi's JSON support balls; in URDF, three hinges with massless links between them move like a \
         ball, except where two of their axes align"),
    ("unsupported_version",
        "The version of a URDF is 1.0, 1.1 or 1.2. Version 1.1 adds quaternions (`quat_xyzw` of <origin>) and \
         capsules; 1.2 adds limits of acceleration, deceleration and jerk, and makes `effort` and `velocity` optional. \
         urdfdom refuses other versions, and texts that are not of the form x.y.",
        "write `version=\"1.0\"`, `1.1` or `1.2`, or omit it, which means 1.0"),
    ("wrong_count",
        "A vector has too few or too many numbers.",
        "separate numbers by spaces: `0 0 0.5`"),
    ("wrong_root",
        "The root element of a URDF must be <robot>, that of MJCF <mujoco>; that of SDFormat <sdf>; or the file is of another format, such as USD \
         or JSON.",
        "check that this is the right file; a URDF begins with <robot name=\"…\">"),
    ("xacro",
        "A xacro file cannot be expanded: a name is not defined, a macro is called with other parameters than it has, an \
         expression is not one of the supported part of Python, or the expansion exceeds a bound. The place is in the \
         file that was written, followed by the calls of macros that lead there. A file is expanded if its name ends \
         in .xacro, or if its root declares xmlns:xacro; `--xacro-arg name:=value` gives an argument, `--package \
         name=folder` the folder of `$(find name)`. docs/xacro.md has the language and the bounds.",
        "correct the file at this place; `mozzi xacro robot.xacro name:=value -o robot.urdf` shows the expansion"),
    ("xacro_warning",
        "A message of a xacro file (`xacro.warning`), or a word in it that has no effect, such as an attribute that \
         xacro does not define.",
        "correct the word, or remove it"),
    ("zero_axis",
        "The axis of a moving joint, or a quaternion, has length 0.",
        "the axis of a joint is a unit vector in the joint's frame, such as `0 0 1`; `0 0 0 1` is the quaternion of no \
         rotation"),
    ("zero_limits",
        "All numbers of a joint's <limit> are 0. CAD programs write this if nobody entered the limits. Limits do not \
         enter the dynamics, but a planner, or motors with limits, cannot move such a joint.",
        "write the joint's limits; a joint that turns freely is of type `continuous`, one that does not move `fixed`"),
];

/// A code of one language, or of any (URDF's if it is in several). The others share the URDF codes that have the same
/// meaning, SDFormat also MJCF's.
fn entry(code: &str) -> Option<&'static Entry> {
    let look = |codes: &'static [Entry], short: &str| codes.iter().find(|(known, ..)| *known == short);
    let [of_sdf, of_mjcf, of_urdf] = ["sdf", "mjcf", "urdf"].map(|dialect| {
        code.strip_prefix("mozzi::")
            .and_then(|rest| rest.strip_prefix(dialect))
            .and_then(|rest| rest.strip_prefix("::"))
    });
    let first = |short: &str, lists: &[&'static [Entry]]| lists.iter().find_map(|codes| look(codes, short));
    match (of_sdf, of_mjcf, of_urdf) {
        (Some(short), ..) => first(short, &[&sdf::CODES, &CODES, &mjcf::CODES]),
        (_, Some(short), _) => first(short, &[&mjcf::CODES, &CODES]),
        (.., Some(short)) => first(short, &[&CODES]),
        _ => first(code, &[&CODES, &mjcf::CODES, &sdf::CODES]),
    }
}

/// The meaning of a code such as `mozzi::urdf::zero_axis` or `zero_axis`.
pub fn explain(code: &str) -> Option<&'static str> {
    entry(code).map(|&(_, meaning, _)| meaning)
}

/// The remedy of a code; the help of a diagnostic that has no more specific one.
pub fn remedy(code: &str) -> Option<&'static str> {
    entry(code).map(|&(.., remedy)| remedy)
}

/// The code of any language that is most similar to an unknown one.
///
/// ```
/// assert_eq!(mozzi_urdf::nearest_code("mozzi::urdf::zero-axes"), Some("zero_axis"));
/// ```
pub fn nearest_code(code: &str) -> Option<&'static str> {
    let short = code.rsplit("::").next().unwrap_or(code).replace('-', "_");
    nearest(&short, codes().chain(mjcf::codes()).chain(sdf::codes()))
}

/// All codes of URDF, without `mozzi::urdf::`, in alphabetical order; those of MJCF are
/// [`mjcf::codes`](crate::mjcf::codes), those of SDFormat [`sdf::codes`](crate::sdf::codes).
pub fn codes() -> impl Iterator<Item = &'static str> {
    let mut codes: Vec<&str> = CODES.iter().map(|&(code, ..)| code).collect();
    codes.sort_unstable();
    codes.into_iter()
}
