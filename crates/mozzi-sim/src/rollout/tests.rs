//! Gradients through rollouts, compared with products of the steps' matrices, by dual numbers.

extern crate std;
use super::{Rollout, RolloutGradient};
use crate::Error;
use crate::{Friction, Method, Options, torque};
use crate::{sensitivities, simulate};
use alloc::vec;
use alloc::vec::Vec;
use mozzi::model::{Model, Variation};
use mozzi::model::{difference, integrate};
use mozzi::testing::{Random, floating_mixed_tree, floating_tree, four_bar, mixed_tree, state, tree};
use nalgebra::{DMatrix, DVector};

const METHODS: [Method; 3] = [Method::Euler, Method::SemiImplicitEuler, Method::RungeKutta4];
pub const SMOOTH: Friction = Friction::Smooth { slip_speed: 0.5 };

/// Chains, branches, mimic joints, floating bases, balls and free joints.
pub fn models() -> Vec<Model> {
    vec![
        tree(3, 6, 0),
        tree(5, 7, 2),
        floating_tree(2, 5, 0),
        floating_tree(6, 6, 1),
        mixed_tree(4, 5, 0),
        mixed_tree(9, 6, 0),
        floating_mixed_tree(7, 5, 0),
    ]
}

/// A start, torques and cotangents of N steps.
#[derive(Clone)]
pub struct Case {
    pub theta: Vec<f64>,
    pub dtheta: Vec<f64>,
    pub tau: Vec<f64>,
    pub bars: [Vec<f64>; 2],
}

pub fn case(model: &Model, N: usize, seed: u64) -> Case {
    let [theta, dtheta, _] = state(model, seed);
    let (n, mut random) = (model.n(), Random(seed + 17));
    let mut table = |rows| random.vector(rows * n, 1.0);
    Case { theta, dtheta, tau: table(N), bars: [table(N + 1), table(N + 1)] }
}

impl Case {
    pub fn vjp(&self, rollout: &mut Rollout<'_>) -> RolloutGradient {
        rollout.vjp(&self.theta, &self.dtheta, &self.tau, &self.bars[0], &self.bars[1]).expect("regular")
    }
}

/// The products of matrices, and the same with absolute values: the size of the terms.
struct Expected {
    start: DVector<f64>,
    tau: Vec<DVector<f64>>,
    parameters: DVector<f64>,
}

fn expected(model: &Model, case: &Case, options: &Options, absolute: bool) -> Expected {
    let (n, N, p) = (model.n(), options.steps, model.parameter_count());
    let rows: Vec<&[f64]> = case.tau.chunks_exact(n).collect();
    let units: Vec<Vec<f64>> = (0..p).map(|i| (0..p).map(|k| f64::from(u8::from(i == k))).collect()).collect();
    let changes: Vec<Variation<'_>> = units.iter().map(|e| Variation::Parameters(e)).collect();
    let steps = sensitivities(model, &case.theta, &case.dtheta, &rows, options, &changes).expect("regular");
    let size = |A: &DMatrix<f64>| if absolute { A.abs() } else { A.clone() };
    let bar = |k: usize| {
        let rows = case.bars.iter().flat_map(|table| table[k * n..][..n].iter().copied());
        let bar = DVector::from_iterator(2 * n, rows);
        if absolute { bar.abs() } else { bar }
    };
    let (mut x, mut parameters, mut tau) = (bar(N), DVector::zeros(p), Vec::new());
    for (k, step) in steps.iter().enumerate().rev() {
        tau.push(size(&step.B).transpose() * &x);
        parameters += size(&step.P).transpose() * &x;
        x = size(&step.A).transpose() * x + bar(k);
    }
    tau.reverse();
    Expected { start: x, tau, parameters }
}

/// The largest error over ε times the largest sum of absolute values of the products A\[k\]ᵀ … x̄.
fn units(found: &[f64], expected: &DVector<f64>, size: &DVector<f64>) -> f64 {
    assert_eq!(found.len(), expected.len());
    let error = found.iter().zip(expected.iter()).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
    error / (f64::EPSILON * size.amax())
}

#[test]
fn gradients_are_those_of_dual_numbers_to_rounding() {
    let (mut worst, mut places) = ([0.0_f64; 4], 0);
    for (seed, model) in models().iter().enumerate() {
        for (method, friction, h, N) in METHODS.iter().flat_map(|&method| {
            [(method, Friction::Coulomb, 0.01, 8), (method, SMOOTH, 0.01, 5), (method, SMOOTH, 0.15, 2)]
        }) {
            let case = case(model, N, seed as u64);
            let options = Options { method, friction, ..Options::new(h * N as f64, N) };
            let rollout = Rollout::new(model, h, method).and_then(|rollout| rollout.with_friction(friction));
            let found = case.vjp(&mut rollout.expect("explicit").with_parameter_gradient());
            let [exact, size] = [false, true].map(|absolute| expected(model, &case, &options, absolute));
            let start = [&found.theta[..], &found.dtheta].concat();
            let mut of_tau = 0.0_f64;
            for (k, row) in found.tau.chunks_exact(model.n()).enumerate() {
                of_tau = of_tau.max(units(row, &exact.tau[k], &size.tau[k]));
            }
            let of_start = units(&start, &exact.start, &size.start);
            let of_parameters = units(&found.parameters, &exact.parameters, &size.parameters);
            for (worst, new) in worst.iter_mut().zip([of_start, of_tau, of_parameters]) {
                *worst = worst.max(new);
            }
            let name = (method.name(), h, seed);
            assert!(
                of_start < 1e3 && of_tau < 1e3 && of_parameters < 1e3,
                "{name:?}: {of_start} {of_tau} {of_parameters}"
            );
            places += 1;
        }
    }
    std::println!("{places} rollouts; units of ε by start, torques, parameters: {worst:.1?}");
}

#[test]
fn states_are_those_of_a_simulation() {
    for model in models() {
        for method in METHODS.into_iter().chain([Method::Midpoint]) {
            let (N, h) = (7, 0.01);
            let case = Case { tau: vec![0.3; 7 * model.n()], ..case(&model, N, 3) };
            let states =
                Rollout::new(&model, h, method).expect("explicit").states(&case.theta, &case.dtheta, &case.tau);
            let states = states.expect("regular");
            let held = torque(|_, _, _, tau: &mut [f64]| tau.fill(0.3));
            let options =
                Options { method, friction: Friction::Smooth { slip_speed: 1e-300 }, ..Options::new(h * N as f64, N) };
            let motion = simulate(&model, &case.theta, &case.dtheta, held, &options).expect("a motion");
            let error = |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
            // h N / N is not h to the bit
            assert!(error(&states.theta, &motion.theta) < 1e-12 && error(&states.dtheta, &motion.dtheta) < 1e-12);
        }
    }
}

#[test]
fn checkpoints_change_no_bit() {
    for model in [tree(5, 7, 2), floating_mixed_tree(7, 5, 0)] {
        for method in METHODS {
            let N = 11;
            let case = case(&model, N, 2);
            let rollout = || Rollout::new(&model, 0.01, method).expect("explicit").with_parameter_gradient();
            let whole = case.vjp(&mut rollout());
            for every in [1, 2, 3, 4, 11, 100] {
                let mut parts = rollout().with_checkpoints_every(every).expect("above 0");
                assert_eq!(case.vjp(&mut parts), whole, "{every}");
                assert_eq!(case.vjp(&mut parts), whole, "{every}, again");
            }
            let (mut rollout, n) = (rollout(), model.n());
            let states = rollout.states(&case.theta, &case.dtheta, &case.tau).expect("regular");
            let by_states = rollout.gradient_of_states(&states, &case.tau, |k, theta, dtheta, to_theta, to_dtheta| {
                assert_eq!(theta, &states.theta[k * theta.len()..][..theta.len()]);
                assert_eq!(dtheta, &states.dtheta[k * n..][..n]);
                super::add(to_theta, &case.bars[0][k * n..]);
                super::add(to_dtheta, &case.bars[1][k * n..]);
            });
            assert_eq!(by_states.expect("regular"), whole);
        }
    }
}

/// A coarse check without any derivative of the library: the loss, moved along random directions.
#[test]
fn gradients_are_slopes_of_the_loss() {
    for model in models() {
        let (N, n, e) = (20, model.n(), 1e-6);
        let at = case(&model, N, 5);
        let mut rollout = Rollout::new(&model, 0.01, Method::RungeKutta4).expect("explicit");
        rollout = rollout.with_friction(SMOOTH).expect("positive");
        let gradient = at.vjp(&mut rollout);
        let here = rollout.states(&at.theta, &at.dtheta, &at.tau).expect("regular");
        let along = case(&model, N, 6);
        let mut loss = |e: f64| {
            let moved = |x: &[f64], by: &[f64]| -> Vec<f64> { x.iter().zip(by).map(|(x, d)| x + e * d).collect() };
            let mut theta = at.theta.clone();
            integrate(&model, &mut theta, &along.dtheta, e);
            let there = rollout.states(&theta, &moved(&at.dtheta, &along.bars[0]), &moved(&at.tau, &along.tau));
            let there = there.expect("regular");
            let mut sum = 0.0;
            for k in 0..=N {
                let mut way = vec![0.0; n];
                let row = |x: &'_ [f64]| k * (x.len() / (N + 1))..(k + 1) * (x.len() / (N + 1));
                let rows = row(&here.theta);
                difference(&model, &here.theta[rows.clone()], &there.theta[rows], &mut way);
                sum += dot(&way, &at.bars[0][k * n..]) + dot(&there.dtheta[k * n..][..n], &at.bars[1][k * n..]);
            }
            sum
        };
        let slope = (loss(e) - loss(-e)) / (2.0 * e);
        let found = dot(&along.dtheta, &gradient.theta)
            + dot(&gradient.dtheta, &along.bars[0])
            + dot(&gradient.tau, &along.tau);
        assert!((slope - found).abs() < 1e-5 * found.abs().max(1.0), "{slope} {found}");
    }
}

pub fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

#[test]
fn invalid_rollouts_are_refused() {
    let model = tree(1, 4, 0);
    let n = model.n();
    let refused = |h, method| Rollout::new(&model, h, method).err().expect("refused").to_string();
    for h in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(refused(h, Method::Euler).contains("the step"), "{h}");
    }
    assert!(refused(0.1, Method::DormandPrince { tolerance: 1e-9 }).contains("the method"));
    let closed = four_bar();
    let error = Rollout::new(&closed, 0.1, Method::Midpoint).err().expect("refused").to_string();
    assert!(error.contains("the method"), "{error}");
    let mut open = Rollout::new(&closed, 0.1, Method::Euler).expect("explicit");
    let error = open.states(&vec![0.3; closed.n()], &vec![0.0; closed.n()], &vec![0.0; closed.n()]);
    assert!(matches!(error, Err(Error::OpenStart { .. })));

    let mut rollout = Rollout::new(&model, 0.1, Method::Euler).expect("explicit");
    let (theta, still, tau) = (vec![0.0; model.nq()], vec![0.0; n], vec![0.0; 3 * n]);
    assert!(matches!(
        rollout.states(&theta[1..], &still, &tau),
        Err(Error::Model(mozzi::Error::WrongLength { what: "theta", .. }))
    ));
    assert!(matches!(
        rollout.states(&theta, &still, &tau[1..]),
        Err(Error::Model(mozzi::Error::BadArgument { what: "tau", .. }))
    ));
    assert!(matches!(
        rollout.states(&vec![f64::NAN; theta.len()], &still, &tau),
        Err(Error::Model(mozzi::Error::BadArgument { .. }))
    ));
    let short = vec![0.0; 3 * n];
    assert!(matches!(
        rollout.vjp(&theta, &still, &tau, &short, &short),
        Err(Error::Model(mozzi::Error::WrongLength { what: "theta_bar", .. }))
    ));
    let error = rollout.states(&theta, &still, &vec![1e300; 3 * n]).expect_err("too large");
    assert!(matches!(error, Error::Diverged { .. }), "{error:?}");
    // no steps: the gradient is the loss's own
    let found = rollout.vjp(&theta, &still, &[], &vec![1.0; n], &vec![2.0; n]).expect("fine");
    assert_eq!((found.theta, found.dtheta, found.tau), (vec![1.0; n], vec![2.0; n], vec![]));
    assert!(rollout.with_checkpoints_every(0).is_err());
}
