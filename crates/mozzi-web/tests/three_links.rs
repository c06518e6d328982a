//! Robots whose links are in another order, or whose joints follow each other.
#![cfg(feature = "play")]

use crate::play::{input, opened, play};
use mozzi_web::Session;
use serde_json::json;

/// Three links in a row, in some order, with a fixed or a floating base; the second joint may follow the first.
fn three_links(order: &str, mimic: bool, is_floating: bool) -> (Session, usize) {
    let inertial = |mass: f64| {
        let moments = r#"<inertia ixx="0.3" iyy="0.2" izz="0.25" ixy="0" ixz="0" iyz="0"/>"#;
        format!(r#"<inertial><mass value="{mass}"/><origin xyz="0.1 0.05 0"/>{moments}</inertial>"#)
    };
    let link = |name: char| {
        let mass = if name == 'b' { 20.0 } else { 1.0 };
        format!(r#"<link name="{name}">{}</link>"#, inertial(mass))
    };
    let joint = |name: &str, parent: &str, child: &str, limit: f64, more: &str| {
        format!(
            r#"<joint name="{name}" type="revolute"><parent link="{parent}"/><child link="{child}"/>
            <origin xyz="0.5 0 0" rpy="0.7 0 0"/><axis xyz="0 1 0"/>
            <limit lower="-{limit}" upper="{limit}" effort="1" velocity="1"/>{more}</joint>"#
        )
    };
    let follows = if mimic { r#"<mimic joint="j"/>"# } else { "" };
    let joints = joint("j", "b", "a", 1.0, "") + &joint("k", "a", "c", 0.2, follows);
    let text = format!(r#"<robot name="r">{}{joints}</robot>"#, order.chars().map(link).collect::<String>());
    let mut session = Session::default();
    let (mut handle, _) = opened(&mut session, "r.urdf", &text);
    if is_floating {
        let floats = play(session.robot(handle).expect("open"), json!({ "do": "edit", "what": "floating" }));
        handle = opened(&mut session, "r.json", &floats.to_string()).0;
    }
    (session, handle)
}

#[test]
fn gains_of_a_floating_robot_do_not_depend_on_the_order_of_its_links() {
    let gains = ["bac", "acb"].map(|order| {
        let (mut session, handle) = three_links(order, false, true);
        let robot = session.robot(handle).expect("open");
        play(robot, json!({ "do": "set", "motors": "pd", "omega": 1, "zeta": 1 }))
    });
    assert_eq!(gains[0], gains[1]);
}

#[test]
fn mimic_joints_limit_their_source() {
    let (mut session, handle) = three_links("bac", true, false);
    let robot = session.robot(handle).expect("open");
    input(robot, "theta")[0] = 0.8;
    play(robot, json!({ "do": "within" }));
    assert_eq!(input(robot, "theta")[0], 0.2);
    play(robot, json!({ "do": "step", "step": 0.001, "steps": 5 }));
}
