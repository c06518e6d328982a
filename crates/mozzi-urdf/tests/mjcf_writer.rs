//! The MJCF writer: constraints become equalities and named states become keys; the reader reads the same robot.
#![allow(clippy::unwrap_used)]

use crate::constraints::rows;
use mozzi::model::description::{Anchor, Closure, Constraint, ConstraintKind, Gear};
use mozzi::random::state;
use mozzi::{Description, Model, SE3, Twist};
use mozzi_urdf::{mjcf, parse};

/// A free trunk, two legs of a ball, a hinge and a slide that follows it, a screw, and states.
const ROBOT: &str = "<mujoco><compiler angle='radian'/><worldbody><body name='trunk' pos='0 0 1'><freejoint name='float'/><geom size='0.1'/>
  <site name='eye' pos='0.1 0 0.2' euler='0.1 0.2 0.3'/>
  <body name='thigh'><joint name='ball' type='ball'/><geom size='0.1'/>
   <body name='shin' pos='0 0.1 -0.3'><joint name='knee'/><geom size='0.1'/></body>
   <body name='rod'><joint name='follows' type='slide'/><geom size='0.1'/></body></body>
  <body name='arm' pos='0 1 0' euler='0.3 0 0'><joint name='shoulder' axis='0 1 0'/><geom size='0.1'/>
   <body name='hand' pos='0 0 0.4'><joint name='wrist' axis='1 0 0'/><geom size='0.1'/></body></body>
 </body></worldbody><equality><joint joint1='follows' joint2='knee' polycoef='0.1 2 0 0 0'/></equality>
 <keyframe><key name='stands' time='2' qpos='1 2 3 0 1 0 0  0 0 1 0  0.3 0.7  -0.2 0.4' qvel='1 2 3 4 5 6  7 8 9  1 2  3 4'/></keyframe>
</mujoco>";

fn robot(constraints: Vec<Constraint>) -> Description {
    let mut robot = parse("r.xml", ROBOT).unwrap().description;
    robot.constraints = constraints;
    robot
}

/// The robot that is read from what is written, and the losses.
fn read_again(robot: &Description) -> (Description, Vec<String>) {
    let written = mjcf::write(robot).unwrap();
    (
        parse("w.xml", &written.text).unwrap_or_else(|error| panic!("{error}\n{}", written.text)).description,
        written.losses,
    )
}

/// Anchors of all kinds: a link, a frame as it is, a frame with an offset, the world.
fn anchors() -> [Anchor; 4] {
    let T = |x: f64| SE3::exp(Twist::from_array([0.3 * x, -0.2, 0.5, 0.1, x, -0.4]));
    [Anchor::frame("hand").at(T(1.0)), Anchor::frame("eye"), Anchor::frame("eye").at(T(2.0)), Anchor::world(T(-1.0))]
}

fn rows_are_alike(one: &Model, other: &Model) {
    for seed in 0..20 {
        let [theta, ..] = state(one, seed);
        let [(A, phi), (B, there)] = [one, other].map(|model| rows(model, &theta));
        assert!((&A - &B).amax() < 1e-13, "{A}{B}");
        // the rotation vector of a weld that is open by almost a half turn is ill-conditioned
        assert!((&phi - &there).amax() < 1e-10, "{phi}{there}");
    }
}

#[test]
fn points_welds_and_sums_of_joints_are_the_same_constraints() {
    let mut constraints = Vec::new();
    let all = anchors();
    for (k, b) in all.iter().enumerate() {
        let closure = [Closure::Point, Closure::Weld][k % 2];
        constraints.push(Constraint::new(format!("<tie {k}>"), Anchor::frame("shin"), b.clone(), closure));
    }
    let gear = |joint: &str, ratio: f64| Gear { joint: joint.into(), ratio };
    let sums = [
        (vec![gear("shoulder", 1.0)], vec![gear("wrist", 1.0)], [0.2, -1.5, 0.0, 0.0, 0.0]),
        (
            vec![gear("shoulder", 2.0), gear("knee", -1.0)],
            vec![gear("wrist", 0.5), gear("follows", 0.3)],
            [0.1, 1.0, 0.3, 0.0, 2.0],
        ),
        (vec![gear("wrist", 1.0)], vec![], [0.4, 0.0, 0.0, 0.0, 0.0]),
    ];
    for (k, (joints, source, polynomial)) in sums.into_iter().enumerate() {
        constraints
            .push(Constraint { name: format!("sum {k}"), kind: ConstraintKind::Joint { joints, source, polynomial } });
    }
    let before = robot(constraints);
    let (after, losses) = read_again(&before);
    assert!(losses.is_empty(), "{losses:?}");
    let names = |robot: &Description| robot.constraints.iter().map(|one| one.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&before), names(&after));
    rows_are_alike(&before.build().unwrap(), &after.build().unwrap());
}

#[test]
fn a_hinge_becomes_two_points_of_its_axis() {
    let [b, _, _, a] = anchors();
    let before = robot(vec![Constraint::hinge("pin", a, b)]);
    let (after, losses) = read_again(&before);
    assert_eq!(losses, ["constraint `pin`: a hinge, written as two points of its axis"]);
    // they forbid the same velocities where the hinge is closed, at some distance other ones: compared by their ranks
    let [one, two] = [before, after].map(|robot| robot.build().unwrap());
    let theta = one.assemble(&one.neutral_configuration::<f64>(), &[]).unwrap();
    let [A, B] = [&one, &two].map(|model| rows(model, &theta).0);
    let both = nalgebra::DMatrix::from_rows(&A.row_iter().chain(B.row_iter()).collect::<Vec<_>>());
    assert_eq!([&A, &B, &both].map(|rows| rows.rank(1e-9)), [5, 5, 5]);
}

#[test]
fn what_mujoco_has_not_is_told() {
    let [a, _, b, _] = anchors();
    let before = robot(vec![
        Constraint::distance("rope", a.clone(), b.clone(), 0.3),
        Constraint::rolling("wheel", Anchor::world(SE3::identity()), a, 0.1),
    ]);
    let (after, losses) = read_again(&before);
    assert!(after.constraints.is_empty());
    let expected =
        ["constraint `rope`: distance, which MuJoCo has not", "constraint `wheel`: rolling, which MuJoCo has not"];
    assert_eq!(losses, expected);
}

#[test]
fn named_states_are_keys() {
    let before = robot(Vec::new());
    let (after, losses) = read_again(&before);
    assert!(losses.is_empty(), "{losses:?}");
    let [one, two] = [&before, &after].map(|robot| robot.clone().build().unwrap());
    assert_eq!(one.state_names().collect::<Vec<_>>(), ["qpos0", "stands"]);
    assert_eq!(two.state_names().collect::<Vec<_>>(), ["qpos0", "stands"]);
    for name in ["qpos0", "stands"] {
        let [one, two] = [&one, &two].map(|model| model.state(name).unwrap());
        assert_eq!(one.time, two.time);
        let gap = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(gap(&one.theta, &two.theta) < 1e-15 && gap(&one.dtheta, &two.dtheta) < 1e-14, "{one:?} {two:?}");
    }
    assert_eq!(one.start(), two.start());
    // a start that bodies' poses do not express is a key, and no start
    let mut bent = before;
    bent.start = Some("stands".into());
    let (after, losses) = read_again(&bent);
    assert_eq!(losses, ["the choice of the state in which the robot starts, `stands`"]);
    assert!(after.states.iter().any(|state| state.name == "stands"));
}

#[test]
fn bodies_that_mujoco_refuses_are_named() {
    // a link of each kind, its moments and products, on a hinge; mass 0 is a link without inertial
    let robot = |links: &[(&str, f64, [f64; 6], &str)]| {
        let each = |(name, mass, [xx, xy, xz, yy, yz, zz], kind): &(&str, f64, [f64; 6], &str)| {
            let inertial = format!(
                "<inertial><mass value=\"{mass}\"/><inertia ixx=\"{xx}\" ixy=\"{xy}\" ixz=\"{xz}\" iyy=\"{yy}\" \
                 iyz=\"{yz}\" izz=\"{zz}\"/></inertial>"
            );
            format!(
                "<link name=\"{name}\">{}</link><joint name=\"j_{name}\" type=\"{kind}\"><parent link=\"base\"/><child \
                 link=\"{name}\"/><axis xyz=\"0 1 0\"/></joint>",
                if *mass > 0.0 { inertial } else { String::new() }
            )
        };
        format!("<robot name=\"r\"><link name=\"base\"/>{}</robot>", links.iter().map(each).collect::<String>())
    };
    let remarks = |text: &str| mjcf::write(&parse("r.urdf", text).unwrap().description).unwrap().remarks;
    let (ball, point, moves) = ([1.0, 0.0, 0.0, 1.0, 0.0, 1.0], [0.0; 6], "continuous");
    assert!(remarks(&robot(&[("ball", 1.0, ball, moves), ("fixed", 1.0, point, "fixed")])).is_empty());
    let all = robot(&[
        ("ball", 1.0, ball, moves),
        ("point", 1.0, point, moves),
        ("empty", 0.0, point, moves),
        ("bar", 1.0, [1.0, 1.0, 0.0, 1.0, 0.0, 2.0], "fixed"),
        ("plate", 1.0, [1.0, 0.0, 0.0, 1.0, 0.0, 2.0], moves),
        ("broken", 1.0, [1.0, 0.0, 0.0, 1.0, 0.0, 2.0001], "fixed"),
    ]);
    let expected = [
        "MuJoCo refuses moving bodies whose mass or a moment is below 1e-15: `point`, `empty` (2)",
        "MuJoCo refuses inertias with products and a principal moment below 1e-14: `bar`",
        "MuJoCo refuses inertias with a moment above the sum of the others (`balanceinertia` changes them): `broken`",
    ];
    assert_eq!(remarks(&all), expected);
    // what is fixed to a body counts
    let carried = robot(&[("point", 1.0, point, moves)]).replace(
        "</robot>",
        "<link name=\"load\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" \
         izz=\"1\"/></inertial></link><joint name=\"f\" type=\"fixed\"><parent link=\"point\"/><child link=\"load\"/>\
         </joint></robot>",
    );
    assert!(remarks(&carried).is_empty(), "{:?}", remarks(&carried));
}

#[test]
fn a_fixed_joint_follows_none() {
    let text = "<robot name=\"r\"><link name=\"base\"/><link name=\"a\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" \
                ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial></link><link name=\"b\"/><joint name=\"j\" type=\"continuous\">\
                <parent link=\"base\"/><child link=\"a\"/><axis xyz=\"0 1 0\"/></joint><joint name=\"f\" type=\"fixed\"><parent \
                link=\"a\"/><child link=\"b\"/><mimic joint=\"j\"/></joint></robot>";
    let written = mjcf::write(&parse("r.urdf", text).unwrap().description).unwrap().text;
    assert!(!written.contains("<equality>"), "{written}");
}

#[test]
fn several_joints_stay_in_one_body() {
    let joints = |words: &[&str]| words.iter().map(|words| format!("<joint {words}/>")).collect::<String>();
    for words in [
        &["name='x' axis='1 0 0'", "name='y' axis='0 1 0' pos='0.1 0 0'", "name='z'"][..],
        &["name='x' type='slide'", "name='y' type='ball' pos='0.1 0 0'"],
        &["name='x' type='slide' axis='1 0 0'", "name='y' pos='0 0.1 0'", "name='z' type='ball'"],
    ] {
        let text = format!(
            "<mujoco><worldbody><body name='a' pos='1 2 3' euler='10 20 30'>{}<geom type='box' size='.1 .2 .3'/></body>\
             </worldbody></mujoco>",
            joints(words)
        );
        let before = parse("r.xml", &text).unwrap().description;
        let written = mjcf::write(&before).unwrap();
        assert!(written.losses.is_empty() && written.remarks.is_empty(), "{:?} {:?}", written.losses, written.remarks);
        assert_eq!(written.text.matches("<body").count(), 1, "{}", written.text);
        let (after, _) = read_again(&before);
        let names = |robot: &Description| {
            let links = robot.links.iter().map(|link| link.name.clone());
            links.chain(robot.joints.iter().map(|joint| joint.name.clone())).collect::<Vec<_>>()
        };
        assert_eq!(names(&before), names(&after));
        let [one, two] = [before, after].map(|robot| robot.build().unwrap());
        let [theta, dtheta, ddtheta] = state(&one, 3);
        let [a, b] =
            [&one, &two].map(|model| model.inverse_dynamics(&theta, &dtheta, &ddtheta, &model.environment()).unwrap());
        assert!((&a - &b).amax() < 1e-12 * a.amax(), "{a}{b}");
    }
    // a ball ends the body: MuJoCo has no rotation after it
    let text = "<mujoco><worldbody><body name='a'><joint type='ball'/><joint type='slide'/><geom size='1'/></body>\
                </worldbody></mujoco>";
    let written = mjcf::write(&parse("r.xml", text).unwrap().description).unwrap();
    assert_eq!(written.text.matches("<body").count(), 2, "{}", written.text);
}
