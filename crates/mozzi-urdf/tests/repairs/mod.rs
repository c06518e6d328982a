//! Repairs of published faults, rebuilt as small files; none where there is nothing to repair; and of 200 faults that
//! a generator puts into published robots, if `MOZZI_ROBOTS` names the folder of example-robot-data.

mod evidence;
mod seeded;

use crate::files::urdf_files;
use mozzi_urdf::fix::{Proposal, apply, estimates, misfits, proposals};
use mozzi_urdf::{Policy, Settings, parse, parse_with};
use std::path::Path;

/// An arm of two links whose boxes are 0.1 × 0.2 × 0.3 m, with something in place of the second one's inertial.
fn arm(inertial: &str, limit: &str) -> String {
    format!(
        r#"<robot name="arm">
  <link name="base"/>
  <link name="left_arm">
    <inertial><origin xyz="0.02 0 0.15"/><mass value="6"/>
      <inertia ixx="0.065" ixy="0.001" ixz="0" iyy="0.05" iyz="0" izz="0.025"/></inertial>
    <collision><origin xyz="0 0 0.15"/><geometry><box size="0.1 0.2 0.3"/></geometry></collision>
  </link>
  <link name="hand">
    <inertial>{inertial}</inertial>
    <collision><origin xyz="0 0 0.15"/><geometry><box size="0.1 0.2 0.3"/></geometry></collision>
  </link>
  <joint name="left_joint" type="revolute"><parent link="base"/><child link="left_arm"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="2" effort="30" velocity="3"/></joint>
  <joint name="right_joint" type="revolute"><parent link="left_arm"/><child link="hand"/><axis xyz="1 0 0"/>
    <limit {limit} velocity="3"/></joint>
</robot>
"#
    )
}

const SOUND: &str = r#"<origin xyz="0.02 0 0.15"/><mass value="6"/><inertia ixx="0.065" ixy="0.001" ixz="0" iyy="0.05" iyz="0" izz="0.025"/>"#;
const LIMIT: &str = r#"lower="-1" upper="2" effort="30""#;

fn found(text: &str) -> Vec<Proposal> {
    proposals("arm.urdf", text, None, &Settings::default()).unwrap().proposals
}

#[test]
fn published_faults_are_repaired() {
    let with = |from: &str, to: &str| SOUND.replacen(from, to, 1);
    // what went wrong, as written, and the code of the repair
    let faults = [
        ("a decimal point is lost", with("ixx=\"0.065\"", "ixx=\"0.65\""), "power_of_ten"),
        ("two digits are lost", with("iyy=\"0.05\"", "iyy=\"5\""), "power_of_ten"),
        ("a moment is negative", with("iyy=\"0.05\"", "iyy=\"-0.05\""), "negative_moment"),
        (
            "all moments are negative",
            with("ixx=\"0.065\"", "ixx=\"-0.065\"").replace("\"0.05\"", "\"-0.05\"").replace("\"0.025\"", "\"-0.025\""),
            "negative_moment",
        ),
        (
            "columns are mixed",
            SOUND.replace(
                r#"ixx="0.065" ixy="0.001" ixz="0" iyy="0.05" iyz="0" izz="0.025""#,
                r#"ixx="0.065" ixy="0.05" ixz="0.025" iyy="0.001" iyz="0" izz="0""#,
            ),
            "mixed_columns",
        ),
        (
            "moments are in kg mm²",
            SOUND
                .replace("\"0.065\"", "\"65000\"")
                .replace("\"0.05\"", "\"50000\"")
                .replace("\"0.025\"", "\"25000\"")
                .replace("\"0.001\"", "\"1000\""),
            "units",
        ),
        (
            "moments are a thousandth",
            SOUND
                .replace("\"0.065\"", "\"0.000065\"")
                .replace("\"0.05\"", "\"0.00005\"")
                .replace("\"0.025\"", "\"0.000025\"")
                .replace("\"0.001\"", "\"0.000001\""),
            "units",
        ),
        ("the mass is in g", with("\"6\"", "\"6000\""), "units"),
        ("the centre is in mm", with("0.02 0 0.15", "20 0 150"), "units"),
    ];
    for (what, inertial, code) in faults {
        let text = arm(&inertial, LIMIT);
        let list = found(&text);
        assert_eq!(list.iter().map(|one| one.code).collect::<Vec<_>>(), [code], "{what}: {list:#?}");
        assert_eq!(apply(&text, &list), arm(SOUND, LIMIT), "{what}: the least change restores the text");
        let said = list[0].to_string();
        assert!(
            said.starts_with("link `hand`: ") && said.contains("because") && said.contains("\n  M: entry ("),
            "{said}"
        );
    }
    for (limit, code) in [
        (r#"lower="2" upper="-1" effort="30""#, "reversed_limit"),
        (r#"lower="-1" upper="2" effort="0""#, "zero_effort"),
    ] {
        let list = found(&arm(SOUND, limit));
        assert_eq!(list.iter().map(|one| one.code).collect::<Vec<_>>(), [code], "{list:#?}");
        assert_eq!(apply(&arm(SOUND, limit), &list), arm(SOUND, LIMIT));
    }
    // a bound that is missing is 0
    for (limit, change) in [
        (r#"upper="-1.5" effort="30""#, "lower 0 → -1.5, upper -1.5 → 0"),
        (r#"lower="1.5" effort="30""#, "lower 1.5 → 0, upper 0 → 1.5"),
    ] {
        let (text, list) = (arm(SOUND, limit), found(&arm(SOUND, limit)));
        assert!(list.len() == 1 && list[0].change == change, "{list:#?}");
        assert!(found(&apply(&text, &list)).is_empty());
        assert_eq!(list[0].effect, "M does not change");
    }
}

#[test]
fn a_spring_needs_no_motor() {
    let limit = r#"lower="-1" upper="2" effort="0""#;
    let spring = "<dynamics damping=\"0.5\" spring_stiffness=\"200\"/><limit lower=\"-1\" upper=\"2\" effort=\"0\"";
    assert_eq!(found(&arm(SOUND, limit)).len(), 1);
    assert!(found(&arm(SOUND, limit).replace(&format!("<limit {limit}"), spring)).is_empty());
}

#[test]
fn an_ambiguous_power_of_ten_is_told() {
    // of an upper arm whose ixx and iyy were 0.22689067591: no shape shows which of them is wrong
    let text = r#"<robot name="r"><link name="b"/><link name="upper_arm"><inertial><mass value="8.393"/>
<inertia ixx="0.022689067591" iyy="0.22689067591" izz="0.0151074" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="a" type="continuous"><parent link="b"/><child link="upper_arm"/><axis xyz="0 1 0"/></joint></robot>"#;
    let list = found(text);
    assert_eq!(list.iter().map(|one| one.code).collect::<Vec<_>>(), ["power_of_ten"], "{list:#?}");
    for moment in ["iyy is off by a factor of 10^1", "ixx is off by a factor of 10^-1"] {
        assert!(list[0].reason.contains(moment), "{}", list[0].reason);
    }
    // a shape does
    assert!(!found(&arm(&SOUND.replacen("0.065", "0.65", 1), LIMIT))[0].reason.contains("may as well"));
}

#[test]
fn a_link_in_g_and_mm_is_told_by_the_check() {
    // 1 kg in a box of 0.1 × 0.2 × 0.3 m, 50 mm from a joint that is 0.1 m from the base
    let inertial = r#"<origin xyz="0 0 50"/><mass value="1000"/>
      <inertia ixx="10833333" iyy="8333333" izz="4166666" ixy="0" ixz="0" iyz="0"/>"#;
    let text =
        arm(inertial, LIMIT).replacen("<axis xyz=\"1 0 0\"/>", "<origin xyz=\"0 0 0.1\"/><axis xyz=\"1 0 0\"/>", 1);
    let warnings = parse("arm.urdf", text.clone()).unwrap().warnings;
    assert!(warnings.iter().any(|one| one.code() == "mozzi::urdf::implausible_inertia"), "{warnings:?}");
    assert!(found(&text)[0].reason.contains("everything is in g and mm"));
}

#[test]
fn sdformat_is_not_repaired() {
    let text = "<sdf version='1.9'><model name='m'><link name='a'/></model></sdf>";
    let why = proposals("m.sdf", text, None, &Settings::default()).unwrap_err().to_string();
    assert!(why.contains("only URDF is repaired, and this is SDFormat"), "{why}");
}

#[test]
fn an_inertia_about_the_origin_is_moved() {
    // a body of 0.1 m whose centre is 0.9 m away: its moments are 40 times too large
    let text = r#"<robot name="r"><link name="base"/><link name="rod"><inertial><origin xyz="0 0 0.9"/><mass value="2"/>
<inertia ixx="1.62333" ixy="0" ixz="0" iyy="1.62333" iyz="0" izz="0.00333"/></inertial>
<collision><origin xyz="0 0 0.9"/><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
<joint name="j" type="continuous"><parent link="base"/><child link="rod"/><axis xyz="0 1 0"/></joint></robot>"#;
    let list = found(text);
    assert_eq!(list.iter().map(|one| one.code).collect::<Vec<_>>(), ["about_origin"], "{list:#?}");
    let repaired = parse("r.urdf", apply(text, &list)).unwrap().description;
    let I = repaired.links[1].inertia.about_center_of_mass();
    assert!((I.xx - 0.00333).abs() < 1e-12 && (I.yy - 0.00333).abs() < 1e-12 && I.zz == 0.00333, "{I:?}");
}

#[test]
fn what_nothing_explains_becomes_the_nearest_possible() {
    let text = arm(&SOUND.replace("ixx=\"0.065\"", "ixx=\"0.0752\""), LIMIT);
    let list = found(&text);
    assert_eq!(list.iter().map(|one| one.code).collect::<Vec<_>>(), ["nearest_inertia"], "{list:#?}");
    assert!(list[0].reason.contains("break the triangle inequality"), "{}", list[0].reason);
    let repaired = parse_with("arm.urdf", apply(&text, &list), Policy::Strict).unwrap().description;
    assert!((repaired.links[2].inertia.about_center_of_mass().xx - 0.0752).abs() < 2e-4);
    assert!(found(&apply(&text, &list)).is_empty(), "once is enough");
}

#[test]
fn a_mass_below_a_fixed_joint_is_counted_once() {
    let text = arm(SOUND, LIMIT).replace(
        "  <joint name=\"left_joint\"",
        &format!(
            "  <link name=\"copy\">\n    <inertial>{}</inertial>\n  </link>\n  <joint name=\"f\" type=\"fixed\"><origin \
             xyz=\"0 0 0.1\"/><parent link=\"hand\"/><child link=\"copy\"/></joint>\n  <joint name=\"left_joint\"",
            SOUND.replace("0.02 0 0.15", "0.02 0 0.05")
        ),
    );
    let list = found(&text);
    assert_eq!(list.iter().map(|one| (one.code, one.line)).collect::<Vec<_>>(), [("counted_twice", 12)], "{list:#?}");
    let repaired = parse("arm.urdf", apply(&text, &list)).unwrap().description;
    assert_eq!(repaired.links[3].inertia, mozzi::SpatialInertia::zero());
    assert!(apply(&text, &list).contains("<link name=\"copy\">\n  </link>"));
}

#[test]
fn a_density_gives_inertias() {
    let text = arm(SOUND, LIMIT).replace(&format!("    <inertial>{SOUND}</inertial>\n"), "");
    let list = estimates("arm.urdf", &text, 1000.0, None, &Settings::default()).unwrap().proposals;
    assert_eq!(list.len(), 2, "the base has no shape");
    let repaired = parse("arm.urdf", apply(&text, &list)).unwrap().description;
    // a ball has its own formula
    let ball = text.replace("<box size=\"0.1 0.2 0.3\"/>", "<sphere radius=\"0.1\"/>");
    let list = estimates("arm.urdf", &ball, 1000.0, None, &Settings::default()).unwrap().proposals;
    let round = parse("arm.urdf", apply(&ball, &list)).unwrap().description;
    let expected = mozzi::Solid::Sphere { radius: 0.1 }.of_density(1000.0);
    let made =
        round.links.iter().find(|link| (link.inertia.mass - expected.mass).abs() < 1e-12).expect("one of 4.19 kg");
    let (I, J) = (made.inertia.about_center_of_mass(), expected.about_center_of_mass());
    assert!([I.xx - J.xx, I.yy - J.yy, I.zz - J.zz, I.xy].iter().all(|x| x.abs() < 1e-12), "{I:?}");
    // 1000 kg/m³ of 0.1 × 0.2 × 0.3 m; the other keeps its mass of 6 kg, which is the same
    let expected = mozzi::Solid::Box([0.1, 0.2, 0.3]).of_density(1000.0);
    for link in &repaired.links[1..] {
        let (I, J) = (link.inertia.about_center_of_mass(), expected.about_center_of_mass());
        assert!((link.inertia.mass - 6.0).abs() < 1e-12 && (link.inertia.center_of_mass().0[2] - 0.15).abs() < 1e-12);
        for (a, b) in [(I.xx, J.xx), (I.yy, J.yy), (I.zz, J.zz), (I.xy, 0.0)] {
            assert!((a - b).abs() < 1e-12, "{a} {b}");
        }
    }
}

#[test]
fn a_given_mass_is_spread_over_the_shape_whatever_is_written() {
    let moments = "<inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/>";
    for inertial in [
        format!("<mass value=\"2\"/>{moments}"),
        format!("<origin rpy=\"0 0 0.5\"/><mass value=\"2\"/>{moments}"),
        format!("<origin xyz=\"1 0 0\" quat_xyzw=\"0 0 0.6 0.8\"/><mass value=\"2\"/>{moments}"),
    ] {
        let text = format!(
            "<robot name=\"r\" version=\"1.1\"><link name=\"base\"/><link name=\"arm\"><inertial>{inertial}</inertial>\
             <collision><origin xyz=\"1 0 0\"/><geometry><box size=\"0.1 0.2 0.3\"/></geometry></collision></link>\
             <joint name=\"j\" type=\"continuous\"><parent link=\"base\"/><child link=\"arm\"/><axis xyz=\"0 0 1\"/>\
             </joint></robot>"
        );
        let estimates = |text: &str| estimates("a.urdf", text, 1000.0, None, &Settings::default()).unwrap().proposals;
        let repaired = apply(&text, &estimates(&text));
        let found = parse("a.urdf", repaired.as_str()).unwrap().description.links[1].inertia;
        let expected =
            mozzi::Solid::Box([0.1, 0.2, 0.3]).inertia(2.0).transformed(mozzi::SE3::translation([1.0, 0.0, 0.0]));
        for (a, b) in found.to_parameters().into_iter().zip(expected.to_parameters()) {
            assert!((a - b).abs() < 1e-12, "{repaired}");
        }
        assert!(estimates(&repaired).is_empty(), "{repaired}");
    }
}

#[test]
fn other_languages_are_refused_by_name() {
    let why = |text: &str| proposals("a.xml", text, None, &Settings::default()).unwrap_err().to_string();
    assert!(why("<mujoco><worldbody/></mujoco>").contains("only URDF is repaired"));
    let xacro = "<robot name='a' xmlns:xacro='http://www.ros.org/wiki/xacro'><xacro:property name='x' value='1'/><link name='b'/></robot>";
    assert!(why(xacro).contains("mozzi xacro"), "{}", why(xacro));
    assert!(why("<robot").contains("refused"), "{}", why("<robot"));
}

#[test]
fn a_sound_arm_and_every_sixth_robot_get_no_proposals() {
    assert!(found(&arm(SOUND, LIMIT)).is_empty());
    sound_robots(6);
}

#[test]
#[ignore = "minutes; cargo xtask nightly runs it"]
fn sound_robots_get_no_proposals() {
    sound_robots(1);
}

/// Every so many of the published robots.
fn sound_robots(step: usize) {
    let Ok(folder) = std::env::var("MOZZI_ROBOTS") else {
        eprintln!("skipped: MOZZI_ROBOTS does not name the folder of example-robot-data");
        return;
    };
    let mut files = Vec::new();
    urdf_files(Path::new(&folder), &mut files);
    let (mut loaded, mut made, mut wrong) = (0, 0, Vec::new());
    for file in files.into_iter().step_by(step) {
        let (name, text) = (file.to_string_lossy().into_owned(), std::fs::read_to_string(&file).unwrap());
        if parse(&name, &text).is_err() {
            continue;
        }
        loaded += 1;
        let misfits = misfits(&name, &text);
        for proposal in proposals(&name, &text, None, &Settings::default()).unwrap().proposals {
            made += 1;
            println!("{name}: {proposal}");
            let Some((link, old, _)) = &proposal.inertia else { continue };
            let fits = misfits.get(link).is_none_or(|misfit| *misfit <= 1.0);
            if proposal.code != "counted_twice" && old.verdict().is_physical() && fits {
                wrong.push(format!("{name}: {proposal}"));
            }
        }
    }
    println!("{loaded} robots, {made} proposals");
    assert!(wrong.is_empty(), "{wrong:#?}");
}
