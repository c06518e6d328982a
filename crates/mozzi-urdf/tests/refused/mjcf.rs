//! MuJoCo models.
use super::{refused, warned};

/// A model of two joints with something behind it.
macro_rules! pair {
    ($behind:literal) => {
        concat!(
            "<mujoco><worldbody><body name='b'><joint name='p'/><joint name='q' axis='1 0 0'/><geom size='1'/></body></worldbody>",
            $behind,
            "</mujoco>"
        )
    };
}

#[test]
fn what_has_no_place_is_refused_by_name() {
    refused(&[
        (
            body!("<§freejoint/><joint/><geom size='1'/>"),
            "unsupported_joint",
            "body `b`: freejoint: is a free joint in a body with other joints, expected no others",
        ),
        (
            body!("<geom size='1'/><body name='c'><§joint name='j' type='free'/><geom size='1'/></body>"),
            "unsupported_joint",
            "joint `j`: is a free joint inside the tree: in MJCF only a body of the world can be free",
        ),
        (
            body!("<joint type='ball'/><§joint/><geom size='1'/>"),
            "unsupported_joint",
            "body `b`: joint: is after a ball in the same body, expected a slide there",
        ),
        (
            body!("<joint/><joint/><joint/><joint/><joint/><joint/><§joint/><geom size='1'/>"),
            "unsupported_joint",
            "body `b`: joint: is one joint too many in its body, expected at most six degrees of freedom",
        ),
        (
            body!("<joint/><geom size='1'/><geom type='§plane' size='1 1 1'/>"),
            "unsupported_element",
            "body `b`: geom: type: is plane, expected another shape: joints move its body",
        ),
        (
            body!("<§inertial mass='1' diaginertia='1 1 1'/>"),
            "missing_attribute",
            "body `b`: inertial: has no attribute `pos`",
        ),
        (
            body!("<freejoint align='§true'/><geom size='1'/>"),
            "unsupported_attribute",
            "body `b`: freejoint: would be aligned with the body's inertia, which moves the body's frame",
        ),
        (
            body!("<joint name='j' type='ball' range='§10 20'/><geom size='1'/>"),
            "reversed_limits",
            "joint `j`: limits: go from 0.17453292519943295 to 0.3490658503988659, expected 0 and the ball's largest angle",
        ),
        (
            body!("<replicate count='§2.5'/>"),
            "wrong_count",
            "body `b`: replicate: count: is 2.5, expected a whole number, and at most 10000 copies in all",
        ),
        (
            body!("<§composite type='cable'/>"),
            "unsupported_element",
            "body `b`: has <composite>, which mozzi does not expand",
        ),
        (
            body!("<joint/><geom name='hull' type='mesh' mesh='§hull'/>"),
            "mesh_inertia",
            "geom `hull`: mesh: its inertia is needed, and is unknown: there is no such mesh in <asset>",
        ),
        (
            "<mujoco><asset><mesh name='m' vertex='0 0 0 1 0 0 0 1 0 0 0 1'/></asset><worldbody><body name='b'><joint/>\
             <geom type='mesh' mesh='m' shellinertia='§true'/></body></worldbody></mujoco>",
            "unsupported_attribute",
            "body `b`: geom: shellinertia: is not for a mesh, expected inertia=\"shell\" of the mesh in <asset>",
        ),
        (
            "<mujoco xmlns:xacro='http://www.ros.org/wiki/xacro'><§xacro:arm/></mujoco>",
            "xacro",
            "the macro `arm` is not defined",
        ),
        (body!("<joint/><geom size='1' mass='§${m}'/>"), "xacro", "body `b`: geom: mass: is `${m}`, expected a number"),
        (
            body!("<joint name='j' springdamper='§1 1'/>"),
            "unsupported_attribute",
            "joint `j`: springdamper: the mass matrix is singular, expected an inertia",
        ),
        (
            pair!("<equality><§weld/></equality>"),
            "missing_attribute",
            "equality: weld: has neither sites nor bodies, expected `body1`, or `site1` and `site2`",
        ),
        (
            pair!("<equality><§connect body1='b'/></equality>"),
            "missing_attribute",
            "equality: connect: has no attribute `anchor`",
        ),
        (
            pair!("<equality><weld name='w' body1='b' body2='§c'/></equality>"),
            "unknown_link",
            "equality: weld `w`: body2: there is no body `c`",
        ),
        (
            "<mujoco><worldbody><body name='b'><joint/><geom size='1'/><site name='t'/></body></worldbody>\
             <equality><connect site1='§s' site2='t'/></equality></mujoco>",
            "unknown_frame",
            "equality: connect: site1: there is no site `s`",
        ),
        (
            pair!("<equality><joint joint1='p' joint2='§r'/></equality>"),
            "unknown_joint",
            "equality: joint: joint2: there is no joint `r`",
        ),
        (
            pair!(
                "<default><tendon stiffness='§2'/></default><tendon><fixed name='t'><joint joint='p' coef='1'/></fixed></tendon>"
            ),
            "unsupported_tendon",
            "tendon: fixed `t`: stiffness: the tendon has a force of its own, which mozzi does not compute",
        ),
        (
            pair!("<actuator><motor site='s' armature='§0.1'/></actuator>"),
            "actuator_armature",
            "actuator: motor: armature: is the inertia of an actuator that drives neither a joint nor a tendon",
        ),
        (
            pair!("<tendon><spatial armature='§1'><site site='s'/></spatial></tendon>"),
            "unsupported_tendon",
            "tendon: spatial: armature: the tendon has an inertia that varies with the joints, which mozzi does not compute",
        ),
        (
            pair!(
                "<tendon><spatial name='t'><site site='s'/></spatial></tendon><actuator><motor tendon='t' armature='§1'/></actuator>"
            ),
            "unsupported_tendon",
            "actuator: motor: armature: acts through a spatial tendon, whose effective inertia varies with the joints",
        ),
        (
            pair!("<actuator><motor tendon='§t' armature='1'/></actuator>"),
            "unknown_joint",
            "actuator: motor: tendon: there is no tendon `t`",
        ),
        (
            pair!("<tendon><fixed armature='1'><joint joint='§r' coef='1'/></fixed></tendon>"),
            "unknown_joint",
            "tendon: fixed: joint: joint: there is no joint `r`",
        ),
        (
            pair!("<deformable><§flex name='f'/></deformable>"),
            "unsupported_element",
            "deformable: flex `f`: is a flexible body, which mozzi does not compute",
        ),
    ]);
}

#[test]
fn words_and_numbers() {
    refused(&[
        ("<§mujocoinclude/>", "wrong_root", "the root element is <mujocoinclude>, expected <mujoco>"),
        (
            "<mujoco><§worldbdy/></mujoco>",
            "misspelled_element",
            "mujoco: has an element <worldbdy>, which MJCF does not define here",
        ),
        (body!("<§jiont/>"), "misspelled_element", "body `b`: has an element <jiont>, which MJCF does not define here"),
        (
            body!("<joint name='j' §axs='1 0 0'/><geom size='1'/>"),
            "misspelled_attribute",
            "joint `j`: has an attribute `axs`, which MJCF does not define",
        ),
        (
            body!("<joint type='§hing'/><geom size='1'/>"),
            "unknown_word",
            "joint `joint0`: type: is `hing`, expected one of `hinge`, `slide`, `ball`, `free`",
        ),
        (
            body!("<joint axis='§0 0 0'/><geom size='1'/>"),
            "zero_axis",
            "joint `joint0`: axis: is `0 0 0`, expected a direction",
        ),
        (
            body!("<joint limited='§true'/><geom size='1'/>"),
            "missing_attribute",
            "joint `joint0`: is limited, but has no attribute `range`",
        ),
        (
            body!("<joint armature='§-1'/><geom size='1'/>"),
            "negative_friction",
            "joint `joint0`: armature: is -1, expected a finite number, at least 0",
        ),
        (
            body!("<joint damping='§1,5'/><geom size='1'/>"),
            "decimal_comma",
            "joint `joint0`: damping: is `1,5`, expected a number",
        ),
        (
            body!("<joint/><geom type='box' size='§1 2'/>"),
            "missing_size",
            "body `b`: geom: size: is 1 2 0, expected numbers above 0 for a box",
        ),
        (
            body!("<joint/><geom size='1' mass='§-1'/>"),
            "negative_mass",
            "body `b`: geom: mass: is -1, expected at least 0",
        ),
        (
            body!("<geom type='capsule' size='1' fromto='§1 1 1 1 1 1'/>"),
            "zero_axis",
            "body `b`: geom: fromto: its points are the same, expected two points",
        ),
        (
            body!("<inertial pos='0 0 0' mass='§-2' diaginertia='1 1 1'/>"),
            "negative_mass",
            "link `b`: mass: is -2 kg, expected at least 0",
        ),
        (
            body!("<§inertial pos='0 0 0' diaginertia='1 1 1'/>"),
            "missing_attribute",
            "body `b`: inertial: has no attribute `mass`",
        ),
        (
            body!("<inertial pos='0 0 0' mass='1' quat='§1 0 0 0' fullinertia='1 1 1 0 0 0'/>"),
            "several_orientations",
            "body `b`: inertial: has both fullinertia and quat, expected one of them",
        ),
        (
            body!("<joint/><inertial pos='0 0 0' mass='1' diaginertia='§1 -1 1'/>"),
            "indefinite_inertia",
            "link `b`: inertia: the smallest principal moment about the centre of mass is -1 kg m², expected at least 0",
        ),
        (
            "<mujoco><worldbody><§body quat='1 0 0 0' euler='0 0 0'/></worldbody></mujoco>",
            "several_orientations",
            "body `body1`: has `quat`, `euler`, expected one of them",
        ),
        (
            "<mujoco><worldbody><body quat='§0 0 0 0'/></worldbody></mujoco>",
            "zero_axis",
            "body `body1`: quat: is `0 0 0 0`, a vector of length 0",
        ),
        (
            "<mujoco><worldbody><body xyaxes='§1 0 0 2 0 0'/></worldbody></mujoco>",
            "zero_axis",
            "body `body1`: xyaxes: is `1 0 0 2 0 0`, a vector of length 0",
        ),
        (
            "<mujoco><worldbody><body name='a'/><body name='§a'/></worldbody></mujoco>",
            "duplicate_name",
            "body `a`: the name is used twice, expected a unique name",
        ),
        (
            "<mujoco><worldbody><body><joint name='a'/><geom size='1'/></body><body><joint name='§a'/><geom size='1'/></body></worldbody></mujoco>",
            "duplicate_name",
            "joint `a`: the name is used twice, expected a unique name",
        ),
        (
            "<mujoco><worldbody><§joint/></worldbody></mujoco>",
            "misplaced_joint",
            "worldbody: has a joint, but the world does not move",
        ),
        (
            body!("<geom class='§arms' size='1'/>"),
            "unknown_class",
            "body `b`: geom: class: there is no default class `arms`",
        ),
        (
            "<mujoco><default><default class='a'/><default class='§a'/></default></mujoco>",
            "duplicate_name",
            "default: the class `a` is used twice, expected a unique name",
        ),
        (
            "<mujoco><default><§default/></default></mujoco>",
            "missing_attribute",
            "mujoco: default: default: has no attribute `class`",
        ),
        (
            "<mujoco><compiler coordinate='§global'/></mujoco>",
            "global_coordinates",
            "compiler: coordinate: is `global`, expected `local`",
        ),
        (
            "<mujoco><compiler eulerseq='§xyw'/></mujoco>",
            "unknown_word",
            "compiler: eulerseq: is `xyw`, expected three axes",
        ),
        (
            "<§mujoco><compiler settotalmass='3'/></mujoco>",
            "no_mass",
            "compiler: settotalmass: the bodies' total mass 0 cannot be scaled to 3",
        ),
        (
            "<mujoco><compiler autolimits='false'/><worldbody><body><joint range='§0 1'/><geom size='1'/></body></worldbody></mujoco>",
            "unclear_limit",
            "joint `joint0`: range: is used only with limited=\"true\", since the compiler's autolimits is `false`",
        ),
        // an invalid default is reported once, even if many elements take it
        (
            "<mujoco><default><joint armature='§x'/></default><worldbody><body><joint/><joint/><geom size='1'/></body></worldbody></mujoco>",
            "not_a_number",
            "joint `joint0`: armature: is `x`, expected a number",
        ),
        (
            "<mujoco><include file='§a.xml'/></mujoco>",
            "include",
            "include: `a.xml` is relative to the model, which was not read from a file",
        ),
        ("<mujoco><§include/></mujoco>", "missing_attribute", "include: has no attribute `file`"),
        ("<mujoco><§worldbody>", "syntax", "the file ends before <worldbody> is closed"),
    ]);
}

#[test]
fn values_and_couplings() {
    let long = format!("<mujoco><default><joint axis='§{}1'/></default></mujoco>", "0 ".repeat(200));
    refused(&[(long.leak(), "long_value", "mujoco: default: joint: axis: has 401 bytes, expected at most 256")]);
    warned(&[(
        "<mujoco><worldbody><body name='b'><joint name='p' range='0 1'/><joint name='q' axis='1 0 0' range='0 1'/><geom size='1'/>\
         </body></worldbody><equality><joint joint1='p' joint2='§q' polycoef='5 1'/></equality></mujoco>",
        "contradictory_limits",
        "joint `p`: mimic: moves from 5 to 5.017453292519943 as `q` moves within its limits, but its own limits are 0 and 0.017453292519943295",
    )]);
}
