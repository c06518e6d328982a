//! The midpoint rule's equations and gradients, compared with the step itself and with the slopes of a loss.

extern crate std;
use super::Rollout;
use super::midpoint::equations;
use super::tests::{Case, SMOOTH, case, dot, models};
use crate::tests::robots::double_pendulum;
use crate::{Method, Options};
use alloc::vec;
use alloc::vec::Vec;
use mozzi::Workspace;
use mozzi::model::Model;
use mozzi::model::{difference, integrate};

const N: usize = 5;
const H: f64 = 0.01;

fn rollout(model: &Model) -> Rollout<'_> {
    let rollout = Rollout::new(model, H, Method::Midpoint).and_then(|rollout| rollout.with_friction(SMOOTH));
    rollout.expect("a fixed step").with_parameter_gradient()
}

/// The step of the simulation solves the equations that are differentiated: v from θ' ⊖ θ, which costs digits by 1/h.
#[test]
fn a_step_solves_its_equations() {
    for (seed, model) in models().iter().enumerate() {
        let Case { theta, dtheta, tau, .. } = case(model, 1, seed as u64);
        let found = rollout(model).states(&theta, &dtheta, &tau).expect("regular");
        let (nq, n) = (model.nq(), model.n());
        let mut v = vec![0.0; n];
        difference(model, &theta, &found.theta[nq..], &mut v);
        v.iter_mut().for_each(|v| *v /= H);
        let options = Options { friction: SMOOTH, ..Options::new(H, 1) };
        let step = [&dtheta[..], &v, &found.dtheta[n..], &tau];
        let gap = equations(model, &theta, step, (H, &options), &mut Workspace::new(model));
        let size = model.mass_matrix(&theta).expect("lengths").iter().fold(1.0_f64, |m, x| m.max(x.abs()));
        assert!(gap.iter().all(|x| x.abs() < 1e-12 * size), "{gap:?}");
    }
}

/// The loss of a case's cotangents, relative to given states, for a moved start, moved torques, another robot.
fn loss(model: &Model, case: &Case, here: &[Vec<f64>; 2]) -> f64 {
    let n = model.n();
    let there = rollout(model).states(&case.theta, &case.dtheta, &case.tau).expect("regular");
    (0..=N)
        .map(|k| {
            let (nq, mut way) = (model.nq(), vec![0.0; n]);
            difference(model, &here[0][k * nq..][..nq], &there.theta[k * nq..][..nq], &mut way);
            let rates: Vec<f64> = (0..n).map(|j| there.dtheta[k * n + j] - here[1][k * n + j]).collect();
            dot(&way, &case.bars[0][k * n..]) + dot(&rates, &case.bars[1][k * n..])
        })
        .sum()
}

/// By differences of fourth order: 8 (L(e) − L(−e)) − (L(2e) − L(−2e)) over 12e.
fn slope(mut loss: impl FnMut(f64) -> f64) -> f64 {
    let e = 1e-4;
    (8.0 * (loss(e) - loss(-e)) - (loss(2.0 * e) - loss(-2.0 * e))) / (12.0 * e)
}

#[test]
fn gradients_are_slopes_of_the_loss() {
    for model in models() {
        let at = case(&model, N, 5);
        let gradient = at.vjp(&mut rollout(&model));
        let here = rollout(&model).states(&at.theta, &at.dtheta, &at.tau).expect("regular");
        let (here, along) = ([here.theta, here.dtheta], case(&model, N, 6));
        let moved = |x: &[f64], by: &[f64], e: f64| -> Vec<f64> { x.iter().zip(by).map(|(x, d)| x + e * d).collect() };
        let close = |found: f64, loss: &dyn Fn(f64) -> f64, what: &str| {
            let expected = slope(loss);
            assert!((expected - found).abs() < 1e-7 * found.abs().max(1.0), "{what}: {expected} {found}");
        };
        let by_theta = |e: f64| {
            let mut theta = at.theta.clone();
            integrate(&model, &mut theta, &along.dtheta, e);
            loss(&model, &Case { theta, ..at.clone() }, &here)
        };
        close(dot(&along.dtheta, &gradient.theta), &by_theta, "by theta");
        let by_dtheta = |e: f64| {
            let dtheta = moved(&at.dtheta, &along.bars[0], e);
            loss(&model, &Case { dtheta, ..at.clone() }, &here)
        };
        close(dot(&gradient.dtheta, &along.bars[0]), &by_dtheta, "by dtheta");
        let by_tau = |e: f64| loss(&model, &Case { tau: moved(&at.tau, &along.tau, e), ..at.clone() }, &here);
        close(dot(&gradient.tau, &along.tau), &by_tau, "by tau");
        // by parameters in proportion, so that inertias stay physical
        let parameters = model.parameters();
        let rates: Vec<f64> = parameters.iter().enumerate().map(|(k, x)| 0.1 * (1 + k % 3) as f64 * x).collect();
        let by_parameters = |e: f64| loss(&model.with_parameters(&moved(&parameters, &rates, e)), &at, &here);
        close(dot(&gradient.parameters, &rates), &by_parameters, "by parameters");
    }
}

#[test]
fn checkpoints_change_rounding_alone() {
    for model in models() {
        let at = case(&model, N, 3);
        let whole = at.vjp(&mut rollout(&model));
        let parts = at.vjp(&mut rollout(&model).with_checkpoints_every(2).expect("above 0"));
        let near = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9 * b.abs().max(1.0));
        assert!(near(&parts.theta, &whole.theta) && near(&parts.tau, &whole.tau));
        assert!(near(&parts.dtheta, &whole.dtheta) && near(&parts.parameters, &whole.parameters));
    }
}

/// At this speed the whole step's iteration does not converge.
#[test]
fn gradients_pass_through_steps_that_were_halved() {
    let (model, h) = (double_pendulum(), 0.1);
    let (theta, tau, zeros) = ([1.0, 0.5], [0.0; 4], [0.0; 6]);
    let mut rollout = Rollout::new(&model, h, Method::Midpoint).expect("a fixed step");
    let mut end = |speed: f64| rollout.states(&theta, &[speed, -10.0], &tau).expect("regular").dtheta[4];
    let expected = slope(|e| end(10.0 + e));
    let mut rollout = Rollout::new(&model, h, Method::Midpoint).expect("a fixed step");
    let found = rollout.vjp(&theta, &[10.0, -10.0], &tau, &zeros, &[0.0, 0.0, 0.0, 0.0, 1.0, 0.0]).expect("regular");
    assert!((found.dtheta[0] - expected).abs() < 1e-6 * expected.abs().max(1.0), "{} {expected}", found.dtheta[0]);
}
