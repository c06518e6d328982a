//! What was recorded, interpreted, against the kernels.
#![allow(missing_docs)]

mod common;

use common::{error, quantities, robots, state};
use mozzi::{Dual, Environment, Model, Scalar, Vec3, Wrench};
use mozzi_codegen::{Arguments, Program, Quantity};

/// The kernels' outputs, by the methods of the model.
fn reference(
    model: &Model,
    quantity: Quantity,
    [theta, dtheta, x]: &[Vec<f64>; 3],
    environment: &Environment,
) -> Vec<Vec<f64>> {
    let rows = |M: mozzi::nalgebra::DMatrix<f64>| M.transpose().as_slice().to_vec();
    let columns = |J: mozzi::Jacobian| J.0.iter().flat_map(|column| column.to_array()).collect();
    let list = |x: mozzi::nalgebra::DVector<f64>| x.as_slice().to_vec();
    match quantity {
        Quantity::InverseDynamics => {
            vec![list(model.inverse_dynamics(theta, dtheta, x, environment).expect("lengths"))]
        }
        Quantity::MassMatrix => vec![rows(model.mass_matrix(theta).expect("lengths"))],
        Quantity::ForwardDynamics => {
            vec![list(model.forward_dynamics(theta, dtheta, x, environment).expect("regular"))]
        }
        Quantity::BiasForces => vec![list(model.bias_forces(theta, dtheta, environment).expect("lengths"))],
        Quantity::VelocityProduct => vec![list(model.velocity_product(theta, dtheta).expect("lengths"))],
        Quantity::GravityForces => vec![list(model.gravity_forces(theta).expect("lengths"))],
        Quantity::ForwardKinematics(frame) => {
            let T = model.forward_kinematics(theta, frame).expect("lengths");
            vec![T.R.matrix().rows().concat(), T.p.0.to_vec()]
        }
        Quantity::BodyJacobian(frame) => vec![columns(model.body_jacobian(theta, frame).expect("lengths"))],
        Quantity::SpaceJacobian(frame) => vec![columns(model.space_jacobian(theta, frame).expect("lengths"))],
        Quantity::InverseDynamicsDerivatives => {
            let d = model.inverse_dynamics_derivatives(theta, dtheta, x, environment).expect("lengths");
            [d.d_theta, d.d_dtheta, d.d_ddtheta].map(rows).to_vec()
        }
        Quantity::ForwardDynamicsDerivatives => {
            let d = model.forward_dynamics_derivatives(theta, dtheta, x, environment).expect("regular");
            [list(d.ddtheta)].into_iter().chain([d.d_theta, d.d_dtheta, d.d_tau].map(rows)).collect()
        }
    }
}

/// Pivots and solves lose what the matrix's condition takes.
fn tolerance(quantity: Quantity) -> f64 {
    match quantity {
        Quantity::ForwardDynamics | Quantity::ForwardDynamicsDerivatives => 1e-10,
        _ => 2e-14,
    }
}

#[test]
fn every_quantity_of_every_robot() {
    for (name, model) in robots() {
        for quantity in quantities(&model) {
            let program = quantity.record(&model, Arguments::default());
            let text: Program = program.to_string().parse().expect("a program");
            assert_eq!(text.to_string(), program.to_string());
            for seed in 0..3 {
                let state = state(&model, seed);
                let slices: Vec<&[f64]> = state[..program.inputs().len()].iter().map(Vec::as_slice).collect();
                let found = program.evaluate(&slices);
                assert_eq!(text.evaluate(&slices), found);
                let expected = reference(&model, quantity, &state, &model.environment());
                for (found, expected) in found.iter().zip(&expected) {
                    let error = error(found, expected);
                    assert!(error < tolerance(quantity), "{name}, {}: {error:e}", quantity.name());
                }
            }
        }
    }
}

#[test]
fn folding_leaves_less_work() {
    for (name, model) in robots() {
        for quantity in quantities(&model) {
            let program = quantity.record(&model, Arguments::default());
            let (before, after) = (program.count_before_folding().expect("recorded"), program.count());
            assert!(after.flops() < before.flops(), "{name}, {}: {before}; {after}", quantity.name());
        }
    }
    let ur5 = mozzi_urdf::open("ur5").and_then(|robot| robot.build()).expect("an embedded robot");
    let count = Quantity::InverseDynamics.record(&ur5, Arguments::default()).count();
    assert!(count.flops() < 420, "{count}");
}

#[test]
fn what_is_left_open_is_an_input() {
    for (name, model) in robots() {
        let tip = model.frames().last().expect("a frame").0;
        let open = Arguments { parameters: true, gravity: true, wrench: Some(tip) };
        for quantity in [Quantity::InverseDynamics, Quantity::ForwardDynamics, Quantity::BiasForces] {
            let program = quantity.record(&model, open);
            let names: Vec<_> = program.inputs().iter().map(|input| input.name.as_str()).collect();
            assert_eq!(names[names.len() - 3..], ["parameters", "gravity", "wrench"]);
            let (state, gravity, push) = (state(&model, 5), [1.0, 2.0, -3.0], [0.1, 0.2, 0.3, 4.0, 5.0, 6.0]);
            let pi = model.parameters();
            let mut slices: Vec<&[f64]> = state[..names.len() - 3].iter().map(Vec::as_slice).collect();
            slices.extend([&pi[..], &gravity, &push]);
            let found = program.evaluate(&slices);
            let applied = [(tip, Wrench::from_array(push))];
            let environment = Environment { applied: &applied, ..Environment::with_gravity(Vec3(gravity)) };
            let error = error(&found[0], &reference(&model, quantity, &state, &environment)[0]);
            assert!(error < 1e-9, "{name}, {}: {error:e}", quantity.name());
            // half the masses and frictions, half the forces
            if quantity == Quantity::InverseDynamics {
                let half: Vec<f64> = pi.iter().map(|x| x / 2.0).collect();
                let none = [0.0; 6];
                let at = slices.len();
                let mut run = |pi| {
                    (slices[at - 3], slices[at - 1]) = (pi, &none);
                    program.evaluate(&slices).remove(0)
                };
                let (whole, halves) = (run(&pi[..]), run(&half[..]));
                let twice: Vec<f64> = halves.iter().map(|x| 2.0 * x).collect();
                assert!(common::error(&twice, &whole) < 1e-13, "{name}");
            }
        }
    }
}

#[test]
fn programs_run_on_any_scalar() {
    // the derivative of τ along θ̈ is M's product
    let model = mozzi_urdf::open("panda").and_then(|robot| robot.build()).expect("an embedded robot");
    let program = Quantity::InverseDynamics.record(&model, Arguments::default());
    let [theta, dtheta, ddtheta] = state(&model, 1);
    let (along, zero) = (vec![1.0; model.n()], vec![0.0; model.n()]);
    let duals = [Dual::list(&theta, &zero), Dual::list(&dtheta, &zero), Dual::list(&ddtheta, &along)];
    let tau = program.evaluate(&duals.each_ref().map(Vec::as_slice)).remove(0);
    let M = model.mass_matrix(&theta).expect("lengths");
    let found: Vec<f64> = tau.iter().map(|x| x.derivative).collect();
    let expected: Vec<f64> = M.row_iter().map(|row| row.sum()).collect();
    assert!(error(&found, &expected) < 1e-14);
    // f32 is f64 to seven digits
    let single = [&theta, &dtheta, &ddtheta].map(|x| x.iter().map(|&x| x as f32).collect::<Vec<_>>());
    let rounded = single.each_ref().map(|x| x.iter().map(|&x| f64::from(x)).collect::<Vec<_>>());
    let tau = program.evaluate(&single.each_ref().map(Vec::as_slice)).remove(0);
    let expected = program.evaluate(&rounded.each_ref().map(Vec::as_slice)).remove(0);
    assert!(error(&tau.iter().map(|&x| f64::from(x)).collect::<Vec<_>>(), &expected) < 2e-6);
}

#[test]
fn signs_and_shared_operations_are_free() {
    let program = mozzi_codegen::record("p", &[("x", 3)], |x| {
        let [a, b, c] = [x[0][0], x[0][1], x[0][2]];
        let o = mozzi_codegen::Traced::zero();
        let y = (a - b) * (b - a) + o * c; // −(a − b)²
        vec![("y", vec![y, -y, (-a).mul_add(-b, -(-c)), a * b + c, -(a - b), a / -b, (-a).sgn()])]
    });
    let count = program.count();
    assert_eq!((count.add, count.mul, count.fma, count.div), (1, 1, 2, 1), "{program}");
    let found = program.evaluate(&[&[3.0, 5.0, 7.0]]);
    assert_eq!(found, [[-4.0, 4.0, 22.0, 22.0, 2.0, -0.6, -1.0]]);
}
