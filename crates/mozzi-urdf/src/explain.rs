//! What each code means, and how to mend what it says.

use crate::mjcf;
use crate::spelling::nearest;

/// A code, without `mozzi::urdf::` or `mozzi::mjcf::`; what it means; how to mend it.
pub(crate) type Entry = (&'static str, &'static str, &'static str);

#[rustfmt::skip] // a code in three lines
const CODES: [Entry; 58] = [
    ("circular_mimic",
        "A joint that follows another (mimic) follows, over one or more steps, itself. Its position is then defined by nothing.",
        "let one of the joints follow none"),
    ("continuous_limits",
        "A continuous joint turns without end; its lower and upper bounds mean nothing and are ignored.",
        "a joint with bounds is of type `revolute`"),
    ("contradictory_limits",
        "A joint follows another, and no position of the other keeps both within their limits. mozzi computes the coupling as given; limits do not enter the dynamics.",
        "check multiplier and offset of the mimic, and the limits of both joints"),
    ("decimal_comma",
        "A number contains a comma. Numbers have a decimal point, and the numbers of a vector are separated by spaces.",
        "numbers have a decimal point, and spaces between them: `0.5`, not `0,5`"),
    ("degrees",
        "An angle is a whole number beyond two turns, as angles in degrees are. Angles are in radians; it is computed as given.",
        "angles are in radians: 90 degrees are 1.5708"),
    ("document_type",
        "The file declares a document type. Its entities could expand without bound or read other files, so such files are refused. URDF needs no document type.",
        "remove the declaration"),
    ("duplicate_element",
        "An element stands twice where it may stand once. Other readers take the first or the last, so they read different robots.",
        "keep the one that is meant"),
    ("duplicate_name",
        "Two links, or two joints, have the same name, so that a reference to it is ambiguous.",
        "rename one of them"),
    ("empty",
        "The file has no content.",
        "is it the right file, and was it written to its end?"),
    ("empty_name",
        "A link or joint has the empty name.",
        "give it a name that no other has"),
    ("fixed_mimic",
        "A fixed joint follows another joint (mimic). It does not move, so this has no effect.",
        "was the joint meant to move? Otherwise remove the <mimic>"),
    ("fixed_source",
        "A joint follows a fixed joint, which never moves.",
        "follow a joint that moves, or make this one fixed too"),
    ("ignored_property",
        "A planar or floating joint has limits, damping or friction. URDF has one number for them, but such a joint both slides and turns; what the number would mean is not said. It is ignored.",
        "remove it, or build the joint from joints of one freedom, each with its own"),
    ("implausible_inertia",
        "The moments of inertia are far too large for the mass: the radius of gyration is more than 10 m, and more than ten times the longest distance in the robot. It is computed as given.",
        "moments are in kg m²: those in kg mm² are a million times larger"),
    ("implausible_length",
        "A joint, or a centre of mass, is more than 50 m from the frame that it is given in. It is computed as given. Said once, of the farthest.",
        "lengths are in metres: 300 mm are 0.3"),
    ("implausible_mass",
        "A mass of more than 5 kg is so close to its centre of mass that no matter is so dense, judged by the moments of inertia; or there are moments without a mass. It is computed as given.",
        "masses are in kilograms, moments in kg m²; a body that has one has the other"),
    ("indefinite_inertia",
        "The inertia of a rigid body has a negative principal moment about its centre of mass: turning about that axis would have a negative kinetic energy, and forward dynamics would mean nothing. It is judged by the whole body of links that are fixed to each other. Usual reasons: a wrong sign of ixy, ixz or iyz, or moments given about the link's origin and not about the centre of mass.",
        "such a body would gain speed by being braked: check the signs of ixy, ixz, iyz and that the moments are about the centre of mass; the lenient policy takes the nearest physical inertia instead"),
    ("long_name",
        "A name is longer than 256 bytes.",
        "choose a shorter one; names are repeated in every message"),
    ("loop_closure",
        "A link is the child of two joints, or a joint is said to close a loop. mozzi computes trees.",
        "cut the loop by removing one of its joints, if that is what you want to compute"),
    ("massless_leaf",
        "The last link of a branch moves by a joint but has no inertia about its axis. Inverse dynamics is fine; forward dynamics would divide by zero, and answers with an error that names the joint.",
        "give the link its mass and inertia, or make the joint fixed"),
    ("mimic_of_several_axes",
        "A joint follows a ball or a free joint, or one of these follows another. They have several positions, and what would be followed is not said.",
        "let joints of one axis follow each other"),
    ("missing_attribute",
        "An attribute that has to be there is not. Nothing is assumed in its place.",
        "write it, with its value"),
    ("missing_element",
        "An element that has to be there is not: the parent and the child of a joint, the mass and the inertia of an inertial.",
        "write it, with its value"),
    ("missing_limit",
        "URDF demands a limit with lower, upper, effort and velocity of revolute and prismatic joints. Without lower and upper the joint is taken as unlimited; of the two, one that is missing is 0, URDF's default; without effort or velocity these are unlimited. Limits do not enter the dynamics.",
        "write the limit; a joint that turns freely is of type `continuous`"),
    ("misspelled_attribute",
        "An attribute that URDF does not know is one slip away from one that it knows. Ignored, the value meant would be lost in silence.",
        "correct the name"),
    ("misspelled_element",
        "An element that URDF does not know is one slip away from one that it knows. Ignored, what it says would be lost in silence.",
        "correct the name"),
    ("negative_friction",
        "Damping, friction, armature and stiffness are at least 0; negative, they would drive the joint.",
        "write the size of it, without a sign: friction always brakes"),
    ("negative_limit",
        "The limits of velocity and effort are magnitudes, at least 0.",
        "write the size of it, without a sign: it holds in both directions"),
    ("negative_mass",
        "A mass is negative.",
        "masses are in kilograms, at least 0"),
    ("no_base",
        "Every link is the child of a joint, so the robot hangs on nothing.",
        "one of the joints has the wrong child, or is one too many"),
    ("no_links",
        "The robot has no links.",
        "is it the right file? A robot has at least one <link name=\"…\"/>"),
    ("non_unit_axis",
        "The axis of a joint is not of length 1. Only its direction is used: the joint's position stays in radians or metres. If the speed was meant to be scaled: that is a mimic joint's multiplier.",
        "only its direction is used: the joint's position stays in radians or metres"),
    ("not_a_number",
        "A text that should be a number is none. The whole text has to be one: sign, digits, decimal point, exponent.",
        "write digits alone, such as `0.5` or `5e-1`"),
    ("not_finite",
        "A number is not finite, or becomes so when the inertia is computed from it.",
        "write a finite number; for no limit, leave the limit out"),
    ("not_utf8",
        "The file is not encoded as UTF-8.",
        "save the file as UTF-8"),
    ("repaired_inertia",
        "Under the lenient policy, an inertia that no body can have was replaced by the nearest that a body can have.",
        "the lenient policy repairs this; mend the file to be sure of what is computed"),
    ("reversed_limits",
        "The lower limit of a joint is above the upper one.",
        "exchange `lower` and `upper`"),
    ("self_parent",
        "A joint's parent and child are the same link.",
        "name the link that carries the joint as parent, the one that it moves as child"),
    ("several_bases",
        "Several links are no joint's child. One of them is the base; to the others no joint leads.",
        "add a joint whose child is this link (of type `fixed` if it does not move), or remove the link"),
    ("stray_text",
        "Text stands between elements. URDF keeps its values in attributes; the text is ignored.",
        "remove it, or put it into a comment <!-- -->"),
    ("syntax",
        "The file is not well-formed XML. Only the first such error is reported.",
        "the place is where the text stops making sense; the slip may stand just before it"),
    ("too_deep",
        "Elements are nested deeper than 256. No robot needs this; such files are refused to bound time and memory.",
        "links and joints all stand directly in <robot>: is a closing tag missing again and again?"),
    ("too_large",
        "The file is larger than 64 MiB or has more than two million elements and texts. Such files are refused to bound time and memory.",
        "is it the right file? Meshes are kept in files of their own"),
    ("too_large_number",
        "A number is beyond the range of double precision.",
        "check its exponent"),
    ("too_many_attributes",
        "An element has more than 256 attributes. No robot needs this; such files are refused to bound time and memory.",
        "is it the right file?"),
    ("too_many_namespaces",
        "More than 64 namespaces hold at one place, or more than 4096 are declared. No robot needs this; such files are refused to bound time and memory.",
        "declare each namespace once, on the <robot>"),
    ("unknown_attribute",
        "An attribute is not of URDF, and near no word of it. It is ignored; said once per kind.",
        "remove it, or give it the prefix of a namespace of its own"),
    ("unknown_element",
        "An element is not of URDF, nor a known extension, and near no word of it. It is ignored; said once per kind.",
        "remove it, or give it the prefix of a namespace of its own"),
    ("unknown_joint",
        "A joint follows a joint that does not exist. The coupling would be lost in silence, so the file is refused.",
        "write the joint's name as it stands in its own `name`"),
    ("unknown_joint_type",
        "The type of a joint is not one of revolute, continuous, prismatic, fixed, planar and floating.",
        "`revolute` turns between bounds, `continuous` without, `prismatic` slides, `fixed` does not move, `planar` slides and turns in a plane, `floating` frees the base"),
    ("unknown_link",
        "A joint names a link that does not exist.",
        "write the link's name as it stands in its own `name`, or add the link"),
    ("unphysical_inertia",
        "The inertia is not that of a rigid body: of the principal moments about the centre of mass, the largest exceeds the sum of the others; or one is negative, while the body of links that are fixed to each other is sound. It is computed as given: the equations hold, of a body that cannot be built. Usual reasons: rounded digits, moments about another point, guessed numbers.",
        "it is computed as given; of a rigid body each principal moment is at most the sum of the other two: check the units, the signs, and that the moments are about the centre of mass"),
    ("unreachable_link",
        "A link hangs in a ring of joints that is not connected to the base.",
        "one of the joints of the ring has the wrong parent"),
    ("unsupported_joint",
        "A joint is a ball, of which URDF has no word and other readers know nothing, or a planar or floating joint is to follow another (mimic).",
        "MJCF and mozzi's JSON have balls; in URDF, three hinges with massless links between move as a ball does, away from the position where two of them line up"),
    ("wrong_count",
        "A vector has not as many numbers as it needs.",
        "numbers are separated by spaces: `0 0 0.5`"),
    ("wrong_root",
        "The root element of a URDF is <robot>.",
        "is it the right file? A URDF begins with <robot name=\"…\">"),
    ("xacro",
        "The file is a program for xacro, which writes a URDF when it is run: it has elements such as `<xacro:macro>`, or values such as `${mass}`. mozzi reads what xacro writes and does not run xacro itself: of the programs in Rust that do, each computes another number for some expressions, without a word. PyPI's xacro needs no ROS: `pip install xacro`, then `xacro robot.xacro name:=value > robot.urdf`. A file that says `$(find package)`, or includes one that does, needs ROS for that, or xacrodoc: `pip install xacrodoc`, then `xacrodoc robot.xacro name:=value --pkg-dir DIR -o robot.urdf`, DIR holding the folders of the packages.",
        "expand it first: `pip install xacro; xacro robot.xacro > robot.urdf`"),
    ("zero_axis",
        "The axis of a joint that moves has no direction.",
        "the axis of a joint is a unit vector in the joint's frame, such as `0 0 1`"),
];

/// A code of one language, or of either: URDF's if it is in both. MJCF shares those of URDF that mean the same in it.
fn entry(code: &str) -> Option<&'static Entry> {
    let look = |codes: &'static [Entry], short: &str| codes.iter().find(|(known, ..)| *known == short);
    match (code.strip_prefix("mozzi::mjcf::"), code.strip_prefix("mozzi::urdf::")) {
        (Some(short), _) => look(&mjcf::CODES, short).or_else(|| look(&CODES, short)),
        (_, Some(short)) => look(&CODES, short),
        _ => look(&CODES, code).or_else(|| look(&mjcf::CODES, code)),
    }
}

/// What a code such as `mozzi::urdf::zero_axis`, or `zero_axis`, means.
pub fn explain(code: &str) -> Option<&'static str> {
    entry(code).map(|&(_, meaning, _)| meaning)
}

/// How to mend what a code says; what a diagnostic's help says where its place says nothing more precise.
pub fn remedy(code: &str) -> Option<&'static str> {
    entry(code).map(|&(.., remedy)| remedy)
}

/// The code of either language that one which does not exist was probably meant to be.
///
/// ```
/// assert_eq!(mozzi_urdf::nearest_code("mozzi::urdf::zero-axes"), Some("zero_axis"));
/// ```
pub fn nearest_code(code: &str) -> Option<&'static str> {
    let short = code.rsplit("::").next().unwrap_or(code).replace('-', "_");
    nearest(&short, codes().chain(mjcf::codes()))
}

/// All codes of URDF, without `mozzi::urdf::`, in alphabetical order; those of MJCF are [`mjcf::codes`].
pub fn codes() -> impl Iterator<Item = &'static str> {
    let mut codes: Vec<&str> = CODES.iter().map(|&(code, ..)| code).collect();
    codes.sort_unstable();
    codes.into_iter()
}
