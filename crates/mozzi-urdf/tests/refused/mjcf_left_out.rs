//! MuJoCo models that load, with a report of the content that is left out.
use super::warned;
use mozzi_urdf::{Policy, parse, parse_with};

const MASS: &str = "<geom size='1'/>";

#[test]
fn what_is_left_out_is_said() {
    warned(&[
        (
            body!("<joint name='j' stiffness='§8 1'/><joint stiffness='2 0 3'/><joint stiffness='2'/><geom size='1'/>"),
            "ignored_force",
            "joint `j`: stiffness: is `8 1`, a nonlinear spring, which mozzi does not compute (here, and 1 more)",
        ),
        (
            body!("<joint name='j' stiffness='8' springyield='§0.1'/><geom size='1'/>"),
            "ignored_force",
            "joint `j`: springyield: is `0.1`, a yielding spring, which mozzi does not compute",
        ),
        (
            body!("<joint name='j' damping='§1 0 2'/><geom size='1'/>"),
            "ignored_force",
            "joint `j`: damping: is `1 0 2`, nonlinear damping, which mozzi does not compute",
        ),
        (
            "<mujoco><worldbody><body name='b' gravcomp='§1'><geom size='1'/></body></worldbody></mujoco>",
            "ignored_force",
            "body `b`: gravcomp: is `1`, gravity compensation, which mozzi does not compute",
        ),
        (
            body!("<joint type='free' frictionloss='§1'/><geom size='1'/>"),
            "ignored_force",
            "body `b`: joint: frictionloss: is `1`, friction of a free body, which mozzi does not compute",
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
            "body `b`: geom: is a mesh of unknown mass; the body does not move",
        ),
        (body!("<§gadget/>"), "unknown_element", "body `b`: has an element <gadget>, which MJCF does not define here"),
        (
            "<mujoco><worldbody><§body name='b'><joint name='j'/></body></worldbody></mujoco>",
            "massless_leaf",
            "link `b`: mass: joint `j` moves it, but it has no inertia: forward dynamics is undefined",
        ),
        (
            body!("<joint/><inertial pos='0 0 0' mass='1' diaginertia='§1 1 3'/>"),
            "unphysical_inertia",
            "link `b`: inertia: the principal moments about the centre of mass, 1, 1 and 3 kg m², break the triangle inequality: the largest exceeds the sum of the others by 1",
        ),
    ]);
}

#[test]
fn what_loses_nothing_is_said() {
    let joints = "<joint name='p'/><joint name='q' axis='1 0 0'/><geom size='1'/></body></worldbody>";
    let tendons = |text: &str| format!("<mujoco><worldbody><body name='b'>{joints}<tendon>{text}</tendon></mujoco>");
    let fixed = "<joint joint='p' coef='1'/><joint joint='q' coef='2'/></fixed>";
    for (text, message) in [
        ("<spatial range='§0 1'><site site='s'/></spatial>".to_string(), "tendon: spatial: its limits are ignored"),
        (format!("<fixed name='t' limited='true' range='§0 1'>{fixed}"), "tendon: fixed `t`: its limits are ignored"),
        (
            format!("<fixed name='t' range='§0 1'>{fixed}<fixed range='0 1'>{fixed}"),
            "tendon: fixed `t`: its limits are ignored (here, and 1 more)",
        ),
    ] {
        warned(&[(tendons(&text).leak(), "ignored_limit", message)]);
    }
    let armature = parse("a.xml", tendons(&format!("<fixed armature='2' range='0 1'>{fixed}"))).expect("a rotor");
    assert_eq!((armature.description.rotors.len(), armature.warnings.len()), (1, 1));
    warned(&[
        (
            body!("<joint range='§1 -1'/><geom size='1'/>"),
            "reversed_limits",
            "joint `joint0`: range: goes from 0.017453292519943295 to -0.017453292519943295, expected the lower bound first",
        ),
        (
            body!("<joint actuatorfrcrange='§2 -2'/><geom size='1'/>"),
            "reversed_limits",
            "joint `joint0`: actuatorfrcrange: goes from 2 to -2, expected the lower bound first",
        ),
        (
            body!("<joint/><geom size='1'/><body name='c'><§inertial pos='0 0 0' mass='0'/></body>"),
            "missing_attribute",
            "body `c`: inertial: has neither diaginertia nor fullinertia: the moments are 0",
        ),
    ]);
}

#[test]
fn plugins_are_told_where_they_are_declared() {
    let extension = |plugin: &str, inside: &str| {
        let text = format!("<mujoco><extension><plugin plugin='{plugin}'>{inside}</plugin></extension></mujoco>");
        let robot = parse("a.xml", text).expect("a model");
        robot.warnings.iter().chain(&robot.unused).map(|found| found.message().to_string()).collect::<Vec<_>>()
    };
    let listed = "mujoco: <extension> is ignored";
    let force =
        "extension: plugin: plugin: is `org.wind`, a plugin, which may apply forces, which mozzi does not compute";
    assert_eq!(extension("org.wind", "<instance name='i'/>"), [force, listed]);
    assert_eq!(extension("org.wind", ""), [listed]);
    assert_eq!(extension("mujoco.pid", "<instance name='i'/>"), [listed]);
}

#[test]
fn attributes_without_effect_are_listed() {
    let text = body!(
        "<joint name='j' margin='1' actuatorfrcrange='-5 5' user='1'/><joint axis='1 0 0'/><geom \
         size='1' rgba='1 1 1 1' friction='1'/><geom size='1' rgba='1 1 1 1'/>"
    );
    for policy in [Policy::Default, Policy::Strict] {
        let robot = parse_with("a.xml", text, policy).expect("a model");
        let said: Vec<&str> = robot.unused.iter().map(|unused| unused.message()).collect();
        let ignored = ["joint: `margin`", "joint: `user`", "geom: `rgba`", "geom: `friction`"];
        assert_eq!(said, ignored.map(|what| format!("{what} is ignored")));
        assert!(robot.warnings.is_empty());
        let effort: Vec<Option<f64>> = robot.description.joints.iter().map(|joint| joint.limits.effort).collect();
        assert_eq!(effort, [Some(5.0), None]);
    }
}

#[test]
fn what_is_right_and_has_no_place_is_listed() {
    let text = "<mujoco><asset/><worldbody><light/><body name='b'><joint name='j'/><camera/><camera/><geom size='1'/><site name='b'/>\
                </body></worldbody><actuator><motor joint='j'/></actuator><sensor/><keyframe><key ctrl='1'/></keyframe><visual/></mujoco>";
    let robot = parse("a.xml", text).expect("a model");
    let is_known = |code: &str| ["mozzi::mjcf::ignored_attribute", "mozzi::mjcf::ignored_element"].contains(&code);
    assert!(robot.unused.iter().all(|unused| is_known(unused.code())));
    let [renamed] = robot.warnings.as_slice() else { panic!("{:?}", robot.warnings) };
    assert_eq!(renamed.message(), "site `b`: a body has this name, too; the site is called `b:site` here");
    let said: Vec<&str> = robot.unused.iter().map(|unused| unused.message()).collect();
    assert_eq!(
        said,
        [
            "mujoco: <asset> is ignored",
            "worldbody: <light> is ignored",
            "body `b`: <camera> is ignored (here, and 1 more)",
            "mujoco: <actuator> is ignored",
            "mujoco: <sensor> is ignored",
            "key: `ctrl` is ignored",
            "mujoco: <visual> is ignored",
        ]
    );
    // the new name is a warning as any other
    let strict = parse_with("a.xml", text, Policy::Strict).expect_err("a warning");
    let errors: Vec<&str> = strict.errors().map(|error| error.code()).collect();
    assert_eq!(errors, ["mozzi::mjcf::renamed_site"]);
    assert!(
        parse("a.xml", format!("<mujoco><worldbody>{MASS}</worldbody></mujoco>")).expect("a world").warnings.is_empty()
    );
}
