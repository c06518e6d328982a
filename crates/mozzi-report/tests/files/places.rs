//! Joints that are elsewhere, of another axis or of another type.

use crate::{compare_edited, has_cause, is_accounted_for, of_text};
use mozzi::{SO3, Vec3};
use mozzi_report::compare::files::compare_files;

/// A jib that turns, a trolley that slides along it, a hook that spins below.
pub const CRANE: &str = r#"<robot name="crane">
<link name="base"/>
<joint name="turn" type="revolute"><parent link="base"/><child link="jib"/><origin xyz="0.1 0 0.2" rpy="0.3 -0.2 0.5"/>
<axis xyz="0 1 0"/><limit lower="-2" upper="1.5" effort="40" velocity="3"/></joint>
<link name="jib"><inertial><mass value="3"/><origin xyz="0.12 0.03 -0.02"/>
<inertia ixx="0.03" ixy="0.002" ixz="-0.003" iyy="0.045" iyz="0.004" izz="0.05"/></inertial></link>
<joint name="slide" type="prismatic"><parent link="jib"/><child link="trolley"/>
<origin xyz="0.3 0 0.05" rpy="0.1 0.6 -0.4"/><axis xyz="1 0 0"/>
<limit lower="-0.1" upper="0.3" effort="90" velocity="1"/></joint>
<link name="trolley"><inertial><mass value="1.5"/><origin xyz="0.05 -0.02 0.04"/>
<inertia ixx="0.01" ixy="0.001" ixz="0.0005" iyy="0.012" iyz="-0.0006" izz="0.014"/></inertial></link>
<joint name="spin" type="continuous"><parent link="trolley"/><child link="hook"/><origin xyz="0.2 0.1 0"/>
<axis xyz="0 0 1"/><limit effort="20" velocity="5"/></joint>
<link name="hook"><inertial><mass value="1.1"/><origin xyz="0.07 0.01 0.02"/>
<inertia ixx="0.006" ixy="0.0007" ixz="0.0003" iyy="0.007" iyz="0.0002" izz="0.009"/></inertial></link>
</robot>"#;

pub const SLIDE: &str = r#"<origin xyz="0.3 0 0.05" rpy="0.1 0.6 -0.4"/>"#;
const SPIN: &str = r#"<origin xyz="0.2 0.1 0"/>"#;

fn is_shown(edits: &[(&str, &str)], words: &str, is_explained: bool) {
    has_cause(&compare_edited(CRANE, edits), words, is_explained);
}

#[test]
fn a_place_that_no_axis_shows() {
    let elsewhere = "`slide` is elsewhere in b.urdf: (0.3, 0.1, 0.05) instead of (0.3, 0, 0.05)";
    let across = r#"<origin xyz="0.3 0.1 0.05" rpy="0.1 0.6 -0.4"/>"#;
    is_shown(&[(SLIDE, across)], elsewhere, false);
    let along = r#"<origin xyz="0.35 0 0.05" rpy="0.1 0.6 -0.4"/>"#;
    is_shown(&[(SLIDE, along)], "`slide` is elsewhere in b.urdf", false);
    is_shown(&[(SLIDE, r#"<origin xyz="300 0 50" rpy="0.1 0.6 -0.4"/>"#)], "`slide` has its origin in mm in b", true);
    is_shown(&[(SPIN, r#"<origin xyz="0.2 0.1 0.3"/>"#)], "`spin` is elsewhere in b.urdf: (0.2, 0.1, 0.3)", false);
    is_shown(&[(SPIN, r#"<origin xyz="0.2 0.1 0" rpy="0 0 0.7"/>"#)], "`spin` is elsewhere in b.urdf", false);
    // and another mass of the trolley: the next joint is where it was on it
    let comparison = compare_edited(CRANE, &[(SLIDE, along), ("value=\"1.5\"", "value=\"2\"")]);
    assert!(comparison.causes().count() == 2 && is_accounted_for(&comparison), "{}", comparison.text());
    // a trolley without mass shows its place by what it carries
    let mass = CRANE.find("<inertial><mass value=\"1.5\"/>").unwrap();
    let end = mass + CRANE[mass..].find("</link>").unwrap();
    let light = format!("{}{}", &CRANE[..mass], &CRANE[end..]);
    has_cause(&compare_edited(&light, &[(SLIDE, across)]), elsewhere, false);
}

#[test]
fn all_lengths_in_mm() {
    let edits = [
        ("0.1 0 0.2", "100 0 200"),
        ("0.12 0.03 -0.02", "120 30 -20"),
        ("0.3 0 0.05", "300 0 50"),
        ("0.05 -0.02 0.04", "50 -20 40"),
        ("0.2 0.1 0", "200 100 0"),
        ("0.07 0.01 0.02", "70 10 20"),
    ];
    let comparison = compare_edited(CRANE, &edits);
    let causes: Vec<&str> = comparison.causes().collect();
    assert!(causes.len() == 6 && causes.iter().all(|cause| cause.contains("mm")), "{}", comparison.text());
    assert!(comparison.is_explained() && is_accounted_for(&comparison), "{}", comparison.text());
}

#[test]
fn other_link_frames_are_the_same_robot() {
    // the trolley's frame along its slide: p + R (0.1, 0, 0)
    let along = SO3::from_rpy(0.1, 0.6, -0.4) * Vec3([0.1, 0.0, 0.0]) + Vec3([0.3, 0.0, 0.05]);
    let [x, y, z] = along.0;
    let slide = format!("<origin xyz=\"{x} {y} {z}\" rpy=\"0.1 0.6 -0.4\"/>");
    let [slide, center, spin] =
        [(SLIDE, slide.as_str()), ("0.05 -0.02 0.04", "-0.05 -0.02 0.04"), (SPIN, r#"<origin xyz="0.1 0.1 0"/>"#)];
    let comparison = compare_edited(CRANE, &[slide, center, spin]);
    assert!(comparison.agrees() && comparison.causes().next().is_none(), "{}", comparison.text());
    // and with another mass on top
    let comparison = compare_edited(CRANE, &[slide, center, spin, ("value=\"1.5\"", "value=\"2\"")]);
    has_cause(&comparison, "another mass of `trolley`: 2 kg instead of 1.5 kg", true);
}

#[test]
fn another_type_of_joint() {
    is_shown(&[("prismatic", "revolute")], "`slide` is revolute in b.urdf, prismatic here", true);
    is_shown(
        &[("name=\"turn\" type=\"revolute\"", "name=\"turn\" type=\"prismatic\"")],
        "`turn` is prismatic in b.urdf, revolute here",
        true,
    );
}

#[test]
fn axes_and_angles_that_are_read_otherwise() {
    let turn = SO3::from_rpy(0.3, -0.2, 0.5);
    for (axis, words) in [
        (turn * Vec3([0.0, 1.0, 0.0]), "`turn` has its axis in the parent's frame"),
        (turn.inverse() * Vec3([0.0, 1.0, 0.0]), "`turn` has its axis turned back by its origin"),
    ] {
        let [x, y, z] = axis.0;
        is_shown(&[("xyz=\"0 1 0\"", &format!("xyz=\"{x} {y} {z}\""))], words, true);
    }
    let rpy = |R: SO3| {
        let [r, p, y] = R.to_rpy();
        format!("<origin xyz=\"0.3 0 0.05\" rpy=\"{r} {p} {y}\"/>")
    };
    let about = |r, p, y| SO3::from_rpy(r, p, y);
    let other_order = about(0.1, 0.0, 0.0) * about(0.0, 0.6, 0.0) * about(0.0, 0.0, -0.4);
    let order = "`slide` has its roll, pitch and yaw in the other order";
    is_shown(&[(SLIDE, &rpy(other_order))], order, true);
    let (w, Vec3([x, y, z])) = about(0.1, 0.6, -0.4).quaternion();
    let as_xyzw = SO3::from_quaternion(x, Vec3([y, z, w]));
    is_shown(&[(SLIDE, &rpy(as_xyzw))], "`slide` has its quaternion in the order x y z w", true);
    let read_as_xyzw = SO3::from_quaternion(z, Vec3([w, x, y]));
    is_shown(&[(SLIDE, &rpy(read_as_xyzw))], "`slide` has its quaternion read in the order x y z w", true);
}

#[test]
fn numbers_of_six_digits_are_rounded() {
    is_shown(&[(SLIDE, r#"<origin xyz="0.3 0 0.0500002" rpy="0.1 0.6 -0.4"/>"#)], "`slide` is rounded in b.urdf", true);
    is_shown(&[(r#"<mass value="1.5"/>"#, r#"<mass value="1.50001"/>"#)], "the inertia of `trolley` rounded", true);
    let limit = compare_edited(CRANE, &[(r#"lower="-2""#, r#"lower="-2.0000001""#)]);
    assert!(limit.text().contains("-2.0000001 instead of -2.0"), "{}", limit.text());
}

#[test]
fn a_link_on_another_body_is_named() {
    let edit = [(r#"type="continuous"><parent link="trolley"/>"#, r#"type="continuous"><parent link="jib"/>"#)];
    is_shown(&edit, "`spin` is on `jib` in b.urdf, on `trolley` here", true);
    // a frame without mass enters no force
    let tool = r#"<joint name="t" type="fixed"><parent link="trolley"/><child link="tool"/></joint><link name="tool"/></robot>"#;
    let with_tool = CRANE.replace("</robot>", tool);
    let moved = compare_edited(
        &with_tool,
        &[(r#"type="fixed"><parent link="trolley"/>"#, r#"type="fixed"><parent link="jib"/>"#)],
    );
    assert!(moved.forces_agree() && !moved.agrees());
    assert!(moved.text().contains("`t` is on `jib` in b.urdf"), "{}", moved.text());
}

#[test]
fn the_mass_of_a_fixed_base_is_a_note() {
    let heavy = r#"<link name="base"><inertial><mass value="4"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>"#;
    let found = compare_edited(CRANE, &[(r#"<link name="base"/>"#, heavy)]);
    assert!(found.agrees(), "{}", found.text());
    assert!(found.text().contains("the base has 4 kg in b.urdf, 0 kg in a.urdf"), "{}", found.text());
}

#[test]
fn a_base_that_stands_elsewhere_is_named() {
    let at = |pose: &str| {
        format!(
            "<mujoco model='m'><compiler angle='radian'/><worldbody><body name='base' {pose}><body name='arm' pos='0.1 0 0.2'>\
             <joint name='j' axis='0 1 0'/><inertial pos='0.2 0.1 0' mass='2' diaginertia='0.01 0.02 0.03'/></body></body>\
             </worldbody></mujoco>"
        )
    };
    let urdf = r#"<robot name="m"><link name="base"/><joint name="j" type="continuous"><parent link="base"/><child link="arm"/>
        <origin xyz="0.1 0 0.2"/><axis xyz="0 1 0"/></joint><link name="arm"><inertial><origin xyz="0.2 0.1 0"/><mass value="2"/>
        <inertia ixx="0.01" iyy="0.02" izz="0.03" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>"#;
    let of = |pose: &str| compare_files(&of_text("a.urdf", urdf), &of_text("b.xml", &at(pose)), 10, 1, 1e-9).unwrap();
    assert!(of("").agrees(), "{}", of("").text());
    has_cause(&of("pos='0.5 0 1'"), "the base is at (0.5, 0, 1) in b.xml, at (0, 0, 0) here", true);
    has_cause(&of("euler='1.5 0.2 0'"), "the base is at (0, 0, 0) in b.xml, at (0, 0, 0) here, and turned by", true);
}
