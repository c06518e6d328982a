//! Inertias that are divided among links in another way, or of another density.

use crate::{compare_description, flat, has_cause, of_text, robot};
use mozzi::{Description, SpatialInertia};
use mozzi_report::compare::files::{RobotFile, compare_files};

pub fn place(robot: &Description, link: &str) -> usize {
    robot.links.iter().position(|each| each.name == link).unwrap()
}

/// Adds `tool` to `lower`; `center` may move its centre of mass in the frame of `lower`.
pub fn merge(robot: &mut Description, center: impl Fn(mozzi::SE3, SpatialInertia) -> SpatialInertia) {
    let (lower, tool) = (place(robot, "lower"), place(robot, "tool"));
    let T = robot.joints.iter().find(|joint| joint.name == "mount").unwrap().origin;
    robot.links[lower].inertia = robot.links[lower].inertia + center(T, robot.links[tool].inertia);
    robot.links[tool].inertia = SpatialInertia::zero();
}

#[test]
fn a_merged_link_whose_frame_is_kept() {
    let comparison = compare_description(|robot| merge(robot, |T, G| G.transformed(T)));
    let text = flat(&comparison);
    assert!(comparison.agrees() && comparison.causes().next().is_none(), "{text}");
    assert!(text.contains("note: b.urdf merges `tool` into `lower`: the same body"), "{text}");
    assert_eq!(comparison.json()["notes"].as_array().unwrap().len(), 1);
}

#[test]
fn a_merged_link_that_one_file_lacks() {
    let before = robot("before.urdf");
    let mut description = before.model.description().clone();
    merge(&mut description, |T, G| G.transformed(T));
    description.links.retain(|link| link.name != "tool");
    description.joints.retain(|joint| joint.name != "mount");
    let after = RobotFile { name: "b.urdf".into(), model: description.build().unwrap(), ..before.clone() };
    for [a, b] in [[&before, &after], [&after, &before]] {
        let comparison = compare_files(a, b, 5, 1, 1e-9).unwrap();
        let text = flat(&comparison);
        assert!(
            comparison.agrees() && text.contains("note: b.urdf merges `tool` into `lower`: the same body"),
            "{text}"
        );
    }
}

#[test]
fn a_link_without_mass_that_one_file_lacks_is_merged_by_none() {
    let robot = |name: &str, tool: &str| {
        of_text(
            name,
            &format!(
                "<robot name='r'><link name='base'/><link name='arm'><inertial><mass value='1'/><origin xyz='0.1 0 0'/>\
                 <inertia ixx='0.1' iyy='0.1' izz='0.1' ixy='0' ixz='0' iyz='0'/></inertial></link><joint name='j' \
                 type='continuous'><parent link='base'/><child link='arm'/><axis xyz='0 1 0'/></joint>{tool}</robot>"
            ),
        )
    };
    let tool = "<joint name='t' type='fixed'><parent link='arm'/><child link='tool0'/></joint><link name='tool0'/>";
    let (with, without) = (robot("with.urdf", tool), robot("without.urdf", ""));
    for [a, b] in [[&with, &without], [&without, &with]] {
        let comparison = compare_files(a, b, 5, 1, 1e-9).unwrap();
        let notes = comparison.json()["notes"].clone();
        assert_eq!(notes, serde_json::json!(["frame of with.urdf only: `tool0`"]));
        assert!(comparison.agrees(), "{}", comparison.text());
    }
}

#[test]
fn a_centre_of_mass_that_is_not_rotated() {
    let comparison = compare_description(|robot| {
        merge(robot, |T, G| {
            let I = G.about_center_of_mass().congruence(T.R.matrix());
            SpatialInertia::new(G.mass, T.p + G.center_of_mass(), I)
        });
        robot.links.retain(|link| link.name != "tool");
        robot.joints.retain(|joint| joint.name != "mount");
    });
    has_cause(&comparison, "merges `tool` into `lower` without rotating its centre of mass by its fixed joint", true);
}

#[test]
fn another_density() {
    let comparison = compare_description(|robot| {
        let upper = place(robot, "upper");
        robot.links[upper].inertia = robot.links[upper].inertia * 2.7;
    });
    has_cause(
        &comparison,
        "b.urdf has `upper` of another density: 5.4 kg instead of 2 kg, mass and moments by 2.7",
        true,
    );
}

/// Puts `left_` before all names, as where the robot is a part of another.
pub fn prefixed(robot: &mut Description) {
    let prefix = |name: &mut String| *name = format!("left_{name}");
    robot.links.iter_mut().for_each(|link| prefix(&mut link.name));
    robot.frames.iter_mut().for_each(|frame| [&mut frame.name, &mut frame.link].into_iter().for_each(prefix));
    for joint in &mut robot.joints {
        [&mut joint.name, &mut joint.parent, &mut joint.child].into_iter().for_each(prefix);
        joint.mimic.iter_mut().for_each(|mimic| prefix(&mut mimic.joint));
    }
    robot.end_effector.iter_mut().for_each(prefix);
}

#[test]
fn links_with_a_prefix_keep_their_causes() {
    let same = compare_description(prefixed);
    let text = flat(&same);
    assert!(same.agrees() && text.contains("`upper` is `left_upper`"), "{text}");
    let dense = compare_description(|robot| {
        let upper = place(robot, "upper");
        robot.links[upper].inertia = robot.links[upper].inertia * 2.7;
        prefixed(robot);
    });
    has_cause(&dense, "has `upper` of another density", true);
    let dropped = compare_description(|robot| {
        robot.links.retain(|link| link.name != "tool");
        robot.joints.retain(|joint| joint.name != "mount");
        prefixed(robot);
    });
    has_cause(&dropped, "drops `tool`, with its mass, from the body of `lower`", true);
}
