//! Many states by machine code, against one state by the kernels.
#![allow(missing_docs)]

mod common;

use common::{error, robots, state};
use mozzi_batch::Layout;
use mozzi_codegen::{Quantity, compile};

const QUANTITIES: [Quantity; 4] =
    [Quantity::InverseDynamics, Quantity::MassMatrix, Quantity::ForwardDynamics, Quantity::ForwardDynamicsDerivatives];

#[test]
fn rows_and_blocks_of_any_number_of_states() {
    for (name, model) in robots() {
        let (n, nq) = (model.n(), model.nq());
        // compiled, and with nothing compiled: the batch's kernels
        for quantities in [&QUANTITIES[..], &[]] {
            let robot = compile(&model, quantities).expect("no frames").with_threads(2).expect("two threads");
            for states in [0, 1, 8, 13] {
                let rows: Vec<[Vec<f64>; 3]> = (0..states).map(|seed| state(&model, seed as u64)).collect();
                let [theta, dtheta, x] =
                    [0, 1, 2].map(|k| rows.iter().flat_map(|row| row[k].clone()).collect::<Vec<_>>());
                let near = |what: &str, found: &[f64], of: &dyn Fn(&[Vec<f64>; 3]) -> Vec<f64>| {
                    for (k, row) in rows.iter().enumerate() {
                        let expected = of(row);
                        let error = error(&found[k * expected.len()..][..expected.len()], &expected);
                        assert!(error < 1e-10, "{name}, {what}, state {k} of {states}: {error:e}");
                    }
                };
                let environment = model.environment();
                let (mut tau, mut M, mut ddtheta) =
                    (vec![0.0; states * n], vec![0.0; states * n * n], vec![0.0; states * n]);
                robot.inverse_dynamics_batch(&theta, &dtheta, &x, &mut tau).expect("lengths");
                near("τ", &tau, &|[a, b, c]| {
                    model.inverse_dynamics(a, b, c, &environment).expect("sound").as_slice().to_vec()
                });
                robot.mass_matrix_batch(&theta, &mut M).expect("lengths");
                near("M", &M, &|[a, ..]| model.mass_matrix(a).expect("sound").as_slice().to_vec());
                robot.forward_dynamics_batch(&theta, &dtheta, &x, &mut ddtheta).expect("regular");
                near("θ̈", &ddtheta, &|[a, b, c]| {
                    model.forward_dynamics(a, b, c, &environment).expect("sound").as_slice().to_vec()
                });
                let [mut d_theta, mut d_dtheta, mut d_tau] = [(); 3].map(|()| vec![0.0; states * n * n]);
                robot
                    .forward_dynamics_derivatives_batch(
                        &theta,
                        &dtheta,
                        &x,
                        &mut ddtheta,
                        &mut d_theta,
                        &mut d_dtheta,
                        &mut d_tau,
                    )
                    .expect("regular");
                near("∂θ̈/∂θ", &d_theta, &|[a, b, c]| {
                    let d = model.forward_dynamics_derivatives(a, b, c, &environment).expect("sound");
                    d.d_theta.transpose().as_slice().to_vec()
                });
            }
            let robot = robot.with_layout(Layout::Blocks);
            let rows: Vec<f64> = (0..13).flat_map(|seed| state(&model, seed)[0].clone()).collect();
            let blocks = robot.batch().to_blocks(&rows, nq);
            let mut M = vec![0.0; blocks.len() / nq * n * n];
            robot.mass_matrix_batch(&blocks, &mut M).expect("lengths");
            let found = robot.batch().to_rows(&M, n * n, 13);
            let expected = model.mass_matrix(&rows[12 * nq..]).expect("lengths");
            assert!(error(&found[12 * n * n..], expected.as_slice()) < 1e-13, "{name}");
        }
    }
}

#[test]
fn what_registers_cannot_do_is_done_at_one_state() {
    let model = mozzi_urdf::open("ur5").and_then(|robot| robot.build()).expect("an embedded robot");
    let robot = compile(&model, &QUANTITIES).expect("no frames");
    let mut theta: Vec<f64> = (0..20).flat_map(|seed| state(&model, seed)[0].clone()).collect();
    (theta[6 * 3 + 2], theta[6 * 9 + 1]) = (3e9, f64::NAN);
    let mut M = vec![0.0; 20 * 36];
    robot.mass_matrix_batch(&theta, &mut M).expect("lengths");
    for k in (0..20).filter(|&k| k != 9) {
        let expected = model.mass_matrix(&theta[6 * k..][..6]).expect("lengths");
        assert!(error(&M[36 * k..][..36], expected.as_slice()) < 1e-14, "state {k}");
    }
    assert!(M[36 * 9..][..36].iter().any(|x| x.is_nan()));
    let error = robot.mass_matrix_batch(&theta, &mut M[1..]).expect_err("short").to_string();
    assert!(error.contains("M has 719 numbers, expected 720"), "{error}");
}
