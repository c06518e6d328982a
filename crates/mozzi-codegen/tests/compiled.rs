//! The compiled robot, with the model's methods and errors.
#![allow(missing_docs)]

mod common;

use common::{error, quantities, robots, state};
use mozzi::nalgebra::DMatrix;
use mozzi_codegen::{Compiled, Engine, Quantity, Refusal, Shape, compile};

fn is_shared<T: Send + Sync>(_: &T) {}

#[test]
fn methods_are_the_models() {
    for (name, model) in robots() {
        let frame = model.frames().last().expect("a frame").0;
        let robot = compile(&model, &quantities(&model)).expect("its own frames");
        is_shared(&robot);
        let environment = model.environment();
        for seed in 0..4 {
            let [theta, dtheta, x] = &state(&model, seed);
            let near = |what: &str, found: &[f64], expected: &[f64], most: f64| {
                let error = error(found, expected);
                assert!(error < most, "{name}, {what}: {error:e}");
            };
            let matrix = |what: &str, found: &DMatrix<f64>, expected: &DMatrix<f64>, most: f64| {
                near(what, found.as_slice(), expected.as_slice(), most);
            };
            macro_rules! vector {
                ($method:ident($($argument:expr),*), ($($more:expr),*), $most:expr) => {
                    let (found, expected) = (robot.$method($($argument),*), model.$method($($argument,)* $($more),*));
                    near(stringify!($method), found.expect("sound").as_slice(), expected.expect("sound").as_slice(), $most);
                };
            }
            vector!(inverse_dynamics(theta, dtheta, x), (&environment), 2e-14);
            vector!(bias_forces(theta, dtheta), (&environment), 2e-14);
            vector!(velocity_product(theta, dtheta), (), 2e-14);
            vector!(gravity_forces(theta), (), 2e-14);
            vector!(mass_matrix(theta), (), 2e-14);
            vector!(forward_dynamics(theta, dtheta, x), (&environment), 1e-10);
            let (found, expected) = (robot.forward_kinematics(theta, frame), model.forward_kinematics(theta, frame));
            let (found, expected) = (found.expect("sound").to_matrix(), expected.expect("sound").to_matrix());
            near("forward_kinematics", found.as_flattened(), expected.as_flattened(), 2e-14);
            let (body, space) = (robot.body_jacobian(theta, frame), robot.space_jacobian(theta, frame));
            matrix(
                "J_b",
                &body.expect("sound").matrix(),
                &model.body_jacobian(theta, frame).expect("sound").matrix(),
                2e-14,
            );
            matrix(
                "J_s",
                &space.expect("sound").matrix(),
                &model.space_jacobian(theta, frame).expect("sound").matrix(),
                2e-14,
            );
            let found = robot.inverse_dynamics_derivatives(theta, dtheta, x).expect("sound");
            let expected = model.inverse_dynamics_derivatives(theta, dtheta, x, &environment).expect("sound");
            matrix("∂τ/∂θ", &found.d_theta, &expected.d_theta, 2e-14);
            matrix("∂τ/∂θ̇", &found.d_dtheta, &expected.d_dtheta, 2e-14);
            matrix("∂τ/∂θ̈", &found.d_ddtheta, &expected.d_ddtheta, 2e-14);
            let found = robot.forward_dynamics_derivatives(theta, dtheta, x).expect("regular");
            let expected = model.forward_dynamics_derivatives(theta, dtheta, x, &environment).expect("regular");
            matrix("∂θ̈/∂θ", &found.d_theta, &expected.d_theta, 1e-10);
            matrix("∂θ̈/∂θ̇", &found.d_dtheta, &expected.d_dtheta, 1e-10);
            matrix("∂θ̈/∂τ", &found.d_tau, &expected.d_tau, 1e-10);
        }
    }
}

fn panda() -> (mozzi::Model, Compiled) {
    let model = mozzi_urdf::open("panda").and_then(|robot| robot.build()).expect("an embedded robot");
    let robot = compile(&model, &[Quantity::InverseDynamics, Quantity::ForwardDynamics]).expect("no frames");
    (model, robot)
}

#[test]
fn what_computes_is_told() {
    let (_, robot) = panda();
    assert_eq!(robot.engine(Quantity::MassMatrix), Engine::Kernels(Refusal::NotAsked));
    assert_eq!(robot.engine(Quantity::MassMatrix).to_string(), "kernels: nobody asked for machine code");
    let engine = robot.engine(Quantity::InverseDynamics);
    match Shape::OneF64.is_supported() {
        true => assert!(matches!(engine, Engine::MachineCode(Shape::OneF64, 1000..=20_000)), "{engine}"),
        false => assert_eq!(engine, Engine::Kernels(Refusal::Processor)),
    }
}

#[test]
fn turns_of_thousands_of_kilometres_and_nan_go_to_the_kernels() {
    let (model, robot) = panda();
    let [mut theta, dtheta, x] = state(&model, 3);
    theta[2] = 1e12;
    let (found, expected) = (
        robot.inverse_dynamics(&theta, &dtheta, &x),
        model.inverse_dynamics(&theta, &dtheta, &x, &model.environment()),
    );
    assert_eq!(found.expect("lengths"), expected.expect("lengths"));
    theta[2] = f64::NAN;
    assert!(robot.inverse_dynamics(&theta, &dtheta, &x).expect("lengths").iter().any(|x| x.is_nan()));
}

#[test]
fn errors_are_the_models() {
    let (model, robot) = panda();
    let [theta, dtheta, x] = state(&model, 3);
    let (found, expected) = (
        robot.inverse_dynamics(&theta[1..], &dtheta, &x),
        model.inverse_dynamics(&theta[1..], &dtheta, &x, &model.environment()),
    );
    assert_eq!(found.expect_err("short").to_string(), expected.expect_err("short").to_string());
    let other = common::tree(1, 3, 0).build().expect("sound");
    let frame = model.frames().last().expect("a frame").0;
    assert!(
        compile(&other, &[Quantity::BodyJacobian(frame)]).expect_err("another's").to_string().contains("another model")
    );
    // a massless tip that turns freely
    let mut robot = common::tree(2, 3, 0);
    let joint = robot.joints.last_mut().expect("one");
    (joint.armature, joint.damping, joint.friction) = (0.0, 0.0, 0.0);
    robot.links.last_mut().expect("one").inertia = mozzi::SpatialInertia::zero();
    let massless = robot.build().expect("sound");
    let compiled = compile(&massless, &[Quantity::ForwardDynamics]).expect("no frames");
    let [theta, dtheta, tau] = state(&massless, 1);
    let error = compiled.forward_dynamics(&theta, &dtheta, &tau).expect_err("singular");
    assert!(error.to_string().contains("singular at joint `joint3`"), "{error}");
}
