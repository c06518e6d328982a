//! Many states: threads, states that fail, both number types, simulation.
#![allow(missing_docs)]

use mozzi::quantities::{
    CenterOfMassJacobian, ConstraintJacobian, ConstraintResidual, ForwardDynamics, GravityForces, InverseDynamics,
    MassMatrix, Query, Regressor, TaskSpaceDynamics,
};
use mozzi::testing::{Random, floating_tree, four_bar, state, tree};
use mozzi::{Model, Task, TaskFrame};
use mozzi_engine::{Batch, BatchEnvironment, Number};
use mozzi_sim::{Method, Options};

use crate::ways::ways;

/// Concatenated states.
struct States {
    theta: Vec<f64>,
    dtheta: Vec<f64>,
    x: Vec<f64>,
}

impl States {
    fn new(model: &Model, count: usize) -> Self {
        let mut all = States { theta: vec![], dtheta: vec![], x: vec![] };
        for k in 0..count {
            let [mut theta, mut dtheta, x] = state(model, k as u64);
            if model.constraint_rows() > 0 {
                theta = model.assemble(&[1.0 + 0.001 * k as f64, -0.6, 1.6], &[]).expect("closed");
                dtheta = model.assemble_velocities(&theta, &dtheta, &[]).expect("closed");
            }
            all.theta.extend(theta);
            all.dtheta.extend(dtheta);
            all.x.extend(x);
        }
        all
    }
}

fn numbers<T: Number>(list: &[f64]) -> Vec<T> {
    list.iter().map(|&x| T::from_f64(x)).collect()
}

#[test]
fn f32_forward_dynamics_undoes_inverse_dynamics() {
    let model = tree(6, 3, 0);
    let (states, environment) = (States::new(&model, 21), model.environment().into());
    let [q, v, a] = [&states.theta, &states.dtheta, &states.x].map(|x| numbers::<f32>(x));
    for (way, batch) in ways::<f32>(&model, &[InverseDynamics.into(), ForwardDynamics.into()]) {
        let (mut tau, mut again) = (vec![0.0; a.len()], vec![0.0; a.len()]);
        batch.compute(InverseDynamics, &[&q, &v, &a], &environment, &mut [&mut tau]).unwrap();
        batch.compute(ForwardDynamics, &[&q, &v, &tau], &environment, &mut [&mut again]).unwrap();
        for (x, y) in a.iter().zip(&again) {
            assert!((x - y).abs() < 2e-2, "{x} {y} by {way}");
        }
    }
}

#[test]
fn threads_change_no_bit() {
    for model in [tree(1, 7, 0), floating_tree(3, 6, 0)] {
        let (states, environment) = (States::new(&model, 5003), BatchEnvironment::from(model.environment()));
        let queries: [Query; 3] = [InverseDynamics.into(), MassMatrix.into(), CenterOfMassJacobian.into()];
        for (way, batch) in ways(&model, &queries) {
            let run = |batch: &Batch| {
                queries.map(|query| {
                    let mut found = vec![f64::NAN; 5003 * query.output_lengths(&model).sum::<usize>()];
                    let inputs = &[&states.theta[..], &states.dtheta, &states.x][..query.declaration().inputs.len()];
                    batch.compute(query, inputs, &environment, &mut [&mut found]).unwrap();
                    found
                })
            };
            let one = run(&batch.clone().with_threads(1).unwrap());
            assert!(one == run(&batch) && one == run(&batch.clone().with_threads(3).unwrap()), "{way}");
        }
    }
}

#[test]
fn a_state_that_is_no_number_spoils_no_other() {
    let model = tree(1, 7, 0);
    let n = model.n();
    let (mut states, environment) = (States::new(&model, 40), BatchEnvironment::from(model.environment()));
    let queries: [Query; 2] = [ForwardDynamics.into(), Regressor.into()];
    let all = ways(&model, &queries);
    for (batch, query) in all.iter().flat_map(|(_, batch)| queries.map(|query| (batch, query))) {
        let width = query.output_lengths(&model).sum();
        let run = |states: &States| {
            let mut x = vec![0.0; 40 * width];
            let inputs: [&[f64]; 3] = [&states.theta, &states.dtheta, &states.x];
            batch.compute(query, &inputs, &environment, &mut [&mut x]).unwrap();
            x
        };
        let clean = run(&states);
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let before = std::mem::replace(&mut states.theta[13 * n + 2], bad);
            for (k, (a, b)) in run(&states).chunks(width).zip(clean.chunks(width)).enumerate() {
                if k == 13 { assert!(a.iter().any(|x| x.is_nan())) } else { assert_eq!(a, b) }
            }
            states.theta[13 * n + 2] = before;
        }
    }
}

#[test]
fn many_turns_are_reduced_exactly() {
    let model = tree(1, 7, 0);
    let mut states = States::new(&model, 9);
    let mut random = Random(5);
    for x in &mut states.theta {
        *x += 1e3 * (random.next() * 12.0).exp2() * 1e5;
    }
    let (n, environment) = (model.n(), model.environment());
    for (way, batch) in ways(&model, &[GravityForces.into()]) {
        let mut g = vec![0.0; 9 * n];
        batch.compute(GravityForces, &[&states.theta], &environment.into(), &mut [&mut g]).unwrap();
        for (theta, g) in states.theta.chunks(n).zip(g.chunks(n)) {
            let expected = model.gravity_forces(theta).unwrap();
            for (a, b) in g.iter().zip(expected.iter()) {
                assert!((a - b).abs() <= 1e-12 * expected.amax(), "{a} {b} by {way}");
            }
        }
    }
}

#[test]
fn many_robots_move_as_each_alone() {
    for model in [tree(5, 3, 0), floating_tree(3, 3, 0), four_bar()] {
        // robots without dry friction move together
        let mut robot = model.description().clone();
        robot.joints.iter_mut().for_each(|joint| joint.friction = 0.0);
        let model = robot.build().unwrap();
        let (count, nq, n) = (601, model.nq(), model.n()); // more than one piece
        let mut states = States::new(&model, count);
        states.dtheta.iter_mut().for_each(|x| *x *= 0.1);
        states.x.iter_mut().for_each(|x| *x *= if model.constraint_rows() > 0 { 0.1 } else { 1.0 });
        let environment = BatchEnvironment::from(model.environment());
        let (duration, steps) = (0.02, 4);
        for method in [Method::Euler, Method::SemiImplicitEuler, Method::RungeKutta4] {
            for (way, batch) in ways(&model, &[mozzi_sim::forward_dynamics_of(&model)]) {
                let (mut q, mut v) = (states.theta.clone(), states.dtheta.clone());
                batch.simulate(&mut q, &mut v, &states.x, &environment, method, duration, steps).unwrap();
                for k in [0, 17, 600] {
                    let tau = states.x[k * n..][..n].to_vec();
                    let input = mozzi_sim::torque(|_t, _q, _v, out| out.copy_from_slice(&tau));
                    let options = Options { method, ..Options::new(duration, steps) };
                    let (q0, v0) = (&states.theta[k * nq..][..nq], &states.dtheta[k * n..][..n]);
                    let alone = mozzi_sim::simulate(&model, q0, v0, input, &options).unwrap();
                    let end = alone.last();
                    for (a, b) in
                        q[k * nq..][..nq].iter().chain(&v[k * n..][..n]).zip(end.theta.iter().chain(end.dtheta.iter()))
                    {
                        assert!((a - b).abs() <= 1e-9 * (1.0 + b.abs()), "{a} {b} by {way}");
                    }
                }
                // on other threads: identical to the bit
                let (mut q2, mut v2) = (states.theta.clone(), states.dtheta.clone());
                let other = batch.clone().with_threads(2).unwrap();
                other.simulate(&mut q2, &mut v2, &states.x, &environment, method, duration, steps).unwrap();
                assert!(q == q2 && v == v2, "{way}");
            }
        }
    }
}

#[test]
fn loops_stay_closed_in_f32_and_open_starts_are_refused() {
    let model = four_bar();
    let (states, environment) = (States::new(&model, 20), model.environment().into());
    let [mut q, mut v] = [&states.theta, &states.dtheta].map(|x| numbers::<f32>(x));
    let batch = Batch::<f32>::of(&model);
    let tau = vec![0.0; v.len()];
    batch.simulate(&mut q, &mut v, &tau, &environment, Method::RungeKutta4, 0.5, 500).unwrap();
    let wide = |x: &[f32]| x.iter().map(|&x| f64::from(x)).collect::<Vec<_>>();
    let (m, mut phi, mut A) = (model.constraint_rows(), vec![0.0; 20 * 5], vec![0.0; 20 * 5 * 3]);
    let (exact, environment64) = (Batch::new(&model), BatchEnvironment::from(model.environment()));
    exact.compute(ConstraintResidual, &[&wide(&q)], &environment64, &mut [&mut phi]).unwrap();
    exact.compute(ConstraintJacobian, &[&wide(&q)], &environment64, &mut [&mut A]).unwrap();
    assert!(m == 5 && phi.iter().all(|gap| gap.abs() < 2e-6), "{phi:?}");
    for (A, dtheta) in A.chunks_exact(5 * 3).zip(wide(&v).chunks_exact(3)) {
        for row in A.chunks_exact(3) {
            let speed: f64 = row.iter().zip(dtheta).map(|(a, rate)| a * rate).sum();
            assert!(speed.abs() < 1e-5, "{speed}");
        }
    }
    q[3] += 0.01;
    let error = batch.simulate(&mut q, &mut v, &tau, &environment, Method::RungeKutta4, 0.5, 500).unwrap_err();
    assert!(
        error
            .to_string()
            .starts_with("state 1 (counted from 0): the start has a position that violates constraint `loop`"),
        "{error}"
    );
}

#[test]
fn a_task_of_six_rows_and_one_that_cannot_be() {
    let task = |model: &Model| Task::all(model.end_effector().unwrap(), TaskFrame::Body);
    let query = |model: &Model| Query::from(TaskSpaceDynamics).of_task(task(model));
    let model = (0..1000).map(|seed| tree(seed, 9, 0)).find(|m| {
        let [q, v, _] = state(m, 1);
        m.task_space_dynamics(&q, &v, task(m), &m.environment()).is_ok()
    });
    let model = model.expect("one of a thousand trees reaches in all directions");
    let (n, states) = (model.n(), States::new(&model, 13));
    for (way, batch) in ways(&model, &[query(&model)]) {
        let (mut Lambda, mut eta) = (vec![0.0; 13 * 36], vec![0.0; 13 * 6]);
        let inputs: [&[f64]; 2] = [&states.theta, &states.dtheta];
        let environment = model.environment().into();
        batch.compute(query(&model), &inputs, &environment, &mut [&mut Lambda, &mut eta]).unwrap();
        for k in 0..13 {
            let (q, v) = (&states.theta[k * n..][..n], &states.dtheta[k * n..][..n]);
            let one = model.task_space_dynamics(q, v, task(&model), &model.environment()).unwrap();
            for (a, b) in Lambda[k * 36..][..36].iter().zip(one.Lambda.iter()) {
                assert!((a - b).abs() <= 1e-6 * one.Lambda.amax(), "{a} {b} by {way}");
            }
            for (a, b) in eta[k * 6..][..6].iter().zip(one.eta.iter()) {
                assert!((a - b).abs() <= 1e-6 * (one.eta.amax() + one.Lambda.amax()), "{a} {b} by {way}");
            }
        }
    }
    // three joints cannot move a frame in six directions
    let short = tree(1, 3, 0);
    let states = States::new(&short, 2);
    for (_, batch) in ways(&short, &[query(&short)]) {
        let (mut Lambda, mut eta) = (vec![0.0; 72], vec![0.0; 12]);
        let inputs: [&[f64]; 2] = [&states.theta, &states.dtheta];
        let environment = short.environment().into();
        let error = batch.compute(query(&short), &inputs, &environment, &mut [&mut Lambda, &mut eta]);
        let error = error.expect_err("singular").to_string();
        assert!(error.starts_with("state 0 (counted from 0): the task is singular at θ = "), "{error}");
    }
}
