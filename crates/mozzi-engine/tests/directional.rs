//! Derivatives along a direction against full derivative matrices and the regressor.

use mozzi::model::description::{Joint, JointKind};
use mozzi::quantities::{
    ForwardDynamics, ForwardDynamicsDerivatives, InverseDynamics, InverseDynamicsDerivatives, MomentumVjp, Query,
};
use mozzi::{Description, Model, SE3, SpatialInertia, Vec3};
use mozzi_engine::{Batch, BatchEnvironment, Direction};

fn anymal() -> Model {
    let robot = mozzi_urdf::open("anymal").expect("embedded");
    Description { base: mozzi::Base::Floating, ..robot.description }.build().expect("whole")
}

fn numbers(count: usize, seed: f64) -> Vec<f64> {
    (0..count).map(|k| (12.9898 * k as f64 + seed).sin()).collect()
}

/// Positions of `states` states, with unit quaternions.
fn positions(model: &Model, states: usize) -> Vec<f64> {
    let mut theta = numbers(states * model.nq(), 1.0);
    for state in theta.chunks_exact_mut(model.nq()) {
        let norm = state[..4].iter().map(|x| x * x).sum::<f64>().sqrt();
        state[..4].iter_mut().for_each(|x| *x /= norm);
    }
    theta
}

fn assert_close(found: &[f64], expected: &[f64]) {
    let size = expected.iter().fold(1.0_f64, |size, x| size.max(x.abs()));
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-12 * size, "{found} {expected}");
    }
}

#[test]
fn an_input_of_six_numbers_has_a_rate_of_six() {
    let (model, states) = (anymal(), 3);
    let (n, batch) = (model.n(), Batch::new(&model));
    let query = Query::from(MomentumVjp).about(Vec3([0.1, 0.2, 0.3]));
    let (theta, dtheta) = (positions(&model, states), numbers(states * n, 2.0));
    let (w, dw) = (numbers(states * 6, 3.0), numbers(states * 6, 4.0));
    let environment: BatchEnvironment = model.environment().into();
    let tables = || [vec![0.0; states * n], vec![0.0; states * n]];
    let ([mut a, mut b], [mut da, mut db]) = (tables(), tables());
    let direction = Direction { inputs: &[None, None, Some(&dw)], parameters: None };
    let (values, rates) = (&mut [&mut a[..], &mut b[..]], &mut [&mut da[..], &mut db[..]]);
    batch
        .directional_derivative(query, &[&theta, &dtheta, &w], direction, &environment, values, rates)
        .expect("lengths");
    // linear in w
    let [mut expected_a, mut expected_b] = tables();
    let expected = &mut [&mut expected_a[..], &mut expected_b[..]];
    batch.compute(query, &[&theta, &dtheta, &dw], &environment, expected).expect("lengths");
    assert_close(&da, &expected_a);
    assert_close(&db, &expected_b);
}

#[test]
fn rates_are_the_matrices_times_the_direction() {
    rates_of(70); // step by step
    rates_of(1003); // by machine code
}

fn rates_of(states: usize) {
    let model = anymal();
    let (n, batch) = (model.n(), Batch::new(&model));
    let theta = positions(&model, states);
    let inputs = [theta, numbers(states * n, 2.0), numbers(states * n, 3.0)];
    let rates = [4.0, 5.0, 6.0].map(|seed| numbers(states * n, seed));
    let (inputs, rates) = (inputs.each_ref().map(Vec::as_slice), rates.each_ref().map(|rate| Some(rate.as_slice())));
    let environment: BatchEnvironment = model.environment().into();
    let pairs: [(Query, Query, usize); 2] = [
        (InverseDynamics.into(), InverseDynamicsDerivatives.into(), 0),
        (ForwardDynamics.into(), ForwardDynamicsDerivatives.into(), 1),
    ];
    for (query, derivatives, first) in pairs {
        let (mut values, mut found) = (vec![0.0; states * n], vec![0.0; states * n]);
        let direction = Direction { inputs: &rates, parameters: None };
        batch
            .directional_derivative(query, &inputs, direction, &environment, &mut [&mut values], &mut [&mut found])
            .expect("regular");
        let mut plain = vec![0.0; states * n];
        batch.compute(query, &inputs, &environment, &mut [&mut plain]).expect("regular");
        assert_close(&values, &plain);
        let mut matrices: Vec<Vec<f64>> =
            derivatives.output_lengths(&model).map(|length| vec![0.0; states * length]).collect();
        let mut slices: Vec<&mut [f64]> = matrices.iter_mut().map(Vec::as_mut_slice).collect();
        batch.compute(derivatives, &inputs, &environment, &mut slices).expect("regular");
        let mut expected = vec![0.0; states * n];
        for (matrix, rate) in matrices[first..].iter().zip(rates.into_iter().flatten()) {
            for (k, (entry, row)) in expected.iter_mut().zip(matrix.chunks_exact(n)).enumerate() {
                *entry += row.iter().zip(&rate[k / n * n..]).map(|(a, b)| a * b).sum::<f64>();
            }
        }
        assert_close(&found, &expected);
    }
}

#[test]
fn rates_of_parameters_are_the_regressors() {
    let model = anymal();
    let (n, p, states) = (model.n(), model.parameter_count(), 3);
    let batch = Batch::new(&model);
    let inputs = [positions(&model, states), numbers(states * n, 2.0), numbers(states * n, 3.0)];
    let inputs = inputs.each_ref().map(Vec::as_slice);
    let (rate, environment) = (numbers(states * p, 7.0), model.environment());
    let parameters: Vec<f64> = (0..states).flat_map(|_| model.parameters()).map(|x| 1.1 * x).collect();
    let Y = |k: usize| {
        let at = |slice: &[f64], width: usize| slice[k * width..][..width].to_vec();
        let (theta, dtheta, ddtheta) = (at(inputs[0], model.nq()), at(inputs[1], n), at(inputs[2], n));
        model.regressor(&theta, &dtheta, &ddtheta, &environment).expect("lengths")
    };
    for given in [None, Some(parameters.as_slice())] {
        let around = BatchEnvironment { parameters: given, ..environment.into() };
        let (mut values, mut found) = (vec![0.0; states * n], vec![0.0; states * n]);
        let direction = Direction { inputs: &[None, None, None], parameters: Some(&rate) };
        let (values_out, found_out) = (&mut [&mut values[..]], &mut [&mut found[..]]);
        batch
            .directional_derivative(InverseDynamics, &inputs, direction, &around, values_out, found_out)
            .expect("lengths");
        for k in 0..states {
            let pi = given.map_or_else(|| model.parameters(), |pi| pi[k * p..][..p].to_vec());
            for (row, i) in Y(k).row_iter().zip(0..n) {
                let along = |pi: &[f64]| row.iter().zip(pi).map(|(y, x)| y * x).sum::<f64>();
                let size = row.iter().zip(&pi).map(|(y, x)| (y * x).abs()).sum::<f64>() + 1.0;
                assert!((values[k * n + i] - along(&pi)).abs() < 1e-12 * size);
                let size = row.iter().map(|y| y.abs()).sum::<f64>() + 1.0;
                assert!((found[k * n + i] - along(&rate[k * p..][..p])).abs() < 1e-12 * size);
            }
        }
    }
}

#[test]
fn errors_name_the_table_and_the_state() {
    let model = Description::new("massless")
        .link("base", SpatialInertia::zero())
        .link("arm", SpatialInertia::point_mass(1.0, Vec3([0.0; 3])))
        .joint(Joint::new(
            "turn",
            "base",
            "arm",
            SE3::identity(),
            JointKind::Screw(mozzi::ScrewAxis::new([0.0, 0.0, 1.0], [0.0; 3]).expect("unit")),
        ))
        .build()
        .expect("a robot");
    let (batch, environment) = (Batch::new(&model), model.environment().into());
    let run = |rate: &[f64]| {
        let (mut values, mut found) = ([0.0; 2], [0.0; 2]);
        let direction = Direction { inputs: &[Some(rate), None, None], parameters: None };
        let inputs = [&[0.1, 0.2][..]; 3];
        let error = batch.directional_derivative(
            ForwardDynamics,
            &inputs,
            direction,
            &environment,
            &mut [&mut values],
            &mut [&mut found],
        );
        error.expect_err("refused").to_string()
    };
    let error = run(&[1.0, 2.0, 3.0]);
    assert!(error.contains("a rate of the direction has 3 numbers, expected 2"), "{error}");
    let error = run(&[1.0, 2.0]);
    assert!(error.contains("state 0") && error.contains("turn"), "{error}");
}
