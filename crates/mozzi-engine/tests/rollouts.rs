//! Rollouts of many robots and their gradients are those of each robot alone.

use mozzi::random::Random;
use mozzi::{Base, Model, Vec3};
use mozzi_engine::{Batch, BatchGradient, BatchRollout, Error};
use mozzi_sim::Method;

const ROBOTS: usize = 70;
const STEPS: usize = 7;

/// Starts and torques of all robots.
fn start(model: &Model, random: &mut Random) -> [Vec<f64>; 3] {
    let theta = (0..ROBOTS).flat_map(|k| mozzi::random::state(model, k as u64)[0].clone()).collect();
    [theta, random.vector(ROBOTS * model.n(), 0.5), random.vector(ROBOTS * STEPS * model.n(), 2.0)]
}

fn robot(table: &[f64], k: usize) -> &[f64] {
    let width = table.len() / ROBOTS;
    &table[k * width..][..width]
}

/// The largest difference over the largest number.
fn apart(found: &[f64], expected: &[f64]) -> f64 {
    let size = expected.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
    found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / size
}

#[test]
fn rollouts_of_many_are_those_of_each() {
    let methods = [Method::RungeKutta4, Method::SemiImplicitEuler, Method::Euler, Method::Midpoint];
    let load = |name: &str| mozzi_urdf::open(name).unwrap().build().unwrap();
    let free = load("ur5").with_base(Base::Floating).unwrap();
    let robots = ["double_pendulum", "panda", "furuta_pendulum"].map(|name| (name, load(name)));
    for (name, model) in robots.into_iter().chain([("free ur5", free)]) {
        let (nq, n, p) = (model.nq(), model.n(), model.parameter_count());
        let mut random = Random(5);
        let [theta, dtheta, tau] = start(&model, &mut random);
        for method in methods {
            let gravity = (method == Method::Euler).then_some(Vec3([0.5, 0.0, -3.0]));
            let options =
                BatchRollout { method, gravity, checkpoints_every: Some(3), ..BatchRollout::new(1e-3, STEPS) };
            let batch = Batch::of(&model).with_threads(2).unwrap();
            let rows = STEPS + 1;
            let (mut thetas, mut dthetas) = (vec![0.0; ROBOTS * rows * nq], vec![0.0; ROBOTS * rows * n]);
            batch.rollout([&theta, &dtheta, &tau], &options, [&mut thetas, &mut dthetas]).unwrap();

            let [theta_bar, dtheta_bar] = [(); 2].map(|()| random.vector(ROBOTS * rows * n, 1.0));
            let [mut a, mut b, mut c, mut d] = [n, n, STEPS * n, p].map(|width| vec![0.0; ROBOTS * width]);
            let gradient = BatchGradient { theta: &mut a, dtheta: &mut b, tau: &mut c, parameters: &mut d };
            batch.rollout_vjp([&theta, &dtheta, &tau], &options, [&theta_bar, &dtheta_bar], gradient).unwrap();

            let mut one = options.of_one(&model).unwrap();
            for k in 0..ROBOTS {
                let [theta, dtheta, tau] = [&theta, &dtheta, &tau].map(|table| robot(table, k));
                let expected = one.states(theta, dtheta, tau).unwrap();
                let bars = [&theta_bar, &dtheta_bar].map(|table| robot(table, k));
                let gradient = one.vjp(theta, dtheta, tau, bars[0], bars[1]).unwrap();
                for (what, found, expected) in [
                    ("θ", robot(&thetas, k), &expected.theta),
                    ("θ̇", robot(&dthetas, k), &expected.dtheta),
                    ("∂θ", robot(&a, k), &gradient.theta),
                    ("∂θ̇", robot(&b, k), &gradient.dtheta),
                    ("∂τ", robot(&c, k), &gradient.tau),
                    ("∂π", robot(&d, k), &gradient.parameters),
                ] {
                    let gap = apart(found, expected);
                    assert!(gap < 1e-10, "{name}, {method:?}, robot {k}: {what} differs by {gap:e}");
                }
            }
        }
    }
}

#[test]
fn wrong_tables_and_lost_robots_are_named() {
    let model = mozzi_urdf::open("double_pendulum").unwrap().build().unwrap();
    let (n, rows) = (model.n(), STEPS + 1);
    let batch = Batch::of(&model);
    let options = BatchRollout::new(1e-3, STEPS);
    let [theta, mut dtheta, tau] = [2 * n, 2 * n, 2 * STEPS * n].map(|length| vec![0.1; length]);
    let mut tables = [vec![0.0; 2 * rows * n], vec![0.0; 2 * rows * n]];
    let mut run = |theta: &[f64], dtheta: &[f64], tau: &[f64], options: &BatchRollout| {
        let [a, b] = &mut tables;
        batch.rollout([theta, dtheta, tau], options, [a, b]).map_err(|error| error.to_string())
    };
    assert_eq!(run(&theta, &dtheta, &tau, &options), Ok(()));
    let said = run(&theta, &dtheta, &tau[1..], &options).unwrap_err();
    assert!(said.contains("tau has 27 numbers, expected 28"), "{said}");
    let said = run(&theta, &dtheta, &tau, &BatchRollout { step: 0.0, ..options }).unwrap_err();
    assert!(said.contains("step"), "{said}");
    dtheta[n] = 1e200; // of the second robot
    let error = batch
        .rollout([&theta, &dtheta, &tau], &options, [&mut vec![0.0; 2 * rows * n], &mut vec![0.0; 2 * rows * n]])
        .unwrap_err();
    assert!(matches!(error, Error::State { index: 1, .. }), "{error}");
}
