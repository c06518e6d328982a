//! One fault stays one cause where the files also differ in their bases, link frames or names.

use crate::bodies::prefixed;
use crate::places::{CRANE, SLIDE};
use crate::{compare_description, compare_edited, flat, has_cause, is_accounted_for, of_text};
use mozzi::model::description::JointKind;
use mozzi::{Description, SE3, SO3, Vec3};
use mozzi_report::compare::files::{FilesComparison, compare_files};

fn has_causes(comparison: &FilesComparison, words: &[&str]) {
    let causes: Vec<&str> = comparison.causes().collect();
    let text = comparison.text();
    assert!(causes.len() == words.len() && causes.iter().zip(words).all(|(x, y)| x.contains(y)), "{text}");
    assert!(is_accounted_for(comparison), "{text}");
}

/// The base of the crane stands 0.8 m higher, on another link.
const LIFTED: (&str, &str) = (
    r#"<link name="base"/>"#,
    r#"<link name="base"/><link name="floor"/><joint name="stand" type="fixed"><parent link="floor"/><child link="base"/>
       <origin xyz="0 0 0.8"/></joint>"#,
);

#[test]
fn a_base_elsewhere_beside_another_fault() {
    let base = "the base is at (0, 0, 0.8) in b.urdf, at (0, 0, 0) here";
    let heavy = compare_edited(CRANE, &[LIFTED, ("value=\"1.5\"", "value=\"2\"")]);
    has_causes(&heavy, &[base, "another mass of `trolley`: 2 kg instead of 1.5 kg"]);
    let rounded = (SLIDE, r#"<origin xyz="0.3 0 0.0500002" rpy="0.1 0.6 -0.4"/>"#);
    has_causes(&compare_edited(CRANE, &[LIFTED, rounded]), &["`slide` is rounded", base]);
    let edited = CRANE.replace(LIFTED.0, LIFTED.1).replace(rounded.0, rounded.1);
    let loose = compare_files(&of_text("a.urdf", CRANE), &of_text("b.urdf", &edited), 10, 1, 1e-3).unwrap();
    assert!(loose.forces_agree() && !loose.agrees(), "{}", loose.text());
}

/// Gives each moving link another frame, turned, and shifted along its joint's axis.
fn reframe(robot: &mut Description) {
    let moves = |robot: &Description, link: &str| {
        robot.joints.iter().find_map(|joint| match joint.kind {
            JointKind::Screw(A) if joint.child == link => Some(A),
            _ => None,
        })
    };
    let frames: Vec<(String, SE3)> = (robot.links.iter().enumerate())
        .filter_map(|(k, link)| {
            let turn = SO3::from_rpy(0.3 + k as f64, -0.7, 0.5 * k as f64);
            Some((link.name.clone(), SE3::new(turn, moves(robot, &link.name)?.twist().w * 0.04)))
        })
        .collect();
    let frame = |name: &str| frames.iter().find(|(link, _)| link == name).map_or(SE3::identity(), |(_, T)| *T);
    for joint in &mut robot.joints {
        joint.origin = frame(&joint.parent).inverse() * joint.origin * frame(&joint.child);
        if let JointKind::Screw(A) = joint.kind {
            joint.kind = JointKind::Screw(A.transformed(frame(&joint.child).inverse()));
        }
    }
    robot.links.iter_mut().for_each(|link| link.inertia = link.inertia.transformed(frame(&link.name).inverse()));
}

fn elbow(robot: &mut Description) -> &mut mozzi::model::description::Joint {
    robot.joints.iter_mut().find(|joint| joint.name == "elbow").unwrap()
}

#[test]
fn other_link_frames_beside_another_fault() {
    let same = compare_description(reframe);
    assert!(same.agrees() && same.causes().next().is_none(), "{}", same.text());
    let reversed = compare_description(|robot| {
        if let JointKind::Screw(A) = elbow(robot).kind {
            elbow(robot).kind = JointKind::Screw(A.map(|x| -x));
        }
        reframe(robot);
    });
    has_cause(&reversed, "`elbow` has the reversed axis in b.urdf", true);
    let moved = compare_description(|robot| {
        elbow(robot).origin.p = Vec3([0.03, 0.0, 0.3]);
        reframe(robot);
    });
    has_cause(&moved, "`elbow` is elsewhere in b.urdf: (0.03, 0, 0.3) instead of (0, 0, 0.3)", false);
}

#[test]
fn frames_of_fixed_links_are_differences_and_their_inertias_are_not() {
    let comparison = compare_description(|robot| {
        let T = SE3::new(SO3::from_rpy(0.2, 0.1, 0.9), Vec3([0.01, 0.02, 0.03]));
        let mount = robot.joints.iter_mut().find(|joint| joint.name == "mount").unwrap();
        mount.origin = mount.origin * T;
        let tool = robot.links.iter_mut().find(|link| link.name == "tool").unwrap();
        tool.inertia = tool.inertia.transformed(T.inverse());
    });
    has_causes(&comparison, &["`mount` is elsewhere, by 0.0374166 m and turned by"]);
    assert!(comparison.forces_agree() && !comparison.agrees(), "{}", comparison.text());
}

#[test]
fn two_faults_of_a_joint_are_two_causes() {
    let mm = (SLIDE, r#"<origin xyz="300 0 50" rpy="0.1 0.6 -0.4"/>"#);
    let reversed = compare_edited(CRANE, &[mm, ("xyz=\"1 0 0\"", "xyz=\"-1 0 0\"")]);
    has_causes(&reversed, &["`slide` has the reversed axis in b.urdf", "`slide` has its origin in mm in b.urdf"]);
    let unturned = (SLIDE, r#"<origin xyz="0.3 0 0.05"/>"#);
    let revolute = compare_edited(CRANE, &[unturned, ("prismatic", "revolute")]);
    has_causes(&revolute, &["`slide` is revolute in b.urdf", "`slide` is not rotated in b.urdf"]);
    let inches = [0.3, 0.05].map(|x| x / 0.0254);
    let inches = format!("<origin xyz=\"{} 0 {}\" rpy=\"0.1 0.6 -0.4\"/>", inches[0], inches[1]);
    has_causes(&compare_edited(CRANE, &[(SLIDE, &inches)]), &["`slide` has its origin in inches in b.urdf"]);
}

#[test]
fn numbers_of_three_decimals() {
    let exact = CRANE.replace(SLIDE, r#"<origin xyz="0.3004 0 0.0496" rpy="0.1 0.6 -0.4003"/>"#);
    let [a, b] = [("a.urdf", exact.as_str()), ("b.urdf", CRANE)].map(|(name, text)| of_text(name, text));
    let comparison = compare_files(&a, &b, 10, 1, 1e-9).unwrap();
    has_causes(
        &comparison,
        &["`slide` is rounded to 2 decimals in b.urdf", "`slide` is rounded to 2 decimals in b.urdf"],
    );
}

#[test]
fn names_behind_a_prefix() {
    // both wheels turn about one line
    let wheel = |side: &str, y: f64, mass: f64| {
        format!(
            "<joint name='{side}_turn' type='continuous'><parent link='base'/><child link='{side}_wheel'/>\
             <origin xyz='0 {y} 0'/><axis xyz='0 1 0'/></joint><link name='{side}_wheel'><inertial><mass value='{mass}'/>\
             <origin xyz='0.1 0 0'/><inertia ixx='0.1' iyy='0.1' izz='0.1' ixy='0' ixz='0' iyz='0'/></inertial></link>"
        )
    };
    let text =
        format!("<robot name='r'><link name='base'/>{}{}</robot>", wheel("left", 0.2, 1.0), wheel("right", -0.2, 3.0));
    let (a, mut b) = (of_text("a.urdf", &text), of_text("b.urdf", &text));
    let mut robot = b.model.description().clone();
    robot.joints.reverse();
    prefixed(&mut robot);
    b.model = robot.build().unwrap();
    let comparison = compare_files(&a, &b, 10, 1, 1e-9).unwrap();
    assert!(comparison.agrees() && comparison.causes().next().is_none(), "{}", comparison.text());
    assert!(flat(&comparison).contains("`right_turn` is `left_right_turn` in b.urdf"), "{}", comparison.text());
}

#[test]
fn what_hangs_on_another_body_is_no_cause_of_its_own() {
    let hand = r#"<joint name="wrist" type="fixed"><parent link="trolley"/><child link="hand"/></joint><link name="hand"/>
        <joint name="grip" type="continuous"><parent link="hand"/><child link="finger"/><axis xyz="0 1 0"/></joint>
        <link name="finger"><inertial><mass value="1"/><origin xyz="0.1 0 0"/>
        <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.025"/></inertial></link></robot>"#;
    let wrist = r#"type="fixed"><parent link="trolley"/>"#;
    let on_jib = compare_edited(&CRANE.replace("</robot>", hand), &[(wrist, &wrist.replace("trolley", "jib"))]);
    has_causes(&on_jib, &["`wrist` is on `jib` in b.urdf, on `trolley` here"]);
}

#[test]
fn joints_of_a_body_in_the_other_order() {
    let joints = ["<joint name='x' axis='1 0 0'/>", "<joint name='y' axis='0 1 0'/>"];
    let of = |name: &str, [one, two]: [&str; 2]| {
        let text = format!(
            "<mujoco model='m'><worldbody><body name='arm' pos='0.1 0 0.2'>{one}{two}\
             <inertial pos='0.2 0.1 0' mass='2' diaginertia='0.01 0.02 0.03'/></body></worldbody></mujoco>"
        );
        of_text(name, &text)
    };
    let [x, y] = joints;
    let comparison = compare_files(&of("a.xml", [x, y]), &of("b.xml", [y, x]), 10, 1, 1e-9).unwrap();
    has_causes(&comparison, &["b.xml has `x` and `y` in the other order"]);
}

#[test]
fn the_weight_of_a_free_base_is_a_force() {
    let comparison = compare_description(|robot| {
        robot.base = mozzi::Base::Floating;
        robot.links[0].inertia = mozzi::SpatialInertia::point_mass(1.0, Vec3::zero());
    });
    assert!(!comparison.agrees());
    let free = |mass: f64| {
        let text = CRANE.replace(
            r#"<link name="base"/>"#,
            &format!(
                r#"<link name="base"><inertial><mass value="{mass}"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>
                   </inertial></link>"#
            ),
        );
        let mut file = of_text("a.urdf", &text);
        file.model = file.model.description().clone().floating().build().unwrap();
        file
    };
    let comparison = compare_files(&free(4.0), &free(6.0), 10, 1, 1e-9).unwrap();
    let text = flat(&comparison);
    assert!(text.contains("gravity force of the base differs by up to 19.6 N, of "), "{text}");
}
