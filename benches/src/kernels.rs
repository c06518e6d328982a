//! Each kernel alone, by criterion: one state for each iteration, cycling through the states.
#![allow(missing_docs)] // criterion's main

use criterion::{BenchmarkGroup, Criterion, criterion_group, criterion_main, measurement::WallTime};
use mozzi::fast::{self, Workspace};
use mozzi::quantities::Query;
use mozzi_benches::{QUANTITIES, States, inputs, robots};
use std::hint::black_box;
use std::time::Duration;

/// In addition to the quantities of the tables.
const FURTHER: [&str; 4] = ["velocity_product", "gravity_forces_derivative", "body_jacobian", "forward_kinematics"];

fn kernels(criterion: &mut Criterion) {
    for (name, model) in robots::all() {
        let (states, environment) = (States::new(&model), model.environment());
        let frame = model.frames().last().expect("a frame").0;
        for kernel in QUANTITIES.into_iter().chain(FURTHER) {
            let query = Query::named(kernel).expect("one of mozzi's").of(frame);
            let mut outputs: Vec<Vec<f64>> = query.output_lengths(&model).map(|length| vec![0.0; length]).collect();
            let mut outputs: Vec<&mut [f64]> = outputs.iter_mut().map(Vec::as_mut_slice).collect();
            let inputs: Vec<Vec<&[f64]>> = states.iter().map(|state| inputs(query, state)).collect();
            let mut group = group(criterion, name, kernel);
            let ways = [("fused", Workspace::new(&model)), ("portable", Workspace::portable(&model))];
            for (way, mut workspace) in ways {
                bench(&mut group, way, &inputs, |inputs| {
                    let outputs = black_box(&mut outputs);
                    fast::evaluate(&query, &model, inputs, &environment, &mut workspace, outputs);
                });
            }
            group.finish();
        }
        let mut group = group(criterion, name, "closed_form");
        group.sample_size(20);
        let states: Vec<_> = states.iter().collect();
        bench(&mut group, "dense", &states, |[theta, dtheta, ..]| model.closed_form(theta, dtheta, &environment));
        group.finish();
    }
}

fn group<'c>(criterion: &'c mut Criterion, robot: &str, kernel: &str) -> BenchmarkGroup<'c, WallTime> {
    let mut group = criterion.benchmark_group(format!("{robot}/{kernel}"));
    group.warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(1));
    group
}

/// One kernel at one state after the other.
fn bench<S, R>(group: &mut BenchmarkGroup<WallTime>, path: &str, states: &[S], mut run: impl FnMut(&S) -> R) {
    let mut round = states.iter().cycle();
    group.bench_function(path, |b| b.iter(|| round.next().map(|state| run(black_box(state)))));
}

criterion_group!(benches, kernels);
criterion_main!(benches);
