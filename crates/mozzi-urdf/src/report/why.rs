//! The consequence of each diagnostic for the results: the number or the motion that would be wrong.

/// A code and its consequence; `mjcf::` or `sdf::` before a code where its consequence differs from URDF's.
#[rustfmt::skip]
const WHY: [(&str, &str); 116] = [
    ("actuator_armature",
        "The reflected inertia of a geared motor, gear² times that of its rotor, can exceed the link's own: 50² × \
         0.001 kg m² = 2.5 kg m². If it acts on no joint, it is missing from M."),
    ("circular_frames",
        "A reader that follows the references never ends, or gives up and puts both frames at the model's origin."),
    ("circular_mimic",
        "If θ₁ = θ₂ and θ₂ = θ₁, every angle satisfies both; if each is twice the other, only 0 does. A reader \
         that accepts the circle has to choose a position."),
    ("constraint_of_several_axes",
        "One equation, θ = 0.1, cannot hold the three angles of a ball; which of them is meant is not defined."),
    ("continuous_limits",
        "A program that respects the limits stops this joint at ±1.5 rad; one that follows URDF lets it turn \
         without end. A planner and a simulator may so disagree about the same file."),
    ("contradictory_attribute",
        "With 0.001 instead of 0 kg m², the principal moments 0.03 and 0.03 kg m² become 0.029 and 0.031 kg m², \
         and their axes turn by 45°."),
    ("contradictory_key",
        "In the example mozzi starts with the elbow at -1 rad and MuJoCo at -0.9 rad: the end of the 0.3 m link \
         starts 3 cm apart."),
    ("contradictory_limits",
        "No position of the source joint keeps the mimic joint within its limits: in the URDF example it is at \
         least 2 rad outside. A planner finds no valid configuration."),
    ("contradictory_pitch",
        "0.1 m per turn or -0.314 m per turn: the nut moves three times as far, and in the other direction."),
    ("decimal_comma",
        "C's `strtod`, which many readers use, stops at the comma: `0,2` becomes 0. The centre of mass of the \
         example moves by 0.2 m, and the gravity torque of its 2 kg, up to 3.9 N m, disappears."),
    ("default_inertia",
        "A finger of 20 g becomes fifty times as heavy, with a radius of gyration of 1 m."),
    ("degrees",
        "±90 rad are 14.3 turns in each direction instead of a quarter: a planner may wind up the cables, and a \
         policy whose actions are scaled to the limits moves the joint 57 times too far."),
    ("document_type",
        "Ten levels of entities, each with ten references to the level before, expand a file of 1 kB to 10⁹ words. \
         An external entity can read any file of the user."),
    ("duplicate_element",
        "One reader takes 2 kg and another 3 kg: the largest gravity torque about the shoulder is 3.9 N m or 5.9 N \
         m."),
    ("duplicate_name",
        "A position, torque or frame that is addressed by the name reaches one of the two, and not the same one in \
         every program."),
    ("empty",
        "An interrupted download or a full disk leaves such a file. Read as a robot, it has no joints, and no \
         message explains why."),
    ("empty_name",
        "No command, limit or result can refer to it, and its column in a table has no title."),
    ("fixed_mimic",
        "A gripper whose second finger is fixed does not close: the finger stays in place while the first one \
         moves through its whole range."),
    ("fixed_source",
        "The joint would stay at its offset: the robot has one degree of freedom less than the file suggests."),
    ("global_coordinates",
        "Read as local, a position would be added to its parent's: a body at the height 0.9 m whose parent is at \
         0.5 m would be at 1.4 m."),
    ("ignored_attribute",
        "M, the torques and the accelerations are the same without them: `friction`, for example, acts in contacts \
         only."),
    ("mjcf::ignored_element",
        "M and the torques are the same without it: the forces of actuators are arguments of the computation, and \
         a sensor has no force."),
    ("sdf::ignored_element",
        "The dynamics of the robot are the same without it. In a simulation the robot falls through a static \
         floor, unless a ground is given."),
    ("ignored_force",
        "The spring of the example, 100 N/m, pulls with 20 N when it is 0.2 m longer than at rest. Inverse \
         dynamics leaves this force out."),
    ("mjcf::ignored_force",
        "A spring of 20 N m/rad has a torque of 20 N m at 1 rad; a body with gravcomp=\"1\" does not feel its \
         weight, 9.81 N per kilogram. Torques computed without them differ by as much from MuJoCo's."),
    ("ignored_limit",
        "A trajectory planned here may begin with a step of acceleration, an unbounded jerk, although the file \
         allows 60 rad/s³."),
    ("mjcf::ignored_limit",
        "MuJoCo pulls the joints back when half the difference of their angles leaves -0.3 to 2 rad. Here they \
         move on, so the simulated motions differ from there."),
    ("ignored_mesh",
        "The dynamics do not change. The total mass lacks this body's, which MuJoCo computes from the mesh."),
    ("ignored_plugin",
        "A plugin for buoyancy pushes each litre of water that the robot displaces up with 9.8 N; this force is \
         missing here."),
    ("ignored_property",
        "A limit of 1.5 on a planar joint would mean 1.5 m for its two slides and 1.5 rad for its rotation, and a \
         damping N s/m or N m s/rad. A simulation here has neither."),
    ("ignored_quaternion",
        "A reader of URDF 1.1 turns the frame, urdfdom and mozzi do not under version 1.0. In the example the \
         shoulder's axis is y instead of z."),
    ("implausible_inertia",
        "Moments in kg mm² are a million times too large: the shoulder of the example needs 30 000 N m for 1 \
         rad/s² instead of 0.11 N m."),
    ("implausible_length",
        "Millimetres read as metres make lever arms and gravity torques a thousand times too large, and inertias \
         about distant axes a million times."),
    ("implausible_mass",
        "Grams read as kilograms make forces a thousand times too large: the gravity torque of the example is up \
         to 3900 N m instead of 3.9 N m."),
    ("include",
        "A model without its included part lacks bodies, default values or options such as gravity, and every \
         torque may differ."),
    ("indefinite_inertia",
        "At 1 rad/s a moment of -0.002 kg m² has the kinetic energy ½ I ω² = -0.001 J. M is not positive definite: \
         a torque accelerates the joint backwards, and a simulation diverges."),
    ("inertia_from_shapes",
        "The box of 1 m³ in the example has 1000 kg at SDFormat's default density, not the 1 kg that a link \
         without an inertia has."),
    ("key_quaternion",
        "(1, 1, 0, 0) is normalized to a rotation by 90° about x. If another rotation was meant, the simulation \
         starts in the wrong pose."),
    ("late_declaration",
        "Strict XML parsers, such as Python's `xml.etree`, refuse the file, so that it opens in one program and \
         not in the next."),
    ("long_name",
        "Names are repeated in messages, tables and generated code. A name this long is usually a missing \
         quotation mark, which swallows the elements that follow."),
    ("long_value",
        "Each element of the class gets a copy: a value of 1 MB for a thousand joints takes 1 GB."),
    ("loop_closure",
        "If a reader drops one of the two joints, the mechanism opens: it has more degrees of freedom than the \
         real one, and the force in the rod is missing from every torque."),
    ("massless_leaf",
        "M has a 0 on its diagonal, and θ̈ = M⁻¹(τ - h) divides by it: the smallest torque gives an infinite \
         acceleration."),
    ("mesh_inertia",
        "A guess would change every torque: read in decimetres instead of metres, the same mesh has a thousandth of \
         the mass."),
    ("mimic_of_several_axes",
        "One number, multiplier × θ + offset, cannot set the three angles of a ball or the six numbers of a free \
         joint."),
    ("misplaced_joint",
        "The world does not move, so the joint would have no effect: a robot that should slide on this rail is \
         fixed."),
    ("sdf::misplaced_joint",
        "No joint can move the world. If this one is dropped, the robot of the example floats, with six degrees of \
         freedom, instead of being fixed."),
    ("missing_attribute",
        "Zero would be a guess: if `iyz` was lost, the principal axes of the link are wrong, and no message says \
         so."),
    ("mjcf::missing_attribute",
        "The default range is 0 to 0: a joint limited to it cannot move. MuJoCo refuses it, too."),
    ("missing_element",
        "Without its moments the example's link is a point mass: 0.08 instead of 0.11 kg m² about the shoulder, so \
         that its acceleration is 38 % too large."),
    ("missing_limit",
        "Without bounds a planner may turn the joint through the robot itself; with URDF's default bounds, both 0, \
         the joint could not move at all."),
    ("missing_size",
        "A box with a side of 0 has no volume and no mass, so forward dynamics would divide by 0."),
    ("misspelled_attribute",
        "If `Lower` were ignored, the lower limit would be URDF's default 0: the joint would lose half of its \
         range, -1.5 to 0 rad."),
    ("misspelled_element",
        "If `<intertial>` were ignored, the link would have no mass: a gravity torque of up to 3.9 N m would be \
         missing."),
    ("negative_friction",
        "A damping of -0.1 N m s/rad adds 0.1 W at 1 rad/s: every small motion grows exponentially."),
    ("negative_limit",
        "Clamping a velocity to between 2 and -2 rad/s has no solution: depending on the program, the joint stands \
         still or always moves at 2 rad/s."),
    ("negative_mass",
        "A force of 1 N would accelerate -2 kg by 0.5 m/s² against the force. M is not positive definite, and a \
         simulation diverges."),
    ("no_base",
        "All poses, gravity and M are relative to a base that is fixed or floats. Without one they are not \
         defined."),
    ("no_links",
        "There is nothing to compute: M would be a 0 × 0 matrix. Usually a xacro macro was defined and never \
         called."),
    ("no_mass",
        "The factor 3 kg / 0 kg is infinite, and 0 times infinity is NaN: so would be every entry of M."),
    ("no_model",
        "There is nothing to compute: static models have no degree of freedom."),
    ("non_unit_axis",
        "A program that does not normalize an axis of length 2 doubles the joint's motion and its column of the \
         Jacobian, and makes its diagonal entry of M four times as large."),
    ("non_unit_quaternion",
        "Used as it is, a quaternion of length 2 does not only rotate: it scales every length by 4."),
    ("not_a_number",
        "C's `atof`, which many readers use, reads `two` as 0: the link would have no mass, and no message would \
         say so."),
    ("not_finite",
        "One NaN makes every torque and acceleration of the joints that move this link NaN, often without any \
         message."),
    ("not_utf8",
        "In Latin-1 `à` is the byte 0xe0, which is no character of UTF-8. A name that is cut or changed there no \
         longer matches the name in a controller's settings."),
    ("redundant_attribute",
        "Of `velocity=\"2\"` and `k_velocity=\"10\"` the second has no effect. If it is the one that was meant, \
         the limit is five times too low."),
    ("renamed_site",
        "`lower` would mean two frames, 0.3 m apart in the example; a program that uses the name of the site would \
         get the body."),
    ("repaired_inertia",
        "The dynamics are those of another body: two moments of the example change from 0.03 to 0.1 kg m², and the \
         torque for 1 rad/s² at the shoulder from 0.11 to 0.18 N m."),
    ("repeated_include",
        "Its elements would exist twice: a part that is included twice has twice the mass. A file that includes \
         itself never ends."),
    ("reversed_limits",
        "No position is above the lower and below the upper limit. Depending on the program, the joint does not \
         move, jumps between the two, or is refused."),
    ("rotor_of_several_axes",
        "The rotor turns by the sum of coef × θ over the joints. A ball has no single θ, so the rotor's part of M \
         is not defined."),
    ("self_constraint",
        "The distance of the two points, 0.5 m in the example, cannot change: the constraint can never be \
         satisfied, and its rows of the Jacobian are 0."),
    ("self_parent",
        "The link's pose would be relative to itself, and a recursion from the base never reaches it."),
    ("several_bases",
        "The pose of the second base relative to the first is not known. A reader that takes one of them drops the \
         other links, 1 kg in the example."),
    ("several_orientations",
        "Two programs that read different ones build different robots: in the MJCF example they differ by a \
         rotation of 90°."),
    ("static_model",
        "Read as a moving part, a rack would fall or add its mass to the arm, 1 kg in the example; read as a fixed \
         one, the arm could not carry it."),
    ("stray_text",
        "A value written as text is lost: a damping of 0.5 N m s/rad would be 0."),
    ("syntax",
        "What follows the error may belong to any element. A reader that guesses can move a joint to another link \
         or drop it."),
    ("too_deep",
        "A file of 1 MB can nest more than 100 000 elements, which overflows the stack of a recursive reader."),
    ("too_large",
        "Such a file could take gigabytes of memory. Every published robot in docs/published-robots.md is smaller \
         than 0.4 MB."),
    ("too_large_number",
        "2e999 is infinity in double precision, and makes every torque that depends on it infinite or NaN."),
    ("too_many_attributes",
        "Each attribute is compared with the others, since names must differ: a million attributes take 5 × 10¹¹ \
         comparisons."),
    ("too_many_constraints",
        "The constraint forces need a matrix of rows × rows: 4200 rows take 141 MB, and 2.5 × 10¹⁰ multiplications \
         for each solution."),
    ("too_many_keys",
        "The keys are kept as long as the model: 142 858 keys of 7 positions are a million numbers, 8 MB."),
    ("too_many_namespaces",
        "Each name is searched for in all namespaces in scope, so the time to read a file grows with the product \
         of both numbers."),
    ("turned_inertia",
        "About its axle the wheel of the example has 0.02 instead of 0.036 kg m²: a torque accelerates it 1.8 \
         times as fast as the real wheel."),
    ("unclear_limit",
        "Read as limited, the joint stops at ±90°; read as unlimited, it turns without bounds. MuJoCo refuses it, \
         too."),
    ("undeclared_prefix",
        "Parsers that know namespaces, such as Python's `xml.etree`, refuse the file, so that it opens in one \
         program and not in the next."),
    ("unknown_attribute",
        "It may be a number that matters: `mu_viscous` in a published file of the Panda is a friction, which \
         programs that read it add to the torques."),
    ("unknown_class",
        "The joint would lose the values of the class, such as its axis, damping and armature, and no message \
         would say so."),
    ("unknown_element",
        "It may hold a number that matters: `<gravity>` in a link is of SDFormat, so a link whose author switched \
         its gravity off keeps its weight."),
    ("unknown_frame",
        "Without the constraint the loop is open: a ball constraint removes three degrees of freedom."),
    ("sdf::unknown_frame",
        "If the pose were taken relative to another frame, it would be wrong by the pose of that frame relative to \
         the one that was meant."),
    ("unknown_joint",
        "Without the coupling the joint moves freely: one published pair of hands would have eight degrees of \
         freedom too many."),
    ("unknown_joint_type",
        "Read as fixed, the joint would lose its degree of freedom; read as continuous, its bounds."),
    ("unknown_link",
        "The joint has no place in the tree. If it is dropped, so is what it carries: 2 kg in the example."),
    ("unknown_word",
        "Read as the default, `hinge`, a misspelled `slide` would turn instead of slide, with a position in \
         radians instead of metres."),
    ("unphysical_inertia",
        "MuJoCo refuses such a body. Its simulated rotation is not that of any real body: with 0.03 and 0.03 kg \
         m², the third moment is at most 0.06 kg m², not 0.2."),
    ("unreachable_link",
        "The links of the ring have no pose relative to the base, and their mass, 3 kg in the example, is missing \
         from every torque."),
    ("unsupported_attribute",
        "The moments of a shell and of a solid differ: for a sphere they are ⅔ m r² and ⅖ m r², so M would be \
         wrong by up to 67 %."),
    ("unsupported_constraint",
        "Without it the rod is loose: the mechanism has three degrees of freedom too many for a ball, and the \
         force in the rod is missing from the torques."),
    ("unsupported_element",
        "Without these bodies their mass is missing: the joints that carry them would feel less weight."),
    ("unsupported_equality",
        "Without it the joints that the tendon spans move independently, one degree of freedom too many, and the \
         tendon's force is missing from the torques."),
    ("unsupported_joint",
        "A program that does not know the type refuses the file or makes the joint fixed: three degrees of freedom \
         are lost."),
    ("mjcf::unsupported_joint",
        "A free joint gives a body its own pose in the world. Its parent would no longer carry it, so it would not \
         belong to the tree."),
    ("sdf::unsupported_joint",
        "Without the coupling the mechanism has one degree of freedom too many, and a torque on one side does not \
         reach the other."),
    ("unsupported_tendon",
        "The tendon of the example pulls with 100 times the difference of the two angles: at 0.1 rad a torque of \
         10 N m is missing from both joints."),
    ("unsupported_version",
        "A word may have another meaning in another version: `quat_xyzw` turns a frame from 1.1 on and has no \
         effect in 1.0."),
    ("sdf::unsupported_version",
        "The same words mean other things in other versions: in 1.4 a joint's axis is in the axes of the model, \
         from 1.5 on in those of the joint."),
    ("wrong_count",
        "Two numbers leave the third open: `0 0.2` could be x and y, or y and z, and the centre of mass could be \
         0.2 m to the side."),
    ("wrong_root",
        "Read as a robot, a file of another format has no links and nothing moves."),
    ("xacro",
        "A wrong expansion is another robot: with 0 for an undefined `mass`, the link would have no weight."),
    ("xacro_warning",
        "A word without effect was probably meant to have one: `unit=\"kg\"` converts nothing."),
    ("zero_axis",
        "A rotation about 0 0 0 is not defined: normalizing the axis divides by 0, and every pose beyond the joint \
         is NaN."),
    ("zero_limits",
        "With an effort of 0 a controller may apply no torque, and between 0 and 0 a planner finds no motion. The \
         dynamics are computed as if the joint could move."),
];

/// The reason to mend what a code such as `mozzi::urdf::zero_axis` or `zero_axis` reports: a number or a motion that
/// would be wrong. None for an unknown code.
///
/// ```
/// assert!(mozzi_urdf::why("zero_axis").is_some_and(|text| text.contains("divides by 0")));
/// ```
pub fn why(code: &str) -> Option<&'static str> {
    let full = code.strip_prefix("mozzi::").unwrap_or(code);
    let short = full.rsplit("::").next().unwrap_or(full);
    let of = |wanted: &str| WHY.iter().find(|(code, _)| *code == wanted).map(|&(_, text)| text);
    // a code of one language alone has its prefix here
    of(full)
        .or_else(|| of(short))
        .or_else(|| ["mjcf", "sdf"].iter().find_map(|language| of(&format!("{language}::{short}"))))
}
