//! Structures that are not trees.

use super::{refused, warned};
use mozzi_urdf::parse;

/// A robot of links `a`, `b`, `c` and these joints, each from a parent to a child.
fn robot(joints: &[(&str, &str, &str)]) -> &'static str {
    let joint = |(name, parent, child): &(&str, &str, &str)| {
        format!("<joint name='{name}' type='fixed'><parent link='{parent}'/><child link='{child}'/></joint>\n")
    };
    let joints: String = joints.iter().map(joint).collect();
    format!("<robot name='r'>\n<link name='a'/>\n<link name='b'/>\n<link name='c'/>\n{joints}</robot>").leak()
}

#[test]
fn trees() {
    refused(&[
        ("<§robot name='r'/>", "no_links", "robot `r`: links: there are none, expected at least one"),
        ("<§robot><link name='a'/></robot>", "missing_attribute", "robot: has no attribute `name`"),
        ("<§COLLADA/>", "wrong_root", "the root element is <COLLADA>, expected <robot>"),
        ("<§Robot/>", "wrong_root", "the root element is <Robot>, expected <robot>"),
        ("<robot name='r'><§link/></robot>", "missing_attribute", "link: has no attribute `name`"),
        ("<robot name='r'><link name='§'/></robot>", "empty_name", "link ``: name: is empty, expected a name"),
        (
            "<robot name='r'><link name='a'/>\n<link name='§a'/></robot>",
            "duplicate_name",
            "link `a`: name: `a` is used twice, expected a unique name",
        ),
        (
            robot(&[("j", "a", "b"), ("§j", "b", "c")]),
            "duplicate_name",
            "joint `j`: name: `j` is used twice, expected a unique name",
        ),
        (
            robot(&[("j", "§nn", "b"), ("k", "b", "c")]),
            "unknown_link",
            "joint `j`: parent: there is no link `nn`, expected one of `a`, `b`, `c`",
        ),
        (
            robot(&[("j", "a", "§nn"), ("k", "b", "c")]),
            "unknown_link",
            "joint `j`: child: there is no link `nn`, expected one of `a`, `b`, `c`",
        ),
        (
            robot(&[("j", "a", "b"), ("k", "c", "§c")]),
            "self_parent",
            "joint `k`: child: link `c` is also the joint's parent, expected another link",
        ),
        (
            robot(&[("j", "a", "b"), ("k", "a", "c"), ("l", "b", "§c")]),
            "loop_closure",
            "joint `l`: child: link `c` is already the child of joint `k`, which closes a loop; expected a tree, whose loops constraints close",
        ),
        (
            robot(&[("j", "a", "b"), ("k", "b", "c"), ("l", "c", "a")]).replacen('<', "<§", 1).leak(),
            "no_base",
            "robot `r`: joints: every link is the child of a joint: a closed ring; expected one link, the base, that is no child",
        ),
        (
            robot(&[("j", "a", "b")]).replace("<link name='c'", "<§link name='c'").leak(),
            "several_bases",
            "link `c`: joints: is no joint's child, and neither is `a`: expected one base, so a joint that leads to this link is missing",
        ),
        (
            "<robot name='r'><link name='a'/><link name='b'/>\n<§joint name='j' type='fixed'><child link='b'/></joint></robot>",
            "missing_element",
            "joint `j`: has no <parent>",
        ),
        (
            "<robot name='r'><link name='a'/><link name='b'/><joint name='j' type='fixed'><§parent/><child link='b'/></joint></robot>",
            "missing_attribute",
            "joint `j`: parent: has no attribute `link`",
        ),
        (
            "<robot name='r'><link name='a'/><§loop_joint name='j'/></robot>",
            "loop_closure",
            "robot: loop_joint: is not an element of URDF",
        ),
        (
            "<robot name='r'><link name='a'/><§constraint name='c'/></robot>",
            "unsupported_constraint",
            "robot: constraint: is a proposal for URDF that no version defines, and that readers ignore or refuse",
        ),
    ]);
    // a loop apart from the tree: each of its links is named
    let ring = parse("a.urdf", robot(&[("j", "b", "c"), ("k", "c", "b")])).expect_err("a ring").to_string();
    assert_eq!(ring.matches("is not connected to the base `a`").count(), 2, "{ring}");
}

#[test]
fn mimic_joints_in_a_circle_and_at_odds() {
    let text = |j: &str, k: &str| {
        format!(
            "<robot name='r'><link name='a'/><link name='b'/><link name='c'/>\n\
             <joint name='j' type='revolute'><parent link='a'/><child link='b'/>{j}</joint>\n\
             <joint name='k' type='revolute'><parent link='b'/><child link='c'/>{k}</joint></robot>"
        )
    };
    let limit = |low: &str, high: &str| format!("<limit lower='{low}' upper='{high}' effort='1' velocity='1'/>");
    let both =
        text(&format!("{}<mimic joint='k'/>", limit("0", "1")), &format!("{}<mimic joint='j'/>", limit("0", "1")));
    let error = parse("a.urdf", both).expect_err("a circle").to_string();
    assert_eq!(error.matches("leads back in a circle").count(), 2, "{error}");
    let odd = text(&limit("0", "1"), &format!("{}<mimic joint='§j' offset='2'/>", limit("0", "1")));
    let message = "joint `k`: mimic: moves from 2 to 3 as `j` moves within its limits, but its own limits are 0 and 1";
    warned(&[(odd.leak(), "contradictory_limits", message)]);
    let fixed =
        text(&limit("0", "1"), "<mimic joint='§j'/>").replace("name='k' type='revolute'", "name='k' type='fixed'");
    warned(&[(
        fixed.leak(),
        "fixed_mimic",
        "joint `k`: mimic: follows `j`, but is a fixed joint, which does not move",
    )]);
}

#[test]
fn all_errors_of_one_run() {
    let text = "<robot name='r'>\n<link name='a'/>\n<link name='b'>\n<inertial><mass value='x'/></inertial>\n</link>\n\
        <joint name='j' type='revolut'><parent link='nn'/><child link='b'/></joint>\n</robot>";
    let error = parse("a.urdf", text).expect_err("four errors");
    let codes: Vec<_> = error.errors().map(|error| (error.line(), error.code().rsplit("::").next())).collect();
    let expected = [(4, "missing_element"), (4, "not_a_number"), (6, "unknown_joint_type"), (6, "unknown_link")]
        .map(|(l, c)| (l, Some(c)));
    assert_eq!(codes, expected);
}
