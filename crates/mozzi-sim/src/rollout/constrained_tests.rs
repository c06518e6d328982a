//! Gradients through steps that end on constraints, compared with slopes of a loss and with the rollout's own parts.

extern crate std;
use super::Rollout;
use super::tests::{Case, SMOOTH, case, dot};
use crate::Method;
use alloc::vec;
use alloc::vec::Vec;
use mozzi::model::Model;
use mozzi::model::description::Closure;
use mozzi::model::difference;
use mozzi::quantities::ConstraintResidual;
use mozzi::testing::{closed, floating_tree, four_bar, tree};

const N: usize = 4;
const H: f64 = 0.01;
const METHODS: [Method; 3] = [Method::Euler, Method::SemiImplicitEuler, Method::RungeKutta4];

/// Robots on their constraints at rest: loops, pinned links, redundant rows, a floating base.
fn cases() -> Vec<(Model, Case)> {
    let of = |model: Model, closures: &[Closure], seed: u64| {
        let at = case(&model, N, seed);
        let model = closed(&model, &at.theta, closures, seed);
        let dtheta = vec![0.0; model.n()];
        (model, Case { dtheta, ..at })
    };
    let bars = four_bar();
    let theta = bars.assemble(&[0.7, -0.6, 1.1], &["crank_pivot"]).expect("it closes");
    let at = Case { theta, dtheta: vec![0.0; 3], ..case(&bars, N, 3) };
    vec![
        (bars, at),
        of(tree(3, 6, 0), &[Closure::Point], 4),
        of(tree(5, 7, 2), &[Closure::Distance(0.5)], 5),
        of(floating_tree(2, 6, 0), &[Closure::Point, Closure::Hinge], 6),
    ]
}

fn rollout(model: &Model, method: Method) -> Rollout<'_> {
    let rollout = Rollout::new(model, H, method).and_then(|rollout| rollout.with_friction(SMOOTH));
    rollout.expect("explicit").with_parameter_gradient()
}

/// The loss of a case's cotangents, relative to given states.
fn loss(model: &Model, method: Method, case: &Case, here: &[Vec<f64>; 2]) -> f64 {
    let (n, nq) = (model.n(), model.nq());
    let there = rollout(model, method).states(&case.theta, &case.dtheta, &case.tau).expect("regular");
    let of_state = |k: usize| {
        let mut way = vec![0.0; n];
        difference(model, &here[0][k * nq..][..nq], &there.theta[k * nq..][..nq], &mut way);
        let rates: Vec<f64> = (0..n).map(|j| there.dtheta[k * n + j] - here[1][k * n + j]).collect();
        dot(&way, &case.bars[0][k * n..]) + dot(&rates, &case.bars[1][k * n..])
    };
    (0..=N).map(of_state).sum()
}

/// By differences of fourth order.
fn slope(loss: impl Fn(f64) -> f64) -> f64 {
    let e = 1e-4;
    (8.0 * (loss(e) - loss(-e)) - (loss(2.0 * e) - loss(-2.0 * e))) / (12.0 * e)
}

#[test]
fn gradients_are_slopes_of_the_loss() {
    for (model, at) in cases() {
        for method in METHODS {
            let gradient = at.vjp(&mut rollout(&model, method));
            let here = rollout(&model, method).states(&at.theta, &at.dtheta, &at.tau).expect("regular");
            let (here, along) = ([here.theta, here.dtheta], case(&model, N, 6));
            let moved =
                |x: &[f64], by: &[f64], e: f64| -> Vec<f64> { x.iter().zip(by).map(|(x, d)| x + e * d).collect() };
            let close = |found: f64, loss: &dyn Fn(f64) -> f64, what: &str| {
                let expected = slope(loss);
                let name = method.name();
                assert!((expected - found).abs() < 1e-7 * found.abs().max(1.0), "{what}, {name}: {expected} {found}");
            };
            let by_tau = |e: f64| {
                let tau = moved(&at.tau, &along.tau, e);
                loss(&model, method, &Case { tau, ..at.clone() }, &here)
            };
            close(dot(&gradient.tau, &along.tau), &by_tau, "by tau");
            let parameters = model.parameters();
            let rates: Vec<f64> = parameters.iter().enumerate().map(|(k, x)| 0.1 * (1 + k % 3) as f64 * x).collect();
            let by_parameters =
                |e: f64| loss(&model.with_parameters(&moved(&parameters, &rates, e)), method, &at, &here);
            close(dot(&gradient.parameters, &rates), &by_parameters, "by parameters");
        }
    }
}

/// A rollout's second half starts where its first half ends: the start's gradient of the one is the end's cotangent of
/// the other.
#[test]
fn the_starts_gradient_continues_through_an_earlier_rollout() {
    for (model, at) in cases() {
        let (n, nq, half) = (model.n(), model.nq(), N / 2);
        let mut rollout = rollout(&model, Method::RungeKutta4);
        let whole = at.vjp(&mut rollout);
        let states = rollout.states(&at.theta, &at.dtheta, &at.tau).expect("regular");
        for (k, state) in states.theta.chunks_exact(nq).enumerate() {
            let phi = model.compute(ConstraintResidual, &[state], &model.environment()).expect("lengths");
            assert!(phi[0].iter().all(|x| x.abs() < 1e-12), "state {k} is open: {phi:?}");
        }
        let part = |x: &[f64], from: usize| x[from * n..].to_vec();
        let later = Case {
            theta: states.theta[half * nq..][..nq].to_vec(),
            dtheta: states.dtheta[half * n..][..n].to_vec(),
            tau: part(&at.tau, half),
            bars: at.bars.each_ref().map(|bars| part(bars, half)),
        };
        let later = later.vjp(&mut rollout);
        let mut bars = at.bars.each_ref().map(|bars| bars[..(half + 1) * n].to_vec());
        bars[0][half * n..].copy_from_slice(&later.theta);
        bars[1][half * n..].copy_from_slice(&later.dtheta);
        let earlier = Case { tau: at.tau[..half * n].to_vec(), bars, ..at.clone() }.vjp(&mut rollout);
        let size = whole.tau.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
        for (found, expected) in earlier.tau.iter().chain(&later.tau).zip(&whole.tau) {
            assert!((found - expected).abs() < 1e-12 * size, "{found} {expected}");
        }
    }
}
