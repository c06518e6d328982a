//! Each kernel alone, by criterion: one state an iteration, going round the states.
#![allow(missing_docs)] // criterion's main

use criterion::{BenchmarkGroup, Criterion, criterion_group, criterion_main, measurement::WallTime};
use mozzi::{Twist, Workspace, body_jacobian, fast, forward_kinematics, gravity_forces_derivative};
use mozzi_benches::{State, States, robots};
use std::hint::black_box;
use std::time::Duration;

/// One kernel.
fn bench<R>(group: &mut BenchmarkGroup<WallTime>, path: &str, states: &States, mut run: impl FnMut(State) -> R) {
    let states: Vec<_> = states.iter().collect();
    let mut round = states.iter().cycle();
    group.bench_function(path, |b| b.iter(|| round.next().map(|&state| run(black_box(state)))));
}

fn kernels(criterion: &mut Criterion) {
    for (name, model) in robots::all() {
        let (states, n, environment) = (States::new(&model), model.n(), model.environment());
        let frame = model.frames().last().expect("a frame").0;
        let (mut x, mut M, mut J) = (vec![0.0; n], vec![0.0; n * n], vec![Twist::zero(); n]);
        let mut matrices = [(); 3].map(|()| vec![0.0; n * n]);
        let mut group = |kernel: &str, run: &mut dyn FnMut(&mut BenchmarkGroup<WallTime>)| {
            let mut group = criterion.benchmark_group(format!("{name}/{kernel}"));
            group.warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(1));
            run(&mut group);
            group.finish();
        };
        let both = || {
            let workspaces = [fast::Workspace::new(&model), fast::Workspace::portable(&model)];
            workspaces.map(|workspace| (workspace.instruction_set(), workspace))
        };
        group("inverse_dynamics", &mut |group| {
            for (path, mut w) in both() {
                bench(group, path, &states, |[theta, dtheta, ddtheta, _]| {
                    fast::inverse_dynamics(&model, theta, dtheta, ddtheta, &environment, &mut w, black_box(&mut x));
                });
            }
        });
        group("forward_dynamics", &mut |group| {
            for (path, mut w) in both() {
                bench(group, path, &states, |[theta, dtheta, _, tau]| {
                    fast::forward_dynamics(&model, theta, dtheta, tau, &environment, &mut w, black_box(&mut x));
                });
            }
        });
        group("mass_matrix", &mut |group| {
            for (path, mut w) in both() {
                bench(group, path, &states, |[theta, ..]| {
                    fast::mass_matrix(&model, theta, &mut w, black_box(&mut M));
                });
            }
        });
        group("coriolis_matrix", &mut |group| {
            for (path, mut w) in both() {
                bench(group, path, &states, |[theta, dtheta, ..]| {
                    fast::coriolis_matrix(&model, theta, dtheta, &mut w, black_box(&mut M));
                });
            }
        });
        group("bias_forces", &mut |group| {
            for (path, mut w) in both() {
                bench(group, path, &states, |[theta, dtheta, ..]| {
                    fast::bias_forces(&model, theta, dtheta, &environment, &mut w, black_box(&mut x));
                });
            }
        });
        group("velocity_product", &mut |group| {
            for (path, mut w) in both() {
                bench(group, path, &states, |[theta, dtheta, ..]| {
                    fast::velocity_product(&model, theta, dtheta, &mut w, black_box(&mut x));
                });
            }
        });
        group("inverse_dynamics_derivatives", &mut |group| {
            for (path, mut w) in both() {
                bench(group, path, &states, |[theta, dtheta, ddtheta, _]| {
                    let by = black_box(matrices.each_mut().map(|matrix| &mut matrix[..]));
                    fast::inverse_dynamics_derivatives(&model, theta, dtheta, ddtheta, &environment, &mut w, by);
                });
            }
        });
        group("forward_dynamics_derivatives", &mut |group| {
            for (path, mut w) in both() {
                bench(group, path, &states, |[theta, dtheta, _, tau]| {
                    let (x, by) = black_box((&mut x[..], matrices.each_mut().map(|matrix| &mut matrix[..])));
                    fast::forward_dynamics_derivatives(&model, theta, dtheta, tau, &environment, &mut w, x, by);
                });
            }
        });
        group("gravity_forces_derivative", &mut |group| {
            let mut w = Workspace::new(&model);
            bench(group, "portable", &states, |[theta, ..]| {
                gravity_forces_derivative(&model, theta, environment.gravity, &mut w, black_box(&mut M));
            });
        });
        group("body_jacobian", &mut |group| {
            bench(group, "portable", &states, |[theta, ..]| body_jacobian(&model, theta, frame, black_box(&mut J)));
        });
        group("forward_kinematics", &mut |group| {
            bench(group, "portable", &states, |[theta, ..]| forward_kinematics(&model, theta, frame));
        });
        group("closed_form", &mut |group| {
            group.sample_size(20);
            bench(group, "dense", &states, |[theta, dtheta, ..]| model.closed_form(theta, dtheta, &environment));
        });
    }
}

criterion_group!(benches, kernels);
criterion_main!(benches);
