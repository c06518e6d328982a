//! Joints of several degrees of freedom: floating bases and planar joints, and the joints that replace them.
#![allow(clippy::unwrap_used)]

use mozzi::conventions::Pinocchio;
use mozzi::model::description::JointKind;
use mozzi::{Base, Twist};
use mozzi_urdf::{Policy, parse_with};

const BODY: &str = "<inertial><origin xyz='0.1 0 0'/><mass value='2'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial>";

/// A robot `r` of links `a`, `b` and `c`, where c hangs on b by a hinge; it loads without diagnostics.
fn robot(joint: &str) -> mozzi::Description {
    let hinge = "<joint name='hinge' type='continuous'><parent link='b'/><child link='c'/><axis xyz='0 1 0'/></joint>";
    let text = format!(
        "<robot name='r'><link name='a'/>{hinge}{joint}<link name='b'>{BODY}</link><link name='c'>{BODY}</link></robot>"
    );
    parse_with("r.urdf", &text, Policy::Strict).unwrap_or_else(|error| panic!("{error}")).description
}

#[test]
fn a_floating_root_joint_frees_the_base() {
    let description = robot("<joint name='j' type='floating'><parent link='a'/><child link='b'/></joint>");
    assert_eq!(description.base, Base::Floating);
    assert_eq!((description.free_joint.name.as_str(), description.free_joint.parent.as_str()), ("j", "a"));
    let model = description.build().unwrap();
    assert_eq!((model.n(), model.nq()), (7, 8));
    assert_eq!(model.velocity_names().last(), Some("hinge"));
    assert_eq!(model.mass_matrix(&model.neutral_configuration::<f64>()).unwrap()[(3, 3)], 4.0);
    assert_eq!(model.frames().map(|(_, name)| name.to_string()).collect::<Vec<_>>(), ["b", "c"]);
}

#[test]
fn a_planar_joint_is_two_slides_and_a_turn() {
    let planar = |axis: &str| {
        let joint =
            "<joint name='j' type='planar'><parent link='a'/><child link='b'/><origin xyz='0 0 1' rpy='0 0 0.5'/>";
        robot(&format!("{joint}{axis}</joint>")).build().unwrap()
    };
    // URDF's default axis is x: the plane's x is then the frame's y
    for (axis, x, y, turn) in [
        ("<axis xyz='0 0 1'/>", [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]),
        ("<axis xyz='0 1 0'/>", [1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]),
        ("", [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]),
    ] {
        let model = planar(axis);
        assert_eq!(model.joint_names().collect::<Vec<_>>(), ["j.x", "j.y", "j.theta", "hinge"]);
        let at = [0.3, -0.2, 0.7, 0.1];
        let found = model.forward_kinematics(&at, model.frame("b").unwrap()).unwrap();
        let origin = mozzi::SE3 { R: mozzi::SO3::from_rpy(0.0, 0.0, 0.5), p: mozzi::Vec3([0.0, 0.0, 1.0]) };
        let slide = mozzi::SE3::translation([0, 1, 2].map(|k: usize| 0.3 * x[k] - 0.2 * y[k]));
        let turn = mozzi::SE3::exp(Twist { w: mozzi::Vec3(turn) * 0.7, v: mozzi::Vec3::zero() });
        let expected = origin * slide * turn;
        let (found, expected) = (found.to_matrix(), expected.to_matrix());
        let apart = found.as_flattened().iter().zip(expected.as_flattened()).map(|(a, b)| (a - b).abs());
        assert!(apart.fold(0.0, f64::max) < 1e-15, "{axis}");
        // regular, though two links are massless
        let tau = model.inverse_dynamics(&at, &[0.1; 4], &[0.5; 4], &model.environment()).unwrap();
        let again = model.forward_dynamics(&at, &[0.1; 4], tau.as_slice(), &model.environment()).unwrap();
        assert!(again.iter().all(|x| (x - 0.5).abs() < 1e-13), "{again}");
    }
}

/// With the axis z, q would have Pinocchio's form, but velocities, forces and matrices would not.
#[test]
fn pinocchios_planar_joint_is_refused_by_name() {
    let joint = "<joint name='j' type='planar'><parent link='a'/><child link='b'/><axis xyz='0 0 1'/></joint>";
    let model = robot(joint).build().unwrap();
    for made in [Pinocchio::new(&model), Pinocchio::with_joints(&model, &["j", "hinge"], &[4, 2])] {
        let message = made.unwrap_err().to_string();
        assert!(message.contains("planar joint `j`") && message.contains("axes that turn"), "{message}");
    }
    let parts = Pinocchio::with_joints(&model, &["j.x", "j.y", "j.theta", "hinge"], &[1, 1, 2, 2]).unwrap();
    assert_eq!(parts.nq(), 6);
}

#[test]
fn mimic_joints_of_a_planar_joint_name_its_parts() {
    let text = "<robot name='r'><link name='a'/><link name='b'/><link name='c'/>\
                <joint name='j' type='planar'><parent link='a'/><child link='b'/><axis xyz='0 0 1'/></joint>\
                <joint name='k' type='continuous'><parent link='a'/><child link='c'/><mimic joint='j'/></joint></robot>";
    let error = parse_with("r.urdf", text, Policy::Default).unwrap_err();
    let [found] = error.errors().collect::<Vec<_>>()[..] else { panic!("{error}") };
    assert_eq!(
        found.message(),
        "joint `k`: mimic: there is no joint `j`, expected one of `j.x`, `j.y`, `j.theta`, `k`"
    );
    let text = text.replace("mimic joint='j'", "mimic joint='j.theta'");
    assert_eq!(parse_with("r.urdf", text, Policy::Default).unwrap().build().unwrap().n(), 3);
}

#[test]
fn a_free_body_is_the_base_and_the_world_is_left() {
    let text = "<mujoco model='m'><worldbody><site name='mark'/><geom type='plane' size='1 1 1'/><body name='post'/>\
                <body name='trunk' pos='0 0 1' childclass='main'><freejoint name='root'/><geom size='0.1' mass='2'/>\
                <body name='leg' pos='0 0 -1'><joint name='hip' axis='1 0 0'/><geom size='0.1' mass='1'/><site name='foot'/></body></body>\
                <body name='lamp'><site/></body></worldbody></mujoco>";
    let robot = parse_with("m.xml", text, Policy::Strict).unwrap();
    let said: Vec<&str> = robot.unused.iter().map(|unused| unused.message()).collect();
    assert_eq!(
        said,
        [
            "site `mark`: does not move, and is ignored next to the free body `trunk`",
            "body `post`: does not move, and is ignored next to the free body `trunk` (here, and 1 more)",
        ]
    );
    let d = &robot.description;
    assert_eq!((d.base, d.free_joint.name.as_str(), d.free_joint.parent.as_str()), (Base::Floating, "root", "world"));
    let model = robot.build().unwrap();
    assert_eq!(model.frames().map(|(_, name)| name.to_string()).collect::<Vec<_>>(), ["trunk", "leg", "foot"]);
    assert_eq!(model.position_names().last(), Some("hip"));
    let at = [1.0, 0.0, 0.0, 0.0, 3.0, 0.0, 1.0, 0.0];
    let foot = model.forward_kinematics(&at, model.frame("foot").unwrap()).unwrap();
    assert_eq!(foot.p.0, [3.0, 0.0, 0.0]);
    // it starts where the file puts it
    let start = model.start();
    assert_eq!(start.theta, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    assert_eq!((model.description().start.as_deref(), start.dtheta), (Some("qpos0"), vec![0.0; 7]));
}

#[test]
fn a_floating_joint_inside_the_tree_is_a_free_joint() {
    let text = "<robot name='r'><link name='base'><inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>\
                <link name='box'><inertial><mass value='2'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link>\
                <joint name='j' type='floating'><origin xyz='0 0 3'/><parent link='base'/><child link='box'/></joint></robot>";
    let robot = parse_with("r.urdf", text, Policy::Strict).unwrap();
    assert_eq!((robot.description.base, robot.description.joints[0].kind), (Base::Fixed, JointKind::Free));
    let again = parse_with("r.urdf", mozzi_urdf::write(&robot.description).unwrap(), Policy::Strict).unwrap();
    assert_eq!(again.description.joints, robot.description.joints);
    let model = robot.build().unwrap();
    assert_eq!((model.nq(), model.n()), (7, 6));
    assert_eq!(model.velocity_names().collect::<Vec<_>>(), ["j.wx", "j.wy", "j.wz", "j.vx", "j.vy", "j.vz"]);
    let at = model.forward_kinematics(&model.neutral_configuration::<f64>(), model.frame("box").unwrap()).unwrap();
    assert_eq!(at.p.0, [0.0, 0.0, 3.0]);
}

#[test]
fn balls_and_several_free_bodies_of_mjcf() {
    let text = "<mujoco model='m'><compiler angle='radian'/><worldbody><body name='cup' pos='1 0 2'><freejoint/><geom size='0.1' mass='2'/></body>\
                <body name='arm' pos='0 0 1'><joint name='shoulder' type='ball' pos='0 0 0.2' damping='0.5' armature='0.1' range='0 1.5'/>\
                <geom size='0.1' pos='0.3 0 0' mass='1'/></body><body name='lid'><joint name='slip' type='free' damping='3'/><geom size='0.1' mass='1'/>\
                </body></worldbody></mujoco>";
    let robot = parse_with("m.xml", text, Policy::Default).unwrap();
    let d = &robot.description;
    assert_eq!((d.base, d.links[0].name.as_str()), (Base::Fixed, "world"));
    let shoulder = d.joints.iter().find(|joint| joint.name == "shoulder").unwrap();
    assert_eq!(shoulder.kind, JointKind::Ball(mozzi::Vec3([0.0, 0.0, 0.2])));
    assert_eq!((shoulder.limits.position, shoulder.damping, shoulder.armature), (Some([0.0, 1.5]), 0.5, 0.1));
    assert_eq!(d.joints.iter().find(|joint| joint.name == "slip").unwrap().damping, 3.0);
    let model = robot.build().unwrap();
    assert_eq!((model.nq(), model.n()), (18, 15));
    assert_eq!(model.position_names().nth(7), Some("shoulder.qw"));
    assert_eq!(model.velocity_names().next(), Some("cup:free.wx"));
    // the pose of a free body is that in the world
    let mut theta = model.neutral_configuration::<f64>();
    theta[4..7].copy_from_slice(&[3.0, 4.0, 5.0]);
    assert_eq!(model.forward_kinematics(&theta, model.frame("cup").unwrap()).unwrap().p.0, [3.0, 4.0, 5.0]);
}
