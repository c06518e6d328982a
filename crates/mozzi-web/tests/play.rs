//! The playground's commands: files, simulation, inverse kinematics, edits. Each result is the library's.
#![cfg(feature = "play")]

use mozzi::quantities::{INPUTS, Query};
use mozzi::{Model, SE3};
use mozzi_sim::{Contacts, GravityCompensation, Method, Options, Plane, Simulation, Zero};
use mozzi_web::{Robot, Session};
use serde_json::{Value, json};

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|x| x.as_f64().expect("a number")).collect()
}

/// An open robot, with what the page is told.
pub fn opened(session: &mut Session, file: &str, text: &str) -> (usize, Value) {
    session.open(&json!({ "file": file, "files": { file: text } }).to_string()).expect("sound")
}

pub fn input<'r>(robot: &'r mut Robot, name: &str) -> &'r mut [f64] {
    robot.input(INPUTS.iter().position(|input| input.name == name).expect("an input")).expect("an input")
}

pub fn play(robot: &mut Robot, command: Value) -> Value {
    robot.play(&command.to_string()).expect("a command")
}

const UR5: &str = include_str!("../../mozzi-urdf/models/ur5.urdf");
const ANYMAL: &str = include_str!("../../mozzi-urdf/models/anymal.urdf");
const SNAKE: &str = include_str!("../../mozzi-report/robots/snake.urdf.xacro");
const CART: &str = include_str!("../../mozzi-report/robots/spherical_pendulum.xml");
const FOUR_BAR: &str = include_str!("../../mozzi-report/robots/four_bar.json");
const DELTA: &str = include_str!("../../mozzi-report/robots/delta.json");

#[test]
fn robots_of_the_playground_open() {
    let mut session = Session::default();
    for (file, text, n, shapes) in [
        ("ur5.urdf", UR5, 6, 23),
        ("snake.urdf.xacro", SNAKE, 6, 7),
        ("spherical_pendulum.xml", CART, 5, 5),
        ("four_bar.json", FOUR_BAR, 3, 0),
        ("delta.json", DELTA, 6, 0),
    ] {
        let (number, said) = opened(&mut session, file, text);
        assert_eq!(session.robot(number).expect("open").model().n(), n, "{file}");
        assert_eq!(said["shapes"].as_array().map(Vec::len), Some(shapes), "{file}");
        assert_eq!(said["warnings"], json!([]), "{file}");
        // and again from its description
        let again = json!({ "file": file, "files": { file: text }, "description": said["description"] });
        let (again, _) = session.open(&again.to_string()).expect("sound");
        assert_eq!(session.robot(again).expect("open").model().n(), n, "{file}");
    }
}

#[test]
fn a_wrong_file_is_shown_with_its_place() {
    let wrong = UR5.replace("mass value=\"8.393\"", "mass value=\"8,393\"");
    assert_ne!(wrong, UR5);
    let asked = json!({ "file": "ur5.urdf", "files": { "ur5.urdf": wrong } }).to_string();
    let said = Session::default().open(&asked).expect_err("a comma");
    assert!(said.contains("8,393") && said.contains("ur5.urdf:") && said.contains("━━━"), "{said}");
}

#[test]
fn xacro_finds_dropped_files_and_packages() {
    let main = r#"<robot name="two" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:include filename="$(find parts)/urdf/rod.xacro"/><xacro:include filename="../urdf/near.xacro"/>
  <link name="base"/><xacro:rod name="a" parent="base"/><xacro:rod name="${tip}" parent="a"/></robot>"#;
    let rod = r#"<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:macro name="rod" params="name parent">
  <link name="${name}"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="to_${name}" type="continuous"><parent link="${parent}"/><child link="${name}"/><axis xyz="0 1 0"/></joint>
  </xacro:macro></robot>"#;
    let near = r#"<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:property name="tip" value="b"/></robot>"#;
    let files = json!({
        "ws/two/urdf/two.xacro": main, "ws/two/urdf/near.xacro": near,
        "ws/renamed/urdf/rod.xacro": rod, "ws/renamed/package.xml": "<package><name>parts</name></package>",
    });
    let asked = json!({ "file": "ws/two/urdf/two.xacro", "files": files }).to_string();
    let mut session = Session::default();
    let (number, _) = session.open(&asked).expect("sound");
    assert_eq!(session.robot(number).expect("open").model().n(), 2);
}

#[test]
fn arguments_of_xacro_change_the_robot() {
    let text = r#"<robot name="rod" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="joints" default="1"/><xacro:arg name="mass" default="2.0"/>
  <link name="l0"/><xacro:macro name="row" params="k"><xacro:if value="${k &lt;= int('$(arg joints)')}">
  <link name="l${k}"><inertial><mass value="$(arg mass)"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="j${k}" type="continuous"><parent link="l${k-1}"/><child link="l${k}"/><axis xyz="0 1 0"/></joint>
  <xacro:row k="${k+1}"/></xacro:if></xacro:macro><xacro:row k="1"/></robot>"#;
    let mut session = Session::default();
    let mut open = |arguments: Value| {
        let asked = json!({ "file": "rod.xacro", "files": { "rod.xacro": text }, "arguments": arguments });
        session
            .open(&asked.to_string())
            .map(|(number, said)| (session.robot(number).expect("open").model().n(), said["arguments"].clone()))
    };
    assert_eq!(open(json!({})), Ok((1, json!([["joints", "1"], ["mass", "2.0"]]))));
    assert_eq!(open(json!({ "joints": "3" })), Ok((3, json!([["joints", "3"], ["mass", "2.0"]]))));
    let error = open(json!({ "mass": "two" })).expect_err("no number");
    assert!(error.contains("two") && error.contains("mass"), "{error}");
}

#[test]
fn mjcf_finds_dropped_includes() {
    let main = r#"<mujoco model="two"><include file="parts/../parts/defaults.xml"/>
  <worldbody><body name="a"><include file="parts/rod.xml"/></body></worldbody></mujoco>"#;
    let defaults = r#"<mujocoinclude><default><geom type="sphere" size="0.1" mass="2"/></default></mujocoinclude>"#;
    let rod = r#"<mujocoinclude><joint name="swing" type="hinge" axis="0 1 0"/><geom pos="0 0 -1"/></mujocoinclude>"#;
    for folder in ["", "robots/two/"] {
        let asked = |names: &[(&str, &str)]| {
            let files: serde_json::Map<String, Value> =
                names.iter().map(|(name, text)| (format!("{folder}{name}"), json!(text))).collect();
            json!({ "file": format!("{folder}two.xml"), "files": files }).to_string()
        };
        let all = [("two.xml", main), ("parts/defaults.xml", defaults), ("parts/rod.xml", rod)];
        let mut session = Session::default();
        let (number, said) = session.open(&asked(&all)).expect("sound");
        let model = session.robot(number).expect("open").model();
        let mass: f64 = model.description().links.iter().map(|link| link.inertia.mass).sum();
        assert_eq!((model.n(), mass, said["shapes"].as_array().map(Vec::len)), (1, 2.0, Some(1)), "{said}");
        let error = session.open(&asked(&all[..2])).expect_err("a file is missing");
        assert!(error.contains("parts/rod.xml` cannot be read"), "{error}");
    }
}

#[test]
fn steps_are_the_simulations() {
    let mut session = Session::default();
    let (number, _) = opened(&mut session, "ur5.urdf", UR5);
    let robot = session.robot(number).expect("open");
    let (theta, dtheta) = ([0.3, -1.0, 1.2, 0.4, 0.7, -0.2], [0.5, 0.1, -0.3, 1.0, 0.2, 0.0]);
    for motors in ["off", "gravity"] {
        input(robot, "theta").copy_from_slice(&theta);
        input(robot, "dtheta").copy_from_slice(&dtheta);
        play(robot, json!({ "do": "set", "motors": motors, "omega": 5, "zeta": 1, "reset": true }));
        let answer = play(robot, json!({ "do": "step", "step": 0.001, "steps": 50 }));
        let model = robot.model().clone();
        let joint_limits = mozzi_sim::Policy::Respect;
        let options = Options { method: Method::RungeKutta4, joint_limits, ..Options::new(0.05, 50) };
        let run = match motors {
            "off" => Simulation::new(options).run(&model, &theta, &dtheta, Zero),
            _ => Simulation::new(options).run(&model, &theta, &dtheta, GravityCompensation::new(&model)),
        };
        let motion = run.expect("a motion").motion;
        let last = motion.last();
        for (name, expected) in
            [("theta", last.theta), ("dtheta", last.dtheta), ("ddtheta", last.ddtheta), ("tau", last.tau)]
        {
            assert_eq!(input(robot, name), expected, "{motors}: {name}");
        }
        assert_eq!(answer["kinetic"], json!(last.energy.kinetic));
        assert_eq!(answer["potential"], json!(last.energy.potential));
        assert!(answer["drift"].as_f64().expect("a number").abs() < 1e-6, "{answer}");
    }
}

/// The largest |θ̇| and the distance from the target after some seconds.
fn after(robot: &mut Robot, seconds: usize, target: &[f64]) -> [f64; 2] {
    for _ in 0..60 * seconds {
        play(robot, json!({ "do": "step", "step": 0.001, "steps": 16 }));
    }
    let speed = input(robot, "dtheta").iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let apart = input(robot, "theta").iter().zip(target).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    [speed, apart]
}

#[test]
fn motors_reach_their_target() {
    let mut session = Session::default();
    let (number, _) = opened(&mut session, "ur5.urdf", UR5);
    let robot = session.robot(number).expect("open");
    let target = [0.4, -1.2, 1.0, -0.5, 0.3, 0.6];
    for motors in ["pd", "computed-torque"] {
        input(robot, "theta").fill(0.0);
        input(robot, "dtheta").fill(0.0);
        play(robot, json!({ "do": "set", "motors": motors, "omega": 8, "zeta": 1, "target": target }));
        let [speed, apart] = after(robot, 4, &target);
        assert!(speed < 0.02 && apart < 0.02, "{motors}: {speed} {apart}");
    }
}

#[test]
fn a_fixed_base_whose_feet_are_in_the_ground_says_what_to_do() {
    let mut session = Session::default();
    let (number, _) = opened(&mut session, "anymal.urdf", ANYMAL);
    let robot = session.robot(number).expect("open");
    play(
        robot,
        json!({ "do": "set", "motors": "pd", "omega": 8, "zeta": 1, "ground": { "friction": 0.8, "restitution": 0 } }),
    );
    let error = robot.play(&json!({ "do": "step", "step": 0.001, "steps": 1 }).to_string()).expect_err("in the ground");
    assert!(error.contains("_FOOT` 0.571") && error.contains("with a floating base the robot is put on it"), "{error}");
}

#[test]
fn a_quadruped_stands_on_the_ground_and_on_pinned_feet() {
    let mut session = Session::default();
    let floating = Model::floating_description(ANYMAL);
    let asked = json!({ "file": "anymal.urdf", "files": { "anymal.urdf": ANYMAL }, "description": floating });
    let (number, _) = session.open(&asked.to_string()).expect("sound");
    let robot = session.robot(number).expect("open");
    let mut stand = vec![1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let legs: Vec<f64> = robot.model().joint_names().map(bend).collect();
    stand.extend(&legs[legs.len() - 12..]);
    input(robot, "theta").copy_from_slice(&stand);
    play(robot, json!({ "do": "settle" }));
    let stand = input(robot, "theta").to_vec();
    let contacts = Contacts { points: feet(robot.model()), planes: vec![Plane::ground()] };
    let lowest = contacts.gaps(robot.model(), 0.0, &stand).into_iter().fold(f64::INFINITY, f64::min);
    assert!(lowest.abs() < 1e-12, "{lowest}");
    let ground = json!({ "friction": 0.8, "restitution": 0 });
    let command = json!({ "do": "set", "motors": "pd", "omega": 12, "zeta": 1, "target": stand, "ground": ground });
    play(robot, command);
    let [speed, _] = after(robot, 2, &stand);
    let height = input(robot, "theta")[6];
    assert!(speed < 0.2 && height > 0.7 * stand[6], "{speed} {height} of {}", stand[6]);

    input(robot, "theta").copy_from_slice(&stand);
    input(robot, "dtheta").fill(0.0);
    let is_foot = |name: &String| name.contains("_FOOT") || name.contains("_ADAPTER");
    let feet: Vec<String> = feet(robot.model()).into_iter().map(|foot| foot.name).filter(is_foot).collect();
    let mut pinned = number;
    for foot in &feet {
        let robot = session.robot(pinned).expect("open");
        let description = play(robot, json!({ "do": "edit", "what": "pin", "frame": foot }));
        let again = json!({ "file": "anymal.urdf", "files": { "anymal.urdf": ANYMAL }, "description": description });
        pinned = session.open(&again.to_string()).expect("sound").0;
        input(session.robot(pinned).expect("open"), "theta").copy_from_slice(&stand);
    }
    let robot = session.robot(pinned).expect("open");
    assert_eq!(robot.model().constraint_rows(), 24);
    play(robot, json!({ "do": "set", "motors": "pd", "omega": 8, "zeta": 1, "target": stand, "ground": null }));
    let [speed, apart] = after(robot, 1, &stand);
    assert!(speed < 1e-3 && apart < 1e-2, "{speed} {apart}");
    assert_eq!(play(robot, json!({ "do": "inertias" }))["pins"], json!(feet));
}

/// Knees bent.
fn bend(name: &str) -> f64 {
    match (name.contains("HFE"), name.contains("KFE"), name.contains("F_")) {
        (true, _, front) => {
            if front || name.starts_with("LF") || name.starts_with("RF") {
                0.4
            } else {
                -0.4
            }
        }
        (_, true, _) => {
            if name.starts_with("LF") || name.starts_with("RF") {
                -0.8
            } else {
                0.8
            }
        }
        _ => 0.0,
    }
}

/// The origins of the last links.
fn feet(model: &Model) -> Vec<mozzi_sim::ContactPoint> {
    mozzi_urdf::geometry::end_points(model, 0.7, 0.0)
}

trait Floating {
    fn floating_description(text: &str) -> Value;
}

impl Floating for Model {
    fn floating_description(text: &str) -> Value {
        let robot = mozzi_urdf::parse("robot.urdf", text).expect("sound").description.floating();
        mozzi_urdf::json::to_value(&robot)
    }
}

#[test]
fn the_mouse_moves_joints_and_the_end_effector() {
    let mut session = Session::default();
    let (number, _) = opened(&mut session, "ur5.urdf", UR5);
    let robot = session.robot(number).expect("open");
    let start = [0.1, -1.0, 1.2, 0.4, 0.7, -0.2];
    input(robot, "theta").copy_from_slice(&start);
    let model = robot.model().clone();
    let tool = model.frames().last().map(|(_, name)| name.to_string()).expect("a frame");
    let pose = |theta: &[f64]| -> SE3 {
        model.forward_kinematics(theta, model.frame(&tool).expect("a frame")).expect("a pose")
    };
    let goal = (pose(&start).p + mozzi::Vec3([0.05, -0.03, 0.04])).0;
    let answer = play(robot, json!({ "do": "reach", "frame": tool, "goal": goal, "keep": true }));
    let reached = pose(input(robot, "theta"));
    assert_eq!(answer["reached"], true);
    assert!(
        (reached.p - mozzi::Vec3(goal)).norm() < 1e-5
            && (reached.R.matrix() - pose(&start).R.matrix()).rows().concat().iter().all(|x| x.abs() < 1e-5)
    );

    // a joint alone: the goal is where the point would be with another angle of it
    input(robot, "theta").copy_from_slice(&start);
    let mut other = start;
    other[1] += 0.3;
    let goal = pose(&other).p.0;
    let joint = model.joint_names().nth(1).expect("a joint").to_string();
    play(robot, json!({ "do": "drag", "joint": joint, "frame": tool, "point": [0, 0, 0], "goal": goal }));
    for (found, expected) in input(robot, "theta").iter().zip(&other) {
        assert!((found - expected).abs() < 1e-6, "{found} {expected}");
    }
}

#[test]
fn loops_stay_closed() {
    let mut session = Session::default();
    for (text, joint, frame) in [(FOUR_BAR, "crank_pivot", "crank"), (DELTA, "motor1", "platform")] {
        let (number, _) = opened(&mut session, "robot.json", text);
        let robot = session.robot(number).expect("open");
        let place = robot.model().joint_names().position(|name| name == joint).expect("a joint");
        input(robot, "theta")[place] += 0.1;
        let angle = input(robot, "theta")[place];
        play(robot, json!({ "do": "close", "hold": joint }));
        assert_eq!(input(robot, "theta")[place], angle);
        let open = |robot: &mut Robot| {
            let theta = input(robot, "theta").to_vec();
            robot
                .model()
                .compute(
                    Query::named("constraint_residual").expect("a quantity"),
                    &[&theta],
                    &robot.model().environment(),
                )
                .expect("φ")[0]
                .iter()
                .fold(0.0, |most: f64, x| most.max(x.abs()))
        };
        assert!(open(robot) < 1e-9);
        play(robot, json!({ "do": "step", "step": 0.001, "steps": 200 }));
        assert!(open(robot) < 1e-9);
        let theta = input(robot, "theta").to_vec();
        let at = robot.model().forward_kinematics(&theta, robot.model().frame(frame).expect("a frame")).expect("T").p;
        let goal = (at + mozzi::Vec3([0.01, 0.0, 0.01])).0;
        play(robot, json!({ "do": "reach", "frame": frame, "goal": goal }));
        assert!(open(robot) < 1e-9);
    }
}

#[test]
fn a_push_pulls_the_point_to_the_mouse() {
    let mut session = Session::default();
    let (number, _) = opened(&mut session, "snake.urdf.xacro", SNAKE);
    let robot = session.robot(number).expect("open");
    let goal = [0.3, 0.2, -0.7];
    let push = json!({ "frame": "link6", "point": [0, 0, -0.1], "goal": goal });
    let mut answer = Value::Null;
    for _ in 0..200 {
        answer = play(robot, json!({ "do": "step", "step": 0.001, "steps": 16, "push": push }));
    }
    let (p, f) = (numbers(&answer["push"]["p"]), numbers(&answer["push"]["f"]));
    assert!(p[0] > 0.1 && p[1] > 0.06 && f[0] > 0.0, "{answer}");
}

#[test]
fn edits_change_the_description() {
    let mut session = Session::default();
    let (number, _) = opened(&mut session, "ur5.urdf", UR5);
    let robot = session.robot(number).expect("open");
    let before = play(robot, json!({ "do": "inertias" }));
    let link = before["links"].as_array().expect("links").iter().find(|link| link["mass"].as_f64() > Some(1.0));
    let link = link.expect("a link");
    let mass = link["mass"].as_f64().expect("a mass");
    let edit = json!({ "do": "edit", "what": "link", "name": link["name"], "entry": "mass", "value": 2.0 * mass, "scale": true });
    let description = play(robot, edit);
    let again = json!({ "file": "ur5.urdf", "files": { "ur5.urdf": UR5 }, "description": description });
    let (heavier, _) = session.open(&again.to_string()).expect("sound");
    let robot = session.robot(heavier).expect("open");
    let after = play(robot, json!({ "do": "inertias" }));
    let same = after["links"].as_array().expect("links").iter().find(|other| other["name"] == link["name"]);
    let inertia = |link: &Value| numbers(&link["inertia"])[0];
    assert!((inertia(same.expect("there")) - 2.0 * inertia(link)).abs() < 1e-12);
    let urdf = play(robot, json!({ "do": "urdf" }));
    let read =
        mozzi_urdf::parse("ur5.urdf", urdf["text"].as_str().expect("text")).expect("URDF").build().expect("sound");
    assert!((read.mass() - robot.model().mass()).abs() < 1e-9);
    for command in [json!({ "do": "edit", "what": "joint", "entry": "friction", "value": -1 }), json!({ "do": "fly" })]
    {
        assert!(robot.play(&command.to_string()).is_err());
    }
}
