//! Models of MuJoCo.
use crate::{refused, warned};
use mozzi_urdf::{Policy, parse, parse_with};

const MASS: &str = "<geom size='1'/>";

/// A body with something in it.
macro_rules! body {
    ($inside:literal) => {
        concat!("<mujoco><worldbody><body name='b'>", $inside, "</body></worldbody></mujoco>")
    };
}
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
    let hinge = "three hinges";
    refused(&[
        (
            body!("<§freejoint/><joint/><geom size='1'/>"),
            "unsupported_joint",
            "body `b`: freejoint: is a free joint beside other joints of its body, expected it alone",
        ),
        (
            body!("<geom size='1'/><body name='c'><§joint name='j' type='free'/><geom size='1'/></body>"),
            "unsupported_joint",
            "joint `j`: is a free joint inside the tree: only a body of the world can be free",
        ),
        (
            body!("<freejoint/><geom size='1'/></body><body name='c'><§freejoint name='j'/><geom size='1'/>"),
            "unsupported_joint",
            "joint `j`: is a second free joint: body `b` is free already, expected one robot",
        ),
        (
            body!("<freejoint/><geom size='1'/></body><body><§joint name='j'/><geom size='1'/>"),
            "unsupported_joint",
            "joint `j`: moves beside the free body `b`, expected one robot",
        ),
        (
            body!("<freejoint align='§true'/><geom size='1'/>"),
            "unsupported_attribute",
            "body `b`: freejoint: is aligned with the body's inertia, which moves the body's frame",
        ),
        (
            body!("<joint type='free' armature='§1'/><geom size='1'/>"),
            "unsupported_attribute",
            "body `b`: joint: armature: would add an inertia between the world and the base, which mozzi does not",
        ),
        (
            body!("<§joint name='j' type='ball'/><geom size='1'/>"),
            "unsupported_joint",
            "joint `j`: is a ball joint, which turns about every axis",
        ),
        (
            body!("<§replicate count='3'/>"),
            "unsupported_element",
            "body `b`: has <replicate>, which mozzi does not expand",
        ),
        (
            body!("<joint/><geom name='hull' type='mesh' mesh='§hull'/>"),
            "mesh_inertia",
            "geom `hull`: is a mesh, whose inertia would be needed: mozzi reads no meshes",
        ),
        (
            body!("<joint/><geom size='1' shellinertia='§true'/>"),
            "unsupported_attribute",
            "body `b`: geom: shellinertia: is the inertia of a hollow body, which mozzi does not compute",
        ),
        (
            "<mujoco xmlns:xacro='http://www.ros.org/wiki/xacro'><§xacro:arm/></mujoco>",
            "xacro",
            "<xacro:arm> is a word of xacro, expected a file that xacro has expanded",
        ),
        (body!("<joint/><geom size='1' mass='§${m}'/>"), "xacro", "body `b`: geom: mass: is `${m}`, expected a number"),
        (
            body!("<joint name='j' springdamper='§1 1'/><geom size='1'/>"),
            "unsupported_attribute",
            "joint `j`: springdamper: lets MuJoCo choose a spring and a damping, which mozzi does not",
        ),
        (
            pair!("<equality><§weld body1='a' body2='b'/></equality>"),
            "loop_closure",
            "equality: weld: ties two bodies, which closes a loop, which mozzi does not compute",
        ),
        (
            pair!("<equality><§joint joint1='p' joint2='q' polycoef='0 1 0.1'/></equality>"),
            "unsupported_equality",
            "equality: joint: couples joints by a curve, which mozzi does not compute",
        ),
        (
            pair!("<equality><§joint name='e' joint1='p'/></equality>"),
            "unsupported_equality",
            "equality: joint `e`: holds a joint where it is, which mozzi does not compute",
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
            pair!("<tendon><spatial range='§0 1'><site site='s'/></spatial></tendon>"),
            "unsupported_tendon",
            "tendon: spatial: range: the tendon is limited, which mozzi does not compute",
        ),
        (
            pair!("<actuator><motor joint='p' armature='§0.1'/></actuator>"),
            "actuator_armature",
            "actuator: motor: armature: is an inertia of the actuator, which mozzi does not add to its joint's",
        ),
        (
            pair!("<deformable><§flex name='f'/></deformable>"),
            "unsupported_element",
            "deformable: flex `f`: is a flexible body, which mozzi does not compute",
        ),
    ]);
    let error = parse("a.xml", body!("<joint type='ball'/><geom size='1'/>")).expect_err("a ball joint");
    assert!(error.errors().all(|error| error.help().is_some_and(|help| help.starts_with(hinge))));
}

#[test]
fn words_and_numbers() {
    refused(&[
        ("<§mujocoinclude/>", "wrong_root", "the root element is <mujocoinclude>, expected <mujoco>"),
        (
            "<mujoco><§worldbdy/></mujoco>",
            "misspelled_element",
            "mujoco: has an element <worldbdy>, which MJCF does not know here",
        ),
        (body!("<§jiont/>"), "misspelled_element", "body `b`: has an element <jiont>, which MJCF does not know here"),
        (
            body!("<joint name='j' §axs='1 0 0'/><geom size='1'/>"),
            "misspelled_attribute",
            "joint `j`: has an attribute `axs`, which MJCF does not know",
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
            body!("<joint range='§1 -1'/><geom size='1'/>"),
            "reversed_limits",
            "joint `joint0`: limits: go from 0.017453292519943295 to -0.017453292519943295, expected the lower first",
        ),
        (
            body!("<joint limited='§true'/><geom size='1'/>"),
            "missing_attribute",
            "joint `joint0`: is limited, but has no attribute `range`",
        ),
        (
            body!("<joint actuatorfrcrange='§2 -2'/><geom size='1'/>"),
            "reversed_limits",
            "joint `joint0`: actuatorfrcrange: goes from 2 to -2, expected the lower first",
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
            body!("<§inertial pos='0 0 0' mass='1'/>"),
            "missing_attribute",
            "body `b`: inertial: has neither diaginertia nor fullinertia, expected one of them",
        ),
        (
            body!("<§inertial pos='0 0 0' diaginertia='1 1 1'/>"),
            "missing_attribute",
            "body `b`: inertial: has no attribute `mass`",
        ),
        (
            body!("<inertial mass='1' quat='§1 0 0 0' fullinertia='1 1 1 0 0 0'/>"),
            "several_orientations",
            "body `b`: inertial: has both fullinertia and quat, expected one of them",
        ),
        (
            body!("<joint/><inertial mass='1' diaginertia='§1 -1 1'/>"),
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
            "body `body1`: quat: is `0 0 0 0`, which has no direction",
        ),
        (
            "<mujoco><worldbody><body xyaxes='§1 0 0 2 0 0'/></worldbody></mujoco>",
            "zero_axis",
            "body `body1`: xyaxes: is `1 0 0 2 0 0`, which has no direction",
        ),
        (
            "<mujoco><worldbody><body name='a'/><body name='§a'/></worldbody></mujoco>",
            "duplicate_name",
            "body `a`: the name is taken, expected one of its own",
        ),
        (
            "<mujoco><worldbody><body><joint name='a'/><geom size='1'/></body><body><joint name='§a'/><geom size='1'/></body></worldbody></mujoco>",
            "duplicate_name",
            "joint `a`: the name is taken, expected one of its own",
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
            "default: the class `a` is taken, expected a name of its own",
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
            "compiler: settotalmass: the bodies have the mass 0, which cannot become 3",
        ),
        (
            "<mujoco><compiler autolimits='false'/><worldbody><body><joint range='§0 1'/><geom size='1'/></body></worldbody></mujoco>",
            "unclear_limit",
            "joint `joint0`: range: counts only with limited=\"true\", since the compiler's autolimits is `false`",
        ),
        // a default that is no number is told once, however many take it
        (
            "<mujoco><default><joint armature='§x'/></default><worldbody><body><joint/><joint/><geom size='1'/></body></worldbody></mujoco>",
            "not_a_number",
            "joint `joint0`: armature: is `x`, expected a number",
        ),
        (
            "<mujoco><include file='§a.xml'/></mujoco>",
            "include",
            "include: `a.xml` is searched beside the model, which is no file",
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
        "joint `p`: mimic: moves from 5 to 5.017453292519943 as `q` moves within its limits, but its own are 0 and 0.017453292519943295",
    )]);
}

#[test]
fn what_is_left_out_is_said() {
    warned(&[
        (
            body!("<joint name='j' stiffness='§8'/><joint stiffness='2'/><geom size='1'/>"),
            "ignored_force",
            "joint `j`: stiffness: is `8`, a spring, which mozzi does not compute (here, and 1 more)",
        ),
        (
            body!("<joint name='j' damping='§1 0 2'/><geom size='1'/>"),
            "ignored_force",
            "joint `j`: damping: is `1 0 2`, a damping that is not linear, which mozzi does not compute",
        ),
        (
            "<mujoco><worldbody><body name='b' gravcomp='§1'><geom size='1'/></body></worldbody></mujoco>",
            "ignored_force",
            "body `b`: gravcomp: is `1`, a compensation of gravity, which mozzi does not compute",
        ),
        (
            body!("<joint type='free' damping='§1'/><geom size='1'/>"),
            "ignored_force",
            "body `b`: joint: damping: is `1`, a damping of the free base, which mozzi does not compute",
        ),
        (
            "<mujoco><option density='§1.2'/></mujoco>",
            "ignored_force",
            "option: density: is `1.2`, a fluid around the bodies, which mozzi does not compute",
        ),
        (
            body!("<geom size='1'/><plugin plugin='§mujoco.elasticity.cable'/>"),
            "ignored_force",
            "body `b`: plugin: plugin: is `mujoco.elasticity.cable`, a plugin, which mozzi does not compute",
        ),
        (
            body!("<§geom type='mesh' mesh='m'/>"),
            "ignored_mesh",
            "body `b`: geom: is a mesh, whose mass is not known; the body does not move",
        ),
        (body!("<§gadget/>"), "unknown_element", "body `b`: has an element <gadget>, which MJCF does not know here"),
        (
            "<mujoco><worldbody><§body name='b'><joint name='j'/></body></worldbody></mujoco>",
            "massless_leaf",
            "link `b`: mass: joint `j` moves it, but there is no inertia: forward dynamics has no answer",
        ),
        (
            body!("<joint/><inertial mass='1' diaginertia='§1 1 3'/>"),
            "unphysical_inertia",
            "link `b`: inertia: the principal moments about the centre of mass, 1, 1 and 3 kg m², break the triangle inequality: the largest exceeds the sum of the others by 1",
        ),
    ]);
}

#[test]
fn plugins_are_told_where_they_are_declared() {
    let extension = |plugin: &str, inside: &str| {
        let text = format!("<mujoco><extension><plugin plugin='{plugin}'>{inside}</plugin></extension></mujoco>");
        let robot = parse("a.xml", text).expect("a model");
        robot.warnings.iter().map(|warning| warning.message().to_string()).collect::<Vec<_>>()
    };
    let listed = "mujoco: <extension> is ignored";
    let force =
        "extension: plugin: plugin: is `org.wind`, a plugin, whose forces are its own, which mozzi does not compute";
    assert_eq!(extension("org.wind", "<instance name='i'/>"), [listed, force]);
    assert_eq!(extension("org.wind", ""), [listed]);
    assert_eq!(extension("mujoco.pid", "<instance name='i'/>"), [listed]);
}

#[test]
fn attributes_without_effect_are_listed() {
    let text = body!(
        "<joint name='j' margin='1' actuatorfrcrange='-5 5' springref='1'/><joint axis='1 0 0' actuatorfrcrange='-1 2'/><geom \
         size='1' rgba='1 1 1 1' friction='1'/><geom size='1' rgba='1 1 1 1'/>"
    );
    for policy in [Policy::Default, Policy::Strict] {
        let robot = parse_with("a.xml", text, policy).expect("a model");
        let said: Vec<String> = robot.warnings.iter().map(|warning| warning.message().to_string()).collect();
        let joint = "joint: `actuatorfrcrange`, `margin`, `springref` are ignored";
        assert_eq!(said, [joint, "geom: `friction`, `rgba` are ignored"]);
        let effort: Vec<Option<f64>> = robot.description.joints.iter().map(|joint| joint.limits.effort).collect();
        assert_eq!(effort, [Some(5.0), None]);
    }
}

#[test]
fn what_is_right_and_has_no_place_is_listed() {
    let text = "<mujoco><asset/><worldbody><light/><body name='b'><joint name='j'/><camera/><camera/><geom size='1'/><site name='b'/>\
                </body></worldbody><actuator><motor joint='j'/></actuator><sensor/><keyframe/><visual/></mujoco>";
    for policy in [Policy::Default, Policy::Strict] {
        let robot = parse_with("a.xml", text, policy).expect("a model");
        let is_known = |code: &str| ["mozzi::mjcf::ignored_element", "mozzi::mjcf::renamed_site"].contains(&code);
        assert!(robot.warnings.iter().all(|warning| is_known(warning.code())));
        let said: Vec<String> = robot.warnings.iter().map(|warning| warning.message().to_string()).collect();
        assert_eq!(
            said,
            [
                "mujoco: <asset> is ignored",
                "worldbody: <light> is ignored",
                "body `b`: <camera> is ignored (here, and 1 more)",
                "site `b`: a body has this name too; it is called `b:site` here",
                "mujoco: <actuator> is ignored",
                "mujoco: <sensor> is ignored",
                "mujoco: <keyframe> is ignored",
                "mujoco: <visual> is ignored",
            ]
        );
    }
    assert!(
        parse("a.xml", format!("<mujoco><worldbody>{MASS}</worldbody></mujoco>")).expect("a world").warnings.is_empty()
    );
}
