//! When machine code is made: by the sizes of a batch's calls alone.

use mozzi::quantities::{ForwardDynamics, InverseDynamics, InverseDynamicsDerivatives, MassMatrix, Query};
use mozzi::testing::{floating_tree, mixed_tree, state, tree};
use mozzi::{FrameId, Model, Vec3};
use mozzi_engine::{Batch, BatchEnvironment, Engine, Number, Refusal};
use std::sync::atomic::{AtomicUsize, Ordering};

fn has_code() -> bool {
    <f64 as Number>::shape().is_some()
}

/// Computes M at so many equal states.
fn call(batch: &Batch, states: usize, environment: &BatchEnvironment) -> Vec<f64> {
    let n = batch.model().n();
    let (theta, mut M) = (state(batch.model(), 1)[0].repeat(states), vec![0.0; states * n * n]);
    batch.compute(MassMatrix, &[&theta], environment, &mut [&mut M]).expect("lengths");
    M
}

fn is_code(engine: Engine) -> bool {
    matches!(engine, Engine::MachineCode(..))
}

fn robot() -> Model {
    tree(1, 7, 0)
}

#[test]
fn a_large_call_makes_code_and_small_ones_together() {
    let (model, batch) = (robot(), Batch::new(&robot()));
    let environment = model.environment().into();
    assert_eq!(
        batch.engine(MassMatrix),
        Engine::Kernels(if has_code() { Refusal::NotYet } else { Refusal::Processor })
    );
    call(&batch, 1000, &environment);
    assert_eq!(is_code(batch.engine(MassMatrix)), has_code());
    // calls of another quantity, and of another batch of the same robot, do not count
    assert!(!is_code(batch.engine(InverseDynamics)) && !is_code(Batch::new(&model).engine(MassMatrix)));
    let small = Batch::new(&model);
    let clone = small.clone().with_threads(1).expect("one");
    for calls in 1..=10 {
        assert!(!is_code(small.engine(MassMatrix)), "{calls}");
        call(if calls % 2 == 0 { &small } else { &clone }, 100, &environment);
    }
    assert_eq!(is_code(small.engine(MassMatrix)), has_code());
}

#[test]
fn each_environment_has_its_own_code() {
    let (model, batch) = (robot(), Batch::new(&robot()));
    let (tip, n): (FrameId, usize) = (model.end_effector().expect("named"), model.n());
    let theta = state(&model, 1)[0].repeat(1000);
    let wrenches = [1.0; 6].repeat(1000);
    let of_tip = [(tip, &wrenches[..])];
    let with_wrench = BatchEnvironment::from(model.environment()).with_wrenches(&of_tip);
    let (zero, mut tau) = (vec![0.0; n * 1000], vec![0.0; n * 1000]);
    batch.compute(InverseDynamics, &[&theta, &zero, &zero], &with_wrench, &mut [&mut tau]).expect("lengths");
    assert_eq!(is_code(batch.engine_in(InverseDynamics, &with_wrench)), has_code());
    let mut other = model.environment();
    other.gravity = Vec3([0.0, 1.0, 2.0]);
    assert!(!is_code(batch.engine(InverseDynamics)) && !is_code(batch.engine_in(InverseDynamics, &other.into())));
}

#[test]
fn kernels_only_is_for_ever() {
    let (model, batch) = (robot(), Batch::new(&robot()).kernels_only());
    let environment = model.environment().into();
    let M = call(&batch, 5000, &environment);
    assert_eq!(batch.engine(MassMatrix), Engine::Kernels(Refusal::NotAsked));
    let batch = batch.compile(&[MassMatrix.into()]).expect("no frame");
    assert_eq!(batch.engine(MassMatrix), Engine::Kernels(Refusal::NotAsked));
    let theta = &state(&model, 1)[0];
    let (mut workspace, mut one) = (mozzi::fast::Workspace::new(&model), vec![0.0; 49]);
    let query = MassMatrix.into();
    mozzi::fast::evaluate(&query, &model, &[theta], &model.environment(), &mut workspace, &mut [&mut one]);
    assert!(M.chunks_exact(49).all(|M| M == one), "to the bit");
}

#[test]
fn a_job_has_one_engine() {
    let (model, batch) = (robot(), Batch::new(&robot()));
    let environment: BatchEnvironment = model.environment().into();
    let (few, many) = [10, 2000].map(|states| batch.for_job_of(&[MassMatrix.into()], &environment, states)).into();
    let (few, many) = (few.expect("no frame"), many.expect("no frame"));
    assert_eq!(is_code(many.engine(MassMatrix)), has_code());
    call(&few, 5000, &environment);
    assert!(!is_code(few.engine(MassMatrix)), "as decided");
    call(&many, 5000, &environment);
    assert!(!is_code(many.engine(InverseDynamics)));
}

#[test]
fn many_threads_make_it_once_and_agree() {
    let model = robot();
    let batch = Batch::new(&model).with_threads(1).expect("one");
    let environment: BatchEnvironment = model.environment().into();
    let found: Vec<Vec<f64>> = std::thread::scope(|scope| {
        let calls: Vec<_> = (0..8).map(|_| scope.spawn(|| call(&batch, 1500, &environment))).collect();
        calls.into_iter().map(|call| call.join().expect("no panic")).collect()
    });
    assert!(found.iter().all(|M| *M == found[0]));
}

/// xorshift64.
fn next(seed: &mut u64) -> usize {
    *seed ^= *seed << 13;
    *seed ^= *seed >> 7;
    *seed ^= *seed << 17;
    (*seed >> 16) as usize
}

#[test]
fn a_hundred_thousand_calls_from_eight_threads_agree_with_the_kernels() {
    const STATES: usize = 500;
    let queries: [Query; 4] =
        [MassMatrix.into(), InverseDynamics.into(), ForwardDynamics.into(), InverseDynamicsDerivatives.into()];
    // a table of states of each robot and quantity, and what one state's kernels say
    let jobs: Vec<_> = [robot(), mixed_tree(2, 8, 1), floating_tree(3, 6, 0)]
        .into_iter()
        .flat_map(|model| {
            let batch = Batch::new(&model).with_threads(1).expect("one");
            let seeds = 0..STATES as u64;
            let states: Vec<_> = seeds.map(|seed| state(&model, seed)).collect();
            queries.map(|query| {
                let inputs: Vec<Vec<f64>> = (0..query.declaration().inputs.len())
                    .map(|k| states.iter().flat_map(|s| s[k].clone()).collect())
                    .collect();
                let lengths: Vec<usize> = query.output_lengths(&model).collect();
                let mut expected: Vec<Vec<f64>> = lengths.iter().map(|length| vec![0.0; length * STATES]).collect();
                let mut workspace = mozzi::fast::Workspace::new(&model);
                for k in 0..STATES {
                    let given: Vec<&[f64]> = states[k].iter().take(inputs.len()).map(Vec::as_slice).collect();
                    let mut outputs: Vec<&mut [f64]> =
                        expected.iter_mut().zip(&lengths).map(|(all, n)| &mut all[k * n..(k + 1) * n]).collect();
                    mozzi::fast::evaluate(&query, &model, &given, &model.environment(), &mut workspace, &mut outputs);
                }
                (batch.clone(), query, inputs, lengths, expected)
            })
        })
        .collect();
    let count = AtomicUsize::new(0);
    let worst = |thread: u64| {
        let (mut seed, mut worst) = (0x9e37_79b9_7f4a_7c15 ^ thread << 32 | 1, 0.0_f64);
        for _ in 0..12_500 {
            let (batch, query, inputs, lengths, expected) = &jobs[next(&mut seed) % jobs.len()];
            let states = 1 + next(&mut seed) % 16;
            let start = next(&mut seed) % (STATES - states);
            let part = |all: &Vec<f64>, n: usize| all[start * n..(start + states) * n].to_vec();
            let given: Vec<Vec<f64>> = inputs.iter().map(|all| part(all, all.len() / STATES)).collect();
            let given: Vec<&[f64]> = given.iter().map(Vec::as_slice).collect();
            let mut found: Vec<Vec<f64>> = lengths.iter().map(|n| vec![f64::NAN; n * states]).collect();
            let mut outputs: Vec<&mut [f64]> = found.iter_mut().map(Vec::as_mut_slice).collect();
            let environment = batch.model().environment().into();
            batch.compute(*query, &given, &environment, &mut outputs).expect("lengths");
            for ((found, expected), &n) in found.iter().zip(expected).zip(lengths) {
                let expected = part(expected, n);
                let scale = expected.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
                let differences = found.iter().zip(&expected).map(|(a, b)| (a - b).abs() / scale);
                worst = differences.fold(worst, |most, x| if x <= most { most } else { x });
            }
            count.fetch_add(1, Ordering::Relaxed);
        }
        worst
    };
    let worst = std::thread::scope(|scope| {
        let threads: Vec<_> = (1..=8).map(|thread| scope.spawn(move || worst(thread))).collect();
        threads.into_iter().map(|thread| thread.join().expect("no panic")).fold(0.0, f64::max)
    });
    let engines = jobs.iter().filter(|(batch, query, ..)| is_code(batch.engine(*query))).count();
    println!(
        "{} calls, {engines} of {} by machine code, largest difference {worst:.1e} of the largest number",
        count.into_inner(),
        jobs.len()
    );
    assert!(worst < 1e-10 && (engines > 0) == has_code());
}
