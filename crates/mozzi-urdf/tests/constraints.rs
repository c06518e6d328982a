//! Constraints of MJCF against MuJoCo's own Jacobians, of Drake's words, and of files of their own.
#![allow(clippy::unwrap_used)]

use crate::common;

use common::{repository, vector};
use mozzi::constraints::constraint_jacobian;
use mozzi::conventions::MuJoCo;
use mozzi::model::description::{Anchor, Closure, Constraint, ConstraintKind};
use mozzi::{Description, Model, SE3, Vec3, Workspace};
use mozzi_urdf::{Policy, constraints, load, parse, parse_with, write};
use nalgebra::{DMatrix, DVector};
use serde_json::Value;
use std::path::PathBuf;

/// A and φ.
pub fn rows(model: &Model, theta: &[f64]) -> (DMatrix<f64>, DVector<f64>) {
    let (m, n) = (model.constraint_row_names().count(), model.n());
    let (mut A, mut bias, mut phi) = (vec![0.0; m * n], vec![0.0; m], vec![0.0; m]);
    let rest = vec![0.0; n];
    constraint_jacobian(model, theta, &rest, &mut Workspace::new(model), &mut A, &mut bias, &mut phi);
    (DMatrix::from_row_slice(m, n, &A), DVector::from_vec(phi))
}

/// The axes of anchor {a} in the world.
fn axes(model: &Model, theta: &[f64], a: &Anchor) -> DMatrix<f64> {
    let frame = a
        .frame
        .as_ref()
        .map_or(SE3::identity(), |name| model.forward_kinematics(theta, model.frame(name).unwrap()).unwrap());
    let T = (frame * a.T).to_matrix();
    DMatrix::from_fn(3, 3, |i, j| T[i][j])
}

/// MuJoCo's rows of a constraint from mozzi's: see CONVENTIONS.md.
fn as_mujoco(model: &Model, theta: &[f64], one: &Constraint, A: &DMatrix<f64>, torquescale: f64) -> DMatrix<f64> {
    match &one.kind {
        ConstraintKind::Joint { .. } => A.clone(),
        ConstraintKind::Frames { a, closure: Closure::Point, .. } => -axes(model, theta, a) * A,
        ConstraintKind::Frames { a, closure: Closure::Weld, .. } => {
            let (w, v) = (A.rows(0, 3), A.rows(3, 3));
            let mut theirs = DMatrix::zeros(6, A.ncols());
            theirs.rows_mut(0, 3).copy_from(&(-axes(model, theta, a) * v));
            theirs.rows_mut(3, 3).copy_from(&(w * (-0.5 * torquescale)));
            theirs
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn equalities_are_those_of_mujoco() {
    for (name, scales, count) in
        [("loops", [1.0, 0.7, 1.0, 1.0].as_slice(), 11), ("feet", &[1.0; 3], 12), ("tendons", &[1.0; 2], 2)]
    {
        let folder = repository().join("oracles/constraints");
        let loaded = load(folder.join(format!("{name}.xml"))).unwrap();
        assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
        let model = loaded.build().unwrap();
        let oracle: Value =
            serde_json::from_str(&std::fs::read_to_string(folder.join(format!("{name}.json"))).unwrap()).unwrap();
        let states = oracle["states"].as_array().unwrap();
        assert_eq!(states.len(), 4);
        for state in states {
            let qpos = vector(&state["qpos"]);
            let convention = MuJoCo::new(&model);
            let theta = convention.from_configuration(&qpos).unwrap();
            let theta = theta.as_slice();
            let (A, phi) = rows(&model, theta);
            assert_eq!(A.nrows(), count);
            assert!(phi.amax() < 1e-11, "{name}: {phi}");
            // a column of MuJoCo's for each of its velocities
            let columns = (0..model.n()).map(|j| {
                let mut qvel = vec![0.0; model.n()];
                qvel[j] = 1.0;
                &A * convention.from_velocity(&qpos, &qvel).unwrap()
            });
            let A = DMatrix::from_columns(&columns.collect::<Vec<_>>());
            let mut first = 0;
            let theirs = state["equalities"].as_array().unwrap();
            assert_eq!(theirs.len(), model.constraints().len());
            for ((one, theirs), scale) in model.constraints().iter().zip(theirs).zip(scales) {
                assert_eq!(theirs["name"].as_str().unwrap(), one.name);
                let own = A.rows(first, one.row_names().len()).clone_owned();
                first += own.nrows();
                let found = as_mujoco(&model, theta, one, &own, *scale);
                let J = theirs["J"].as_array().unwrap();
                let J = DMatrix::from_fn(J.len(), model.n(), |i, j| J[i][j].as_f64().unwrap());
                assert!((&found - &J).amax() < 1e-10, "{name} {}: {found} {J}", one.name);
            }
        }
    }
}

#[test]
fn soft_parameters_are_noted_and_unnamed_ones_numbered() {
    let text = "<mujoco><worldbody><body name='a'><joint name='j'/><geom size='1'/></body></worldbody><equality>\
         <connect body1='a' anchor='0 0 1' solref='0.1 1'/><weld body1='a' torquescale='3' solimp='1'/>\
         <weld body1='a' relpose='0 0 0 0 0 0 0'/><weld body1='a' torquescale='0'/></equality></mujoco>";
    let loaded = parse("a.xml", text).unwrap();
    let unused: Vec<&str> = loaded.unused.iter().map(|found| found.message()).collect();
    assert_eq!(unused, ["connect: `solref` is ignored", "weld: `torquescale` is ignored", "weld: `solimp` is ignored"]);
    let names: Vec<&str> = loaded.description.constraints.iter().map(|one| one.name.as_str()).collect();
    assert_eq!(names, ["connect0", "weld1", "weld2", "weld3"]);
    let closures = loaded.description.constraints.iter().map(|one| match &one.kind {
        ConstraintKind::Frames { closure, .. } => *closure,
        other => panic!("{other:?}"),
    });
    let expected = [Closure::Point, Closure::Weld, Closure::Weld, Closure::Point];
    assert_eq!(closures.collect::<Vec<_>>(), expected, "a weld that turns nothing is a point");
    let ConstraintKind::Frames { a, b, closure } = &loaded.description.constraints[0].kind else { panic!() };
    assert_eq!((a.frame.as_deref(), &b.frame, closure), (Some("a"), &None, &Closure::Point));
    assert_eq!((a.T.p, b.T.p), (Vec3([0.0, 0.0, 1.0]), Vec3([0.0, 0.0, 1.0])));
    // a tied tendon without length
    let text = "<mujoco><worldbody><body><joint name='j'/><geom size='1'/></body></worldbody><tendon><fixed name='t'>\
         <joint joint='j' coef='0'/></fixed></tendon><equality><tendon tendon1='t'/></equality></mujoco>";
    let error = parse("a.xml", text).unwrap_err().to_string();
    assert!(error.contains("tendon1: is a tendon of length 0, expected a `coef` other than 0"), "{error}");
    // a second coupling of a joint is a constraint
    let text = "<mujoco><worldbody><body><joint name='a'/><joint name='b' axis='0 1 0' ref='90'/><joint name='c' axis='1 0 0'/>\
         <geom size='1'/></body></worldbody><equality><joint joint1='b' joint2='a'/>\
         <joint name='again' joint1='b' joint2='c' polycoef='0.1 2'/></equality></mujoco>";
    let model = parse("a.xml", text).unwrap().build().unwrap();
    let turn = std::f64::consts::FRAC_PI_2;
    let again = Constraint::joint("again", "b", "c", [turn + 0.1, 2.0, 0.0, 0.0, 0.0]);
    assert_eq!(model.constraints(), [again]);
    // θ_b = θ_a + π/2 is a mimic joint's
    let (A, phi) = rows(&model, &[0.3, 0.2]);
    assert!((phi[0] - (0.3 + turn - (turn + 0.1 + 0.4))).abs() < 1e-15 && A.as_slice() == [1.0, -2.0], "{phi} {A}");
}

/// The triangle of two links that Drake's ball constraint closes.
fn drake(more: &str) -> String {
    format!(
        "<robot name='loop' xmlns:drake='https://drake.mit.edu'><link name='a'/><link name='b'/><link name='c'><inertial>\
         <mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial></link>\
         <joint name='j' type='continuous'><parent link='a'/><child link='b'/><axis xyz='0 0 1'/></joint>\
         <joint name='k' type='continuous'><parent link='b'/><child link='c'/><origin xyz='1 0 0'/><axis xyz='0 0 1'/></joint>\
         <drake:ball_constraint><drake:ball_constraint_body_A name='c'/><drake:ball_constraint_body_B name='a'/>\
         <drake:ball_constraint_p_AP value='0 1 0'/><drake:ball_constraint_p_BQ value='1 1 0'/></drake:ball_constraint>\
         {more}</robot>"
    )
}

#[test]
fn a_ball_constraint_of_drake_is_read_and_written() {
    let loaded = parse_with("r.urdf", drake(""), Policy::Strict).unwrap();
    let robot = loaded.description.clone();
    let point = |name: &str, p| Anchor::frame(name).at(SE3::translation(p));
    let expected = Constraint::point("ball_constraint0", point("c", [0.0, 1.0, 0.0]), point("a", [1.0, 1.0, 0.0]));
    assert_eq!(robot.constraints, [expected]);
    let model = loaded.build().unwrap();
    assert!(rows(&model, &[0.0, 0.0]).1.amax() == 0.0 && model.constraint_rank(&[0.1, 0.2]).unwrap().rank == 2);
    let text = write(&robot).unwrap();
    assert_eq!(parse_with("w.urdf", &text, Policy::Strict).unwrap().description, robot, "{text}");
    // it has no other name, and no other kind
    let named = Constraint { name: "foot".into(), ..robot.constraints[0].clone() };
    let of_name = "the name of constraint `foot`, which is read as `ball_constraint0`";
    let weld = Constraint::weld("ball_constraint0", "c", "a");
    for (other, reason) in [(named, of_name), (weld, "constraint `ball_constraint0`")] {
        let changed = Description { constraints: vec![other], ..robot.clone() };
        assert_eq!(write(&changed).unwrap_err().reasons, [reason]);
    }
    // bushings and tendons remain warnings by name
    let loaded = parse("r.urdf", drake("<drake:linear_bushing_rpy/><drake:tendon_constraint/>")).unwrap();
    assert_eq!(loaded.warnings.len(), 2);
    // the parent link of a floating base is {s}
    let free = drake("<link name='w'/><joint name='f' type='floating'><parent link='w'/><child link='a'/></joint>")
        .replace("body_B name='a'", "body_B name='w'");
    let robot = parse("r.urdf", free).unwrap().description;
    let ConstraintKind::Frames { b, .. } = &robot.constraints[0].kind else { panic!() };
    assert_eq!(b.frame, None);
}

const FILE: &str = r#"{"constraints": [
  {"name": "foot", "kind": "point", "a": {"frame": null, "xyz": [0.3, 0.1, 0], "rpy": [0, 0, 1.5]}, "b": {"frame": "c"}},
  {"name": "rod", "kind": "distance", "length": 0.4, "a": {"frame": "b"}, "b": {"frame": "c", "xyz": [1e-3, -2, 0]}},
  {"name": "wheel", "kind": "rolling", "radius": 5e-1, "a": {"frame": null}, "b": {"frame": "c"}},
  {"name": "gear", "kind": "joint", "joint": "k", "source": "j", "polynomial": [0, -2]},
  {"name": "stop", "kind": "joint", "joint": "k", "polynomial": [0.5]},
  {"name": "sum", "kind": "joint", "joint": [{"joint": "j", "ratio": 0.1}, {"joint": "k", "ratio": -3}], "polynomial": [1]}],
 "motors": ["j"]}"#;

fn plain() -> Description {
    let mut robot = parse("r.urdf", drake("")).unwrap().description;
    robot.constraints.clear();
    robot
}

#[test]
fn a_file_of_constraints_adds_them() {
    let robot = constraints::parse("c.json", FILE, plain()).unwrap();
    let kinds: Vec<&str> = robot.constraints.iter().map(Constraint::kind_name).collect();
    assert_eq!(kinds, ["point", "distance", "rolling", "joint", "joint", "joint"]);
    assert_eq!(robot.motors, Some(vec!["j".to_string()]));
    let ConstraintKind::Frames { a, .. } = &robot.constraints[0].kind else { panic!() };
    assert_eq!((a.T.p, a.T.R), (Vec3([0.3, 0.1, 0.0]), mozzi::SO3::from_rpy(0.0, 0.0, 1.5)));
    assert_eq!(robot.constraints[3], Constraint::joint("gear", "k", "j", [0.0, -2.0, 0.0, 0.0, 0.0]));
    robot.clone().build().unwrap();
    // a round trip is exact to the bit; a second file adds to the first
    let text = constraints::write(&robot);
    let again = constraints::parse("w.json", &text, plain()).unwrap();
    assert_eq!(again, robot);
    let twice = constraints::parse("w.json", &text, robot).unwrap_err().to_string();
    assert!(twice.starts_with("w.json:1:") && twice.contains("constraint `foot`"), "{twice}");
    // the same in YAML
    let yaml =
        "constraints:\n  - name: foot\n    kind: hinge\n    a: {frame: null}\n    b: {frame: c, xyz: [0, .5, -1.]}\n";
    let robot = constraints::parse("c.yaml", yaml, plain()).unwrap();
    let b = Anchor::frame("c").at(SE3::translation([0.0, 0.5, -1.0]));
    assert_eq!(robot.constraints, [Constraint::hinge("foot", Anchor::world(SE3::identity()), b)]);
}

#[test]
fn what_is_wrong_in_a_file_has_its_place() {
    for (from, to, expected) in [
        ("\"length\": 0.4, ", "", "3:3: `length` is missing in constraints[1]"),
        ("\"point\"", "\"pin\"", "2:20: constraints[0].kind is \"pin\", expected one of `point`, `weld`"),
        (
            "\"xyz\": [0.3, 0.1, 0]",
            "\"xyz\": [0.3, 0.1]",
            "2:58: constraints[0].a.xyz is [0.3,0.1], expected 3 numbers",
        ),
        ("\"rpy\"", "\"rypy\"", "`rypy` is not an entry of constraints[0].a, did you mean `rpy`?"),
        ("1e-3", "\"1e-3\"", "constraints[1].b.xyz[0] is \"1e-3\", expected a number"),
        ("\"motors\": [\"j\"]", "\"motors\": [\"q\"]", "8:2: robot `loop`: motors: hold `q`, which does not exist"),
        ("{\"frame\": \"c\"}}", "{\"frame\": \"q\"}}", "2:3: constraint `foot`: b: there is no link or frame `q`"),
        ("0.4", "-0.4", "3:3: constraint `rod`: length: is -0.4 m"),
        ("[0.5]", "[0.5, 1]", "constraints[4].polynomial is [0.5,1], expected one number"),
        (
            "\"ratio\": -3",
            "\"ratio\": 0",
            "constraint `sum`: joint: has `k` times 0, expected a finite number other than 0",
        ),
        ("\"joint\": \"k\", \"ratio\"", "\"joint\": \"j\", \"ratio\"", "constraint `sum`: joint: has `j` twice"),
        ("\"ratio\": -3", "\"rate\": -3", "`rate` is not an entry of constraints[5].joint[1]"),
        (
            "\"joint\": \"k\", \"polynomial\"",
            "\"joint\": [], \"polynomial\"",
            "is [], expected a joint, or a list of joints",
        ),
        ("\"gear\"", "\"rod\"", "constraint `rod`"),
        ("{\"frame\": null, \"xyz\"", "{\"xyz\"", "`frame` is missing in constraints[0].a"),
        (
            "\"constraints\"",
            "\"constraint\"",
            "1:2: `constraint` is not an entry of the file, did you mean `constraints`?",
        ),
    ] {
        assert!(FILE.contains(from), "{from}");
        let error = constraints::parse("c.json", &FILE.replacen(from, to, 1), plain()).unwrap_err().to_string();
        assert!(error.starts_with("c.json:") && error.contains(expected), "{to}: {error}");
    }
}

/// The mechanisms of ../shared, if it exists.
#[test]
fn parallel_robots_close() {
    let folder = repository().join("../shared/data/parallel-robots");
    if !folder.exists() {
        println!("skipped: no shared data");
        return;
    }
    // freedoms by counting: planar five bars 2, …
    for (name, welds, motors) in [
        ("5bar_linkage", 1, 2),
        ("cassie_like", 2, 5),
        ("digit_like", 3, 6),
        ("robot_delta", 3, 2),
        ("talos_like", 1, 6),
    ] {
        let file = |ending: &str| -> PathBuf { folder.join(name).join(format!("robot.{ending}")) };
        let tree = load(file("urdf")).unwrap().description;
        let model = constraints::read(file("yaml"), tree.clone()).unwrap().build().unwrap();
        assert!(model.constraints().iter().all(|one| one.kind_name() == "weld"));
        assert_eq!((model.constraints().len(), model.motors().len()), (welds, motors), "{name}");
        let theta = model.assemble(&vec![0.05; model.nq()], &[]).unwrap();
        assert!(rows(&model, &theta).1.amax() < 1e-11);
        let rank = model.constraint_rank(&theta).unwrap();
        println!("{name}: n {} rows {} rank {} freedom {}", model.n(), rank.rows, rank.rank, rank.freedom);
        assert!(rank.rank + rank.freedom == model.n());
        let wrong =
            constraints::parse("robot.yaml", "closed_loop: [['nowhere', 'b']]\ntype: ['6d']", tree).unwrap_err();
        assert!(wrong.to_string().starts_with("robot.yaml:1:16: closed_loop[0][0] is `nowhere`"), "{wrong}");
    }
}

/// A crank with a follower, a rod on it, and a rod on the base whose tip meets that of the first.
const FOLLOWER: &str = r#"<robot name="r"><link name="base"/><link name="a"/><link name="b"/><link name="c"/><link name="d"/>
<joint name="mot_crank" type="continuous"><parent link="base"/><child link="a"/></joint>
<joint name="mot_rod" type="continuous"><parent link="a"/><child link="b"/><mimic joint="mot_crank" multiplier="-2"/></joint>
<joint name="free" type="continuous"><parent link="base"/><child link="c"/></joint>
<joint name="hip" type="revolute"><parent link="c"/><child link="d"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
</robot>"#;

#[test]
fn the_variants_of_robot_yaml_are_read() {
    let tree = mozzi_urdf::parse("r.urdf", FOLLOWER).unwrap().description;
    let read = |text: &str| constraints::parse("robot.yaml", text, tree.clone());
    for (kinds, expected) in
        [("\ntype: ['6D']", "weld"), ("\ntype: [3D]", "point"), ("", "weld"), ("\ntype: [3d]", "point")]
    {
        let robot = read(&format!("closed_loop: [[b, d]]{kinds}")).unwrap();
        assert_eq!(robot.constraints[0].kind_name(), expected, "{kinds}");
    }
    // a motor of a mimic joint drives the joint that it follows; a text is a part of the motors' names
    for (motors, expected) in [
        ("[mot_rod, free]", &["mot_crank", "free"][..]),
        ("[mot_rod, mot_crank]", &["mot_crank"]),
        ("mot", &["mot_crank"]),
    ] {
        let robot = read(&format!("closed_loop: []\ntype: []\nname_mot: {motors}")).unwrap();
        assert_eq!(robot.motors.as_deref().unwrap(), expected, "{motors}");
    }
    let robot = read("closed_loop: [[b, d]]\njoint_name: [hip, free]\njoint_type: [SPHERICAL, FIXED]").unwrap();
    let kinds: Vec<&str> = robot.joints.iter().map(|joint| joint.kind.name()).collect();
    assert_eq!((kinds[2], kinds[3], robot.joints[3].limits.position), ("fixed", "ball", None));
    for (text, expected) in [
        (
            "closed_loop: []\njoint_name: [hip]",
            "1:1: joint_type is null, expected one type for each joint of joint_name (1)",
        ),
        ("closed_loop: []\njoint_name: [hop]\njoint_type: [FIXED]", "2:14: joint_name[0] is `hop`, expected a joint"),
        (
            "closed_loop: []\njoint_name: [hip]\njoint_type: [SCREW]",
            "3:14: joint_type[0] is \"SCREW\", expected SPHERICAL",
        ),
        ("closed_loop: [[b, d]]\ntype: [5d]", "2:8: type[0] is \"5d\", expected `6d`"),
        ("closed_loop: [[b, d]]\ntype: [6d, 6d]", "expected one type for each pair of closed_loop (1)"),
        ("closed_loop: [[b, d]]\ntyp: [6d]", "`typ` is not an entry of the file, did you mean `type`?"),
    ] {
        let said = read(text).unwrap_err().to_string();
        assert!(said.contains(expected), "{text}: {said}");
    }
}
