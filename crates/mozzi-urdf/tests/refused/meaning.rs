//! Elements and attributes: misspelled, missing, duplicate, unknown, or meaningless.

use super::{refused, warned};
use mozzi_urdf::parse;

/// A robot with this text in its only joint.
fn joint(kind: &str, text: &str) -> &'static str {
    format!(
        "<robot name='r'>\n<link name='a'/><link name='b'><inertial><mass value='1'/>\
         <inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>\n\
         <joint name='j' {kind}>\n <parent link='a'/><child link='b'/>\n {text}\n</joint>\n</robot>"
    )
    .leak()
}
const TURNS: &str = "type='continuous'";
const HINGE: &str = "type='revolute'";

#[test]
fn joints() {
    let limit = |text: &str| joint(HINGE, &format!("<limit {text} effort='1' velocity='1'/>"));
    refused(&[
        (joint(TURNS, "<axis xyz='§0 0 0'/>"), "zero_axis", "joint `j`: axis: is `0 0 0`, expected a direction"),
        (joint(TURNS, "<§axis/>"), "missing_attribute", "joint `j`: axis: has no attribute `xyz`"),
        (joint(TURNS, "<axis xyz='§1,0,0'/>"), "decimal_comma", "joint `j`: axis: xyz: is `1,0,0`, expected a number"),
        (
            joint("type='§revolut'", ""),
            "unknown_joint_type",
            "joint `j`: type: is `revolut`, expected one of `revolute`, `continuous`, `prismatic`, `fixed`, `planar`, `floating`",
        ),
        (
            joint("type='§spherical'", ""),
            "unsupported_joint",
            "joint `j`: type: is `spherical`, a ball joint, which URDF does not define",
        ),
        (
            joint("type='planar'", "<axis xyz='§0 0 0'/>"),
            "zero_axis",
            "joint `j`: axis: is `0 0 0`, expected a direction",
        ),
        (
            joint("type='planar'", "<§mimic joint='j.x'/>"),
            "unsupported_joint",
            "joint `j`: mimic: a planar joint has several positions and cannot be a mimic joint",
        ),
        (
            joint("type='floating'", "<§mimic joint='k'/>"),
            "unsupported_joint",
            "joint `j`: mimic: a floating joint has several positions and cannot be a mimic joint",
        ),
        (
            joint(HINGE, "<limit lower='0' upper='1' effort='§-1' velocity='1'/>"),
            "negative_limit",
            "joint `j`: effort limit: is -1, expected at least 0",
        ),
        (
            joint(HINGE, "<limit lower='0' upper='1' effort='1' velocity='§-1'/>"),
            "negative_limit",
            "joint `j`: velocity limit: is -1, expected at least 0",
        ),
        (limit("lower='-1' upper='§INF'"), "not_finite", "joint `j`: limit: upper: is `INF`, expected a finite number"),
        (
            joint(TURNS, "<dynamics damping='§-1'/>"),
            "negative_friction",
            "joint `j`: damping: is -1, expected a finite number, at least 0",
        ),
        (
            joint(TURNS, "<dynamics friction='§x'/>"),
            "not_a_number",
            "joint `j`: dynamics: friction: is `x`, expected a number",
        ),
        (
            joint(TURNS, "<mimic joint='§j'/>"),
            "circular_mimic",
            "joint `j`: mimic: follows itself, `j`, expected another joint",
        ),
        (
            joint(TURNS, "<mimic joint='§k'/>"),
            "unknown_joint",
            "joint `j`: mimic: there is no joint `k`, expected one of `j`",
        ),
        (joint(TURNS, "<§mimic multiplier='2'/>"), "missing_attribute", "joint `j`: mimic: has no attribute `joint`"),
        (
            joint(TURNS, "<origin rpy='0 0 §90°'/>"),
            "not_a_number",
            "joint `j`: origin: rpy: is `90°`, expected a number",
        ),
    ]);
    warned(&[
        (
            joint(TURNS, "<axis xyz='§0 0 2'/>"),
            "non_unit_axis",
            "joint `j`: axis: `0 0 2` has the length 2, expected 1",
        ),
        (
            joint(HINGE, "").replace("<joint", "<§joint").leak(),
            "missing_limit",
            "joint `j`: has no <limit>, expected one on a revolute joint",
        ),
        (
            joint(HINGE, "<§limit effort='1' velocity='1'/>"),
            "missing_limit",
            "joint `j`: limit: has no attribute `lower`, expected one on a revolute joint",
        ),
        (
            joint(HINGE, "<§limit lower='-1' effort='1' velocity='1'/>"),
            "missing_limit",
            "joint `j`: limit: has no attribute `upper`, expected one on a revolute joint",
        ),
        (
            joint(HINGE, "<§limit lower='-1' upper='1' velocity='1'/>"),
            "missing_limit",
            "joint `j`: limit: has no attribute `effort`, expected one on a revolute joint",
        ),
        (
            joint(TURNS, "<limit lower='§-1' upper='1' effort='1' velocity='1'/>"),
            "continuous_limits",
            "joint `j`: limit: goes from -1 to 1, but a continuous joint has no bounds",
        ),
    ]);
}

#[test]
fn words() {
    refused(&[
        (
            joint(TURNS, "<§axsi xyz='0 0 1'/>"),
            "misspelled_element",
            "joint `j`: has an element <axsi>, which URDF does not define here",
        ),
        (
            joint(TURNS, "<§Origin/>"),
            "misspelled_element",
            "joint `j`: has an element <Origin>, which URDF does not define here",
        ),
        (
            joint(TURNS, "<origin §xzy='0 0 1'/>"),
            "misspelled_attribute",
            "joint `j`: origin: has an attribute `xzy`, which URDF does not define",
        ),
        (
            joint(TURNS, "<dynamics §dampling='1'/>"),
            "misspelled_attribute",
            "joint `j`: dynamics: has an attribute `dampling`, which URDF does not define",
        ),
        (joint(TURNS, "<origin/><§origin/>"), "duplicate_element", "joint `j`: has a second <origin>, expected one"),
        (joint(TURNS, "<§parent link='a'/>"), "duplicate_element", "joint `j`: has a second <parent>, expected one"),
        (
            "<robot name='r'><link name='a'><§intertial/></link></robot>",
            "misspelled_element",
            "link `a`: has an element <intertial>, which URDF does not define here",
        ),
        (
            "<robot name='r'><link name='a'/><§lnk name='b'/></robot>",
            "misspelled_element",
            "robot: has an element <lnk>, which URDF does not define here",
        ),
        (
            "<robot name='r'><link name='a'><§inertial><mass value='1'/></inertial></link></robot>",
            "missing_element",
            "link `a`: inertial: has no <inertia>",
        ),
        (
            "<robot name='r'><link name='a'><inertial><§mass>1</mass><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link></robot>",
            "missing_attribute",
            "link `a`: inertial: mass: has no attribute `value`",
        ),
        (
            "<robot name='r' xmlns:xacro='http://www.ros.org/wiki/xacro'><link name='a'/><§xacro:arm/></robot>",
            "xacro",
            "the macro `arm` is not defined",
        ),
    ]);
    warned(&[
        (
            joint(HINGE, "<limit lower='§1' upper='-1' effort='1' velocity='1'/>"),
            "reversed_limits",
            "joint `j`: limit: goes from 1 to -1, expected the lower bound first",
        ),
        (
            joint(HINGE, "<limit lower='0' upper='1' effort='1' velocity='1' §k_velocity='2'/>"),
            "redundant_attribute",
            "joint `j`: limit: has an attribute `k_velocity`, which URDF does not define, next to `velocity`",
        ),
        (
            joint(TURNS, "<§rotor/><rotor/>"),
            "unknown_element",
            "joint `j`: has an element <rotor>, which URDF does not define here",
        ),
        (
            joint(TURNS, "<dynamics §K='1'/>"),
            "unknown_attribute",
            "joint `j`: dynamics: has an attribute `K`, which URDF does not define",
        ),
        (joint(TURNS, "§hm"), "stray_text", "joint `j`: has the text `hm`, expected only elements"),
    ]);
}

#[test]
fn known_extensions_are_silent() {
    let text = "<robot name='r' version='1.0' xmlns:x='http://x.org' xmlns:sensor='s'><gazebo/><transmission/><material name='m'/>\
        <sensor:camera/><link name='a' xml:lang='en'><visual><x:y z='w'/></visual><visual/><collision x:b='c'/></link></robot>";
    assert_eq!(parse("a.urdf", text).expect("a robot").warnings.len(), 0);
    warned(&[
        (
            "<robot name='r' xmlns:x='http://x.org'><link name='a'/><§x:y/><x:y/></robot>",
            "unknown_element",
            "robot: has an element <x:y>, which mozzi does not read; it may change the motion",
        ),
        (
            "<robot name='r' xmlns:x='http://x.org'><link name='a' §x:b='c'/></robot>",
            "unknown_attribute",
            "link `a`: has an attribute `x:b`, which mozzi does not read; it may change the motion",
        ),
        (
            "<mujoco xmlns:x='http://x.org'><worldbody><§x:y/></worldbody></mujoco>",
            "unknown_element",
            "worldbody: has an element <x:y>, which mozzi does not read; it may change the motion",
        ),
    ]);
    let spaced = "<robot name='r' xmlns='http://x.org'><link name='a'/></robot>";
    assert_eq!(parse("a.urdf", spaced).expect("a default namespace").description.links.len(), 1);
}
