use super::super::{Header, Recognised, Request, own_names};
use super::*;

fn find(header: &str, order: &[&str]) -> std::result::Result<Recognised, String> {
    let model = mozzi_urdf::open("double_pendulum").expect("embedded").description.build().expect("sound");
    find_in(&model, header, order)
}

fn find_in(model: &Model, header: &str, order: &[&str]) -> std::result::Result<Recognised, String> {
    let header = Header::of(header.split(',').map(str::to_string).collect());
    let order: Vec<String> = order.iter().map(|name| (*name).to_string()).collect();
    let request = Request { order: &order, has_flags: true, ..Request::default() };
    Recognised::find("log", &header, model, &request).map_err(|failure| format!("{failure:?}"))
}

fn of(found: &Recognised, group: usize) -> Vec<usize> {
    found.groups[group].iter().flatten().flatten().map(|(column, _)| *column).collect()
}

#[test]
fn numbers_begin_where_they_are_complete() {
    for text in ["t,q0,q1,tau0,tau1", "t,q1,q2,tau1,tau2", "t,q_1,q_2,tau_0,tau_1"] {
        let found = find(text, &[]).expect(text);
        assert_eq!((of(&found, THETA), of(&found, TAU)), (vec![1, 2], vec![3, 4]), "{text}");
    }
    assert!(find("t,q0,q1,q2,tau0,tau1", &[]).expect_err("three").contains("neither from 0 nor from 1"));
    assert!(find("t,q1,tau1,tau2", &[]).expect_err("one").contains("column q2 is missing, the position of joint2"));
}

#[test]
fn foreign_names_need_an_order() {
    let text = "t,pos_b,pos_a,effort_a,effort_b";
    let why = find(text, &[]).expect_err("foreign");
    assert!(why.contains("--order b,a") && why.contains("--lock joint1=POSITION"), "{why}");
    let found = find(text, &["a", "b"]).expect("columns");
    assert_eq!((of(&found, THETA), of(&found, TAU)), (vec![2, 1], vec![3, 4]));
    assert!(find(text, &["a", "a"]).expect_err("twice").contains("`a` twice"));
    let found = find("t,pos_arm_joint2,pos_arm_joint1,tau_joint1,tau_joint2", &[]).expect("endings");
    assert_eq!(of(&found, THETA), vec![2, 1]);
}

#[test]
fn one_kind_of_columns_is_preferred_and_two_of_one_kind_are_an_error() {
    let found = find("t,q1,q2,q_d[1],q_d[2],dq_d1,dq_d2,tau1,tau2,current_1,current_2", &[]).expect("columns");
    assert_eq!((of(&found, THETA), of(&found, DTHETA), of(&found, TAU)), (vec![1, 2], vec![], vec![7, 8]));
    assert!(found.notes.iter().any(|note| note.contains("`dq_d1` … are not used")), "{:?}", found.notes);
    let why = find("t,effort_joint1,theta_1,theta_2,tau_1,tau_2", &[]).expect_err("twice");
    assert!(why.contains("columns 2 and 5, `effort_joint1` and `tau_1`, both give the force of `joint1`"), "{why}");
    let why = find("t,theta_1,theta_2,dtheeta_1,tau_1,tau_2", &[]).expect_err("misspelt");
    assert!(why.contains("did you mean `dtheta_1`?"), "{why}");
    let why = find("t,q1_nm,q2_nm,tau_1,tau_2", &[]).expect_err("unit");
    assert!(why.contains("is a position in N m"), "{why}");
}

#[test]
fn units_are_those_of_the_joints() {
    let slider = r#"<robot name="s"><link name="b"/><link name="a"><inertial><mass value="1"/><inertia ixx="1" iyy="1"
        izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link><joint name="rail" type="prismatic"><parent link="b"/>
        <child link="a"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>"#;
    let slider = mozzi_urdf::parse("s.urdf", slider).expect("sound").description.build().expect("sound");
    for (header, parts) in [
        ("t,theta_1 [deg]", ["column 2 (`theta_1 [deg]`)", "a position in deg, and `rail` slides"]),
        ("t,theta_1,dtheta_1 [rpm]", ["column 3 (`dtheta_1 [rpm]`)", "such as m/s"]),
        ("t,theta_1,tau_1 [N m]", ["column 3 (`tau_1 [N m]`)", "such as N"]),
    ] {
        let why = find_in(&slider, header, &[]).expect_err(header);
        assert!(parts.iter().all(|part| why.contains(part)), "{why}");
    }
    assert!(find_in(&slider, "t,theta_1 [mm],dtheta_1 [mm/s],tau_1 [N]", &[]).is_ok());
    for (header, part) in [
        ("t,theta_1 [mm],theta_2 [deg]", "a position in mm, and `joint1` turns"),
        ("t,theta_1,theta_2,tau_1 [N m],tau_2 [N]", "a force in N, and `joint2` turns"),
        ("t,theta_1,theta_2,ddtheta_1 [m/s2],ddtheta_2", "such as rad/s²"),
    ] {
        let why = find(header, &[]).expect_err(header);
        assert!(why.contains(part), "{why}");
    }
}

/// A pose without its quaternion: no joint can be locked for it.
#[test]
fn a_base_is_no_joint_to_lock() {
    let fixed = mozzi_urdf::open("double_pendulum").expect("embedded").description.build().expect("sound");
    let model = fixed.with_base(mozzi::model::Base::Floating).expect("floating");
    let own = |group: usize, from: usize| own_names(&model, group)[from..].join(",");
    let why = find_in(&model, &format!("t,{},{}", own(THETA, 4), own(TAU, 0)), &[]).expect_err("no quaternion");
    assert!(why.contains("is missing") && !why.contains("--lock"), "{why}");
    let why = find_in(&model, &format!("t,{},{}", own(THETA, 0), own(TAU, 0)).replace(",theta_joint1", ""), &[]);
    assert!(!why.expect_err("no joint1").contains("--lock base"));
}
