//! Robots and quantities through the interface of the page are those of the library.

use mozzi::model::State;
use mozzi::model::description::ConstraintKind;
use mozzi::quantities::{INPUTS, LIST, Of, Query};
use mozzi::testing::{floating_mixed_tree, four_bar, mixed_tree, state, wrench};
use mozzi::{Description, Environment, FrameId, Freedom, Model, SE3, Twist, Vec3, Wrench};
use mozzi_urdf::json;
use mozzi_web::{Robot, Session, drawn};
use serde_json::{Value, json};

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|x| x.as_f64().expect("a number")).collect()
}

fn index(value: &Value) -> usize {
    value.as_u64().expect("a place") as usize
}

fn balls() -> Description {
    let text = include_str!("../../mozzi-report/tests/balls.xml");
    mozzi_urdf::parse("balls.xml", text).expect("sound").description
}

/// An arm, mimic joints, a floating base, balls and free joints, closed loops.
fn models() -> Vec<Model> {
    let open = |name| mozzi_urdf::open(name).expect("embedded").description;
    let file = |name: &str, text: &str| mozzi_urdf::parse(name, text).expect("sound").description;
    let descriptions = [
        open("ur5"),
        open("panda"),
        open("anymal").floating(),
        balls(),
        balls().floating(),
        file("test_tree.urdf", include_str!("../../../oracles/test_tree.urdf")),
        file("loops.xml", include_str!("../../../oracles/constraints/loops.xml")),
    ];
    let built = descriptions.into_iter().map(|description| description.build().expect("sound"));
    built.chain([four_bar(), mixed_tree(5, 9, 2), floating_mixed_tree(6, 9, 0)]).collect()
}

fn opened(model: &Model) -> Robot {
    Robot::new(model.clone())
}

fn set(robot: &mut Robot, name: &str, numbers: &[f64]) {
    let place = INPUTS.iter().position(|input| input.name == name).expect("an input");
    robot.input(place).expect("an input").copy_from_slice(numbers);
}

/// The outputs of a request, in one list.
fn computed(robot: &mut Robot, request: &Value) -> Result<Vec<f64>, String> {
    let (request, _) = robot.prepare(&request.to_string())?;
    robot.evaluate(request)?;
    Ok(robot.output(request)?.to_vec())
}

fn assert_near(what: &str, found: &[f64], expected: &[f64]) {
    let size = expected.iter().fold(1.0, |most: f64, x| most.max(x.abs()));
    let apart = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(found.len() == expected.len() && apart < 1e-12 * size, "{what}: {found:?}, not {expected:?}");
}

#[test]
fn a_robot_arrives_with_every_digit() {
    let mut session = Session::default();
    for model in models() {
        let [theta, dtheta, _] = state(&model, 3);
        let model = model.with_state("home", &State { time: 0.5, theta, dtheta }).expect("sound");
        let text = json::to_value(model.description()).to_string();
        let number = session.load("robot.JSON", &text).expect("sound");
        let robot = session.robot(number).expect("open");
        assert_eq!(robot.model().description(), model.description());
        assert_eq!(robot.model().parameters(), model.parameters());
    }
    session.close(1);
    assert_eq!(session.robot(1).expect_err("closed"), "robot 1 is not open");
    assert_eq!(session.load("arm.urdf", include_str!("../../mozzi-urdf/models/ur5.urdf")), Ok(models().len()));
}

#[test]
fn every_quantity_is_the_librarys() {
    for model in models() {
        let mut robot = opened(&model);
        let [theta, dtheta, ddtheta] = state(&model, 7);
        let x: Vec<f64> = ddtheta.iter().map(|x| 0.5 - x).collect();
        let w = wrench(2).to_array();
        let of = |name: &str| match name {
            "theta" => &theta[..],
            "dtheta" => &dtheta,
            "ddtheta" | "tau" => &ddtheta,
            "x" => &x,
            _ => &w,
        };
        INPUTS.iter().for_each(|input| set(&mut robot, input.name, of(input.name)));
        let (frame, name) = model.frames().last().map(|(id, name)| (id, name.to_string())).expect("a frame");
        for (place, quantity) in LIST.iter().enumerate() {
            let query: Query = Query::at(place).of(frame).about(Vec3([0.1, 0.2, 0.3]));
            let inputs: Vec<&[f64]> = quantity.inputs.iter().map(|input| of(input.name)).collect();
            let expected = model.compute(query, &inputs, &model.environment());
            let request = match quantity.of {
                Of::Point => json!({ "quantity": quantity.name, "about": [0.1, 0.2, 0.3] }),
                Of::Frame | Of::Task => json!({ "quantity": quantity.name, "frame": name }),
                Of::Robot => json!({ "quantity": quantity.name }),
            };
            match (computed(&mut robot, &request), expected) {
                (Ok(found), Ok(expected)) => assert_eq!(found, expected.concat(), "{}", quantity.name),
                (Err(found), Err(expected)) => assert_eq!(found, expected.to_string()),
                (found, expected) => panic!("{}: {found:?}, not {expected:?}", quantity.name),
            }
        }
    }
}

#[test]
fn the_page_is_told_all_that_moves() {
    for model in models() {
        let about = opened(&model).about().expect("a robot");
        assert_eq!(numbers(&about["start"]), model.start().theta);
        let poses = model.frame_poses(&state(&model, 4)[0]).expect("poses");
        let bodies = about["bodies"].as_array().expect("bodies");
        assert_eq!(bodies.len(), model.moving_joints().count() + 1);
        for (frame, T) in about["frames"].as_array().expect("frames").iter().zip(&poses) {
            let p = numbers(&frame["p"]).try_into().expect("three");
            let body = &bodies[index(&frame["body"])];
            assert_near("a frame of a body", &(poses[index(&body["frame"])] * Vec3(p)).0, &T.p.0);
        }
        for (body, joint) in bodies[1..].iter().zip(model.moving_joints()) {
            assert_eq!(body["joint"], joint.name.as_str());
            let names: Vec<&str> = model.velocity_names().collect();
            assert!(body["j"].as_u64().is_some_and(|j| (j as usize) < names.len()));
            let count = match joint.kind.name() {
                "free" => 0,
                "ball" => 3,
                _ => 1,
            };
            assert_eq!(body["lines"].as_array().map(Vec::len), Some(count));
        }
        for (joint, place) in about["joints"].as_array().expect("joints").iter().zip(model.places()) {
            assert_eq!((index(&joint["q"]), index(&joint["j"])), (place.q, place.j));
            let name = joint["name"].as_str().expect("a name");
            assert!(model.position_names().nth(place.q).is_some_and(|known| known.starts_with(name)));
        }
        let names: Vec<_> = about["quantities"].as_array().expect("a list").iter().map(|one| &one["name"]).collect();
        assert_eq!(names.len(), LIST.len() + drawn::LIST.len());
    }
}

#[test]
fn an_inertia_ellipsoid_has_the_bodys_inertia() {
    let model = mozzi_urdf::open("ur5").and_then(mozzi_urdf::Loaded::build).expect("embedded");
    let about = opened(&model).about().expect("a robot");
    for (body, pi) in
        about["bodies"].as_array().expect("bodies")[1..].iter().zip(model.parameters().as_chunks::<10>().0)
    {
        let G = mozzi::SpatialInertia::from_parameters(*pi);
        let lengths = numbers(&body["ellipsoid"]["lengths"]);
        // moments of a homogeneous ellipsoid: m (b² + c²) / 5
        let squares: f64 = lengths.iter().map(|x| x * x).sum();
        let trace = 2.0 * G.mass * squares / 5.0;
        assert_near("its moments", &[trace], &[G.about_center_of_mass().trace()]);
        assert_near("its centre", &numbers(&body["center"]), &G.center_of_mass().0);
    }
}

#[test]
fn wrenches_are_applied_in_each_kind_of_coordinates() {
    let model = mozzi_urdf::open("panda").and_then(mozzi_urdf::Loaded::build).expect("embedded");
    let [theta, dtheta, ddtheta] = state(&model, 2);
    let (frame, name): (FrameId, String) = model.frames().last().map(|(id, name)| (id, name.into())).expect("a frame");
    let T = model.forward_kinematics(&theta, frame).expect("a pose");
    let (F, p) = (wrench(8), Vec3([0.2, -0.1, 0.4]));
    let in_space = T.inverse().Ad().transpose() * F;
    let at_point = T.Ad().transpose() * Wrench { m: p.cross(F.f), f: F.f };
    let cases = [
        ("body", F.to_array(), F),
        ("space", in_space.to_array(), F),
        ("point", [p.0, F.f.0].concat().try_into().expect("six"), at_point),
    ];
    for (kind, given, F) in cases {
        let mut robot = opened(&model);
        for (name, numbers) in [("theta", &theta), ("dtheta", &dtheta), ("ddtheta", &ddtheta)] {
            set(&mut robot, name, numbers);
        }
        robot.apply(&json!([{ "frame": name, "as": kind }]).to_string()).expect("a frame").copy_from_slice(&given);
        let found = computed(&mut robot, &json!({ "quantity": "inverse_dynamics" })).expect("τ");
        let environment = Environment { applied: &[(frame, F)], ..model.environment() };
        let expected = model.inverse_dynamics(&theta, &dtheta, &ddtheta, &environment).expect("τ");
        assert_near(kind, &found, expected.as_slice());
    }
}

#[test]
fn sliders_set_configurations_and_read_them() {
    for model in models() {
        let mut robot = opened(&model);
        let theta = &state(&model, 5)[0];
        set(&mut robot, "theta", theta);
        let x = computed(&mut robot, &json!({ "quantity": "coordinates" })).expect("x");
        let is_limited = |joint: &mozzi::model::description::Joint| joint.limits.position.is_some();
        let has_limited_ball = model.joints().any(|joint| joint.kind.name() == "ball" && is_limited(joint));
        set(&mut robot, "x", &x);
        let again = computed(&mut robot, &json!({ "quantity": "configuration" })).expect("θ");
        if !has_limited_ball {
            let mut apart = vec![0.0; model.n()];
            model.configuration_space().difference(theta, &again, &mut apart);
            assert_near("a round trip", &apart, &vec![0.0; model.n()]);
        }
        let stretched: Vec<f64> = again.iter().map(|x| 1.5 * x).collect();
        set(&mut robot, "theta", &stretched);
        let unit = computed(&mut robot, &json!({ "quantity": "unit_configuration" })).expect("θ");
        assert!(model.check_configuration(&unit).is_ok());
    }
    let model: Model = balls().build().expect("sound");
    let mut robot = opened(&model);
    let place = model.places().iter().find(|place| place.freedom == Freedom::Ball).expect("the shoulder");
    let mut x = vec![0.0; model.n()];
    x[place.j..place.j + 3].copy_from_slice(&[0.0, 3.0, 0.0]);
    set(&mut robot, "x", &x);
    let theta = computed(&mut robot, &json!({ "quantity": "configuration" })).expect("θ");
    assert_near("at its limit of 2", &theta[place.q..place.q + 4], &[1.0_f64.cos(), 0.0, 1.0_f64.sin(), 0.0]);
}

#[test]
fn bodies_move_as_their_frames() {
    for model in models() {
        let mut robot = opened(&model);
        let [theta, dtheta, ddtheta] = state(&model, 6);
        for (name, numbers) in [("theta", &theta), ("dtheta", &dtheta), ("ddtheta", &ddtheta)] {
            set(&mut robot, name, numbers);
        }
        let about = robot.about().expect("a robot");
        let bodies = about["bodies"].as_array().expect("bodies").clone();
        let found = computed(&mut robot, &json!({ "quantity": "body_motion" })).expect("a motion");
        let columns: Vec<&[f64]> = found.chunks(3 * bodies.len()).collect();
        for (k, body) in bodies.iter().enumerate() {
            let frame = model.frame(body["name"].as_str().expect("a name")).expect("a frame");
            let T: SE3 = model.forward_kinematics(&theta, frame).expect("a pose");
            let c = T * Vec3(numbers(&body["center"]).try_into().expect("three"));
            let V = &model.space_jacobian(&theta, frame).expect("J") * &dtheta[..];
            let three = |column: usize| &columns[column][3 * k..3 * k + 3];
            assert_near("c", three(0), &c.0);
            assert_near("its velocity", three(1), &(V.v + V.w.cross(c)).0);
            assert_near("ω", three(2), &V.w.0);
        }
        let ends = computed(&mut robot, &json!({ "quantity": "constraint_anchors" })).expect("anchors");
        let expected = model.constraint_anchors(&theta).expect("anchors");
        let all = |k: usize| expected.iter().flat_map(|ends| ends[k].p.0).collect::<Vec<_>>();
        assert_near("anchors", &ends, &[all(0), all(1)].concat());
    }
}

#[test]
fn constraints_carry_what_their_multipliers_are() {
    let model = four_bar();
    let mut robot = opened(&model);
    let [theta, dtheta, ddtheta] = state(&model, 8);
    let tau: Vec<f64> = dtheta.iter().map(|x| 1.0 - 2.0 * x).collect();
    for (name, numbers) in [("theta", &theta), ("dtheta", &dtheta), ("ddtheta", &ddtheta), ("tau", &tau)] {
        set(&mut robot, name, numbers);
    }
    let found = computed(&mut robot, &json!({ "quantity": "constraint_wrenches" })).expect("wrenches");
    let lambda = model.constraint_forces([&theta, &dtheta, &ddtheta], &tau, &model.environment()).expect("λ");
    let rate = computed(&mut robot, &json!({ "quantity": "constraint_jacobian" })).expect("A");
    let rates = rate.chunks(model.n()).map(|row| row.iter().zip(&dtheta).map(|(a, x)| a * x).sum::<f64>());
    let expected: f64 = rates.zip(lambda.iter()).map(|(rate, force)| rate * force).sum();
    // the power of each wrench on the motion of {b} relative to {a}
    let twist = |frame: &Option<String>| match frame {
        Some(name) => &model.space_jacobian(&theta, model.frame(name).expect("a frame")).expect("J") * &dtheta[..],
        None => Twist::from_array([0.0; 6]),
    };
    let (moments, forces) = found.split_at(found.len() / 2);
    let mut power = 0.0;
    for (k, constraint) in model.constraints().iter().enumerate() {
        let ConstraintKind::Frames { a, b, .. } = &constraint.kind else { panic!("anchors") };
        let (V_a, V_b) = (twist(&a.frame), twist(&b.frame));
        let [m, f] = [moments, forces].map(|list| Vec3(list[3 * k..][..3].try_into().expect("three")));
        power += m.dot(V_b.w - V_a.w) + f.dot(V_b.v - V_a.v);
    }
    assert!(expected.abs() > 1e-3, "{expected}");
    assert_near("power", &[power], &[expected]);
}

#[test]
fn parameters_can_be_replaced() {
    let model = mozzi_urdf::open("ur5").and_then(mozzi_urdf::Loaded::build).expect("embedded");
    let mut robot = opened(&model);
    let heavier: Vec<f64> = model.parameters().iter().map(|x| 1.25 * x).collect();
    robot.set_parameters(&json!(heavier).to_string()).expect("as many");
    assert_eq!(robot.model().parameters().len(), heavier.len());
    assert_near("parameters", &robot.model().parameters(), &heavier);
    assert_eq!(
        robot.set_parameters("[1]").expect_err("too few"),
        format!("there are 1 parameters, expected {}", heavier.len())
    );
}

#[test]
fn errors_are_texts() {
    let mut session = Session::default();
    let why = session.load("a.json", "{\"robot\": 1}").expect_err("keys are missing");
    assert!(why.starts_with("a.json:1:1: `gravity` is missing"), "{why}");
    let why = session.load("a.urdf", "<robot name='a'><link name='b'/><lnik/></robot>").expect_err("a misspelling");
    assert!(why.contains("a.urdf:1:34: error"), "{why}");
    let mut robot = opened(&four_bar());
    let cases = [
        ("{", "the request is not JSON"),
        ("{\"quantity\": \"mass_matrx\"}", "mass_matrx"),
        ("{\"quantity\": \"body_jacobian\"}", "the name of a frame"),
        ("{\"quantity\": \"velocity_ellipsoid\"}", "`frame` is missing in the request for velocity_ellipsoid"),
        ("{\"quantity\": \"body_jacobian\", \"frame\": \"rokcer\"}", "rokcer"),
        ("{\"quantity\": \"mass_matrix\", \"frmae\": \"a\"}", "`frmae` is not an entry of a request"),
    ];
    for (request, expected) in cases {
        let why = robot.prepare(request).expect_err("refused");
        assert!(why.contains(expected), "{why}");
    }
    assert!(robot.evaluate(9).is_err() && robot.output(9).is_err() && robot.input(9).is_err());
    assert!(
        robot.apply("[{\"frame\": \"rocker\", \"as\": \"bdoy\"}]").expect_err("refused").contains("expected \"body\"")
    );
    // a quaternion that is far from unit
    let mut robot = opened(&balls().build().expect("sound"));
    robot.input(0).expect("θ").fill(0.0);
    let why = computed(&mut robot, &json!({ "quantity": "mass_matrix" })).expect_err("refused");
    assert!(why.contains("unit quaternion"), "{why}");
}
