//! Many states by machine code, compared with one state by the kernels.
#![allow(missing_docs)]

use crate::common;
use crate::ways::ways;

use common::{compute, error, inputs, quantities, robots, state, tolerance};
use mozzi::Model;
use mozzi::quantities::{
    ForwardDynamics, InverseDynamics, InverseDynamicsDerivatives, InverseDynamicsVjp, MassMatrix, Query,
};
use mozzi::scalar::Float;
use mozzi_engine::{Batch, Compiled, Engine, Number, compile};

/// The outputs at these states, by rows.
fn by_rows(robot: &Compiled, query: Query, rows: &[[Vec<f64>; 3]]) -> Vec<Vec<f64>> {
    let count = query.declaration().inputs.len();
    let tables: Vec<Vec<f64>> =
        (0..count).map(|k| rows.iter().flat_map(|row| inputs(query, row)[k].to_vec()).collect()).collect();
    let tables: Vec<&[f64]> = tables.iter().map(Vec::as_slice).collect();
    let lengths = query.output_lengths(robot.model());
    let mut found: Vec<Vec<f64>> = lengths.map(|length| vec![f64::NAN; rows.len() * length]).collect();
    let mut outputs: Vec<&mut [f64]> = found.iter_mut().map(Vec::as_mut_slice).collect();
    let environment = robot.model().environment().into();
    robot.batch().compute(query, &tables, &environment, &mut outputs).expect("regular");
    found
}

#[test]
fn any_number_of_states() {
    for (name, model) in robots() {
        // compiled, and with nothing compiled: the kernels, as few states do not pay
        let queries = quantities(&model);
        for compiled in [&queries[..], &[]] {
            let robot = compile(&model, compiled).expect("its own frames").with_threads(2).expect("two threads");
            for (query, states) in queries.iter().flat_map(|&query| [0, 1, 8, 13].map(|states| (query, states))) {
                let rows: Vec<[Vec<f64>; 3]> = (0..states).map(|seed| state(&model, seed)).collect();
                let found = by_rows(&robot, query, &rows);
                for seed in 0..states {
                    let expected = compute(&model, query, seed).expect("regular");
                    for (found, expected) in found.iter().zip(&expected) {
                        let error = error(&found[seed as usize * expected.len()..][..expected.len()], expected);
                        assert!(
                            error < tolerance(query).max(1e-13),
                            "{name}, {}, state {seed} of {states}: {error:e}",
                            query.name()
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn any_number_of_states_on_one_thread_and_on_three() {
    let model = mozzi_urdf::open("panda").and_then(|robot| robot.build()).expect("an embedded robot");
    let queries =
        [InverseDynamics.into(), MassMatrix.into(), ForwardDynamics.into(), InverseDynamicsDerivatives.into()];
    for compiled in [&queries[..], &[]] {
        for threads in [1, 3] {
            let robot = compile(&model, compiled).expect("no frames").with_threads(threads).expect("threads");
            for (query, states) in queries.iter().flat_map(|&query| STATES.map(|states| (query, states))) {
                let rows: Vec<[Vec<f64>; 3]> = (0..states as u64).map(|seed| state(&model, seed % 211)).collect();
                let found = by_rows(&robot, query, &rows);
                let expected: Vec<_> =
                    (0..211.min(states as u64)).map(|seed| compute(&model, query, seed).expect("regular")).collect();
                for k in 0..states {
                    for (found, expected) in found.iter().zip(&expected[k % 211]) {
                        let error = error(&found[k * expected.len()..][..expected.len()], expected);
                        assert!(error < 1e-12, "{}, state {k} of {states}, {threads} threads: {error:e}", query.name());
                    }
                }
            }
        }
    }
}

/// The outputs of a batch at these states.
fn outputs<T: Number>(batch: &Batch<T>, query: Query, rows: &[[Vec<f64>; 3]]) -> Vec<Vec<T>> {
    let (count, model) = (query.declaration().inputs.len(), batch.model());
    let table = |k: usize| -> Vec<T> {
        rows.iter().flat_map(|row| inputs(query, row)[k].iter().map(|&x| T::from_f64(x)).collect::<Vec<_>>()).collect()
    };
    let tables: Vec<Vec<T>> = (0..count).map(table).collect();
    let tables: Vec<&[T]> = tables.iter().map(Vec::as_slice).collect();
    let widths = query.output_lengths(model);
    let mut found: Vec<Vec<T>> = widths.map(|width| vec![T::from_f64(f64::NAN); rows.len() * width]).collect();
    let mut outputs: Vec<&mut [T]> = found.iter_mut().map(Vec::as_mut_slice).collect();
    batch.compute(query, &tables, &model.environment().into(), &mut outputs).expect("regular");
    found
}

fn same_as_the_kernels<T: Number + Float>(name: &str, model: &Model) {
    let queries: [Query; 5] = [
        InverseDynamics.into(),
        MassMatrix.into(),
        ForwardDynamics.into(),
        InverseDynamicsDerivatives.into(),
        InverseDynamicsVjp.into(),
    ];
    let all: Vec<[Vec<f64>; 3]> = (0..77).map(|seed| state(model, seed)).collect();
    let ways = ways::<T>(model, &queries);
    let ((_, kernels), codes) = ways.split_first().expect("the kernels");
    for (way, code) in codes {
        for (query, states) in queries.iter().flat_map(|&query| STATES[..6].iter().map(move |&states| (query, states)))
        {
            assert!(matches!(code.engine(query), Engine::MachineCode(..)), "{}", code.engine(query));
            let (found, expected) = (outputs(code, query, &all[..states]), outputs(kernels, query, &all[..states]));
            let wide = |x: &[T]| x.iter().map(|&x| x.into()).collect::<Vec<f64>>();
            for (found, expected) in found.iter().zip(&expected) {
                let error = error(&wide(found), &wide(expected)) / T::EPSILON.into();
                assert!(error < 1e4, "{name}, {}, {states} states, {way}: {error} ε", query.name());
            }
        }
    }
}

#[test]
fn every_shape_number_type_and_remainder() {
    // rows narrower than a register, as wide, and wider
    let open = |name: &str| mozzi_urdf::open(name).and_then(|robot| robot.build()).expect("an embedded robot");
    let floating = open("anymal").description().clone().floating().build().expect("sound");
    let robots =
        [("two links", open("two_link_planar")), ("ur5", open("ur5")), ("panda", open("panda")), ("anymal", floating)];
    for (name, model) in &robots {
        same_as_the_kernels::<f64>(name, model);
        same_as_the_kernels::<f32>(name, model);
    }
}

/// Less than a register, whole registers, one more, and many.
const STATES: [usize; 7] = [1, 7, 8, 9, 29, 77, 10_000];

#[test]
fn what_registers_cannot_do_is_done_at_one_state() {
    let model = mozzi_urdf::open("ur5").and_then(|robot| robot.build()).expect("an embedded robot");
    let robot = compile(&model, &[MassMatrix.into()]).expect("no frames");
    let (batch, environment) = (robot.batch(), model.environment().into());
    let mut theta: Vec<f64> = (0..20).flat_map(|seed| state(&model, seed)[0].clone()).collect();
    (theta[6 * 3 + 2], theta[6 * 9 + 1]) = (3e9, f64::NAN);
    let mut M = vec![0.0; 20 * 36];
    batch.compute(MassMatrix, &[&theta], &environment, &mut [&mut M]).expect("lengths");
    for k in (0..20).filter(|&k| k != 9) {
        let expected = model.mass_matrix(&theta[6 * k..][..6]).expect("lengths");
        assert!(error(&M[36 * k..][..36], expected.as_slice()) < 1e-14, "state {k}");
    }
    assert!(M[36 * 9..][..36].iter().any(|x| x.is_nan()));
    let error = batch.compute(MassMatrix, &[&theta], &environment, &mut [&mut M[1..]]).expect_err("short").to_string();
    assert!(error.contains("M has 719 numbers, expected 720"), "{error}");
}
