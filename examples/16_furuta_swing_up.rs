//! Swing-up of the Furuta pendulum by iLQR: one motor, at the arm; the rod hangs at the start and points up at the end.
//!
//! The iterative linear-quadratic regulator (Li and Todorov 2004) takes a motion x[k], u[k] and the derivatives A =
//! ∂x[k+1]/∂x[k] and B = ∂x[k+1]/∂u[k] along it, here exact derivatives of the Runge-Kutta steps. With v and V the
//! slope and curvature of the cost-to-go, and the cost ½ Σ xᵀWx + ½ Σ R u²,
//!
//! > Q_u = Ru + Bᵀv, Q_uu = R + BᵀVB, Q_ux = BᵀVA, δu = −Q_uu⁻¹ (Q_u + Q_ux δx)
//!
//! is computed backwards in time, then applied forwards, with a step size that is reduced until the cost falls.

use mozzi::Model;
use mozzi::nalgebra::{Matrix4, RowVector4, Vector4};
use mozzi_sim::{Error, Options, held_step, step_sensitivity};
use std::f64::consts::PI;

const STEPS: usize = 200;
const SECONDS: f64 = 4.0;
/// The weight of torque, in the cost and added to Q_uu so that δu stays small.
const R: f64 = 1e-3;

/// x[0] … x[N], with x = (θ, θ̇) and x = 0 at the top, and u[0] … u[N−1].
struct Motion {
    x: Vec<Vector4<f64>>,
    u: Vec<f64>,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let pendulum = mozzi_urdf::open("furuta_pendulum")?.description.build()?;
    let mut motion = follow(&pendulum, |k, _| 2.0 * (0.2 * k as f64).sin())?;
    let start = cost(&motion);
    for iteration in 0.. {
        let policy = improve(&pendulum, &motion)?;
        let before = cost(&motion);
        if iteration % 10 == 0 {
            println!("iteration {iteration:2}: cost {before:12.4}, the rod {:7.3}° off the top", angle(&motion));
        }
        let part = |part: f64| {
            let Motion { x, u } = &motion;
            follow(&pendulum, |k, now| u[k] + part * policy[k].0 + (policy[k].1 * (now - x[k]))[0]).ok()
        };
        let parts = [1.0, 0.5, 0.25, 0.1, 0.03, 0.01, 0.001];
        let Some(better) = parts.into_iter().filter_map(part).find(|next| cost(next) < before) else { break };
        motion = better;
        if cost(&motion) > (1.0 - 1e-6) * before || iteration == 500 {
            break;
        }
    }
    let (end, torque) = (motion.x[STEPS], motion.u.iter().fold(0.0_f64, |m, u| m.max(u.abs())));
    println!("cost {:.4}; at the end x = {:.4?}; at most {torque:.1} N m", cost(&motion), end.as_slice());
    assert!(cost(&motion) < 1e-2 * start && end.amax() < 5e-3, "it stands, at rest, the arm where it was");
    Ok(())
}

fn angle(motion: &Motion) -> f64 {
    motion.x[STEPS][1].to_degrees()
}

/// W: very small along the way, large at the end.
fn weights(k: usize) -> Matrix4<f64> {
    Matrix4::from_diagonal(&if k < STEPS { [1e-3, 0.0, 1e-3, 1e-3] } else { [1e5, 1e6, 1e4, 1e5] }.into())
}

fn cost(Motion { x, u }: &Motion) -> f64 {
    let of_states: f64 = x.iter().enumerate().map(|(k, x)| x.dot(&(weights(k) * x))).sum();
    0.5 * (of_states + R * u.iter().map(|u| u * u).sum::<f64>())
}

/// The motion from rest, hanging, under a torque u(k, x[k]).
fn follow(pendulum: &Model, torque: impl Fn(usize, &Vector4<f64>) -> f64) -> Result<Motion, Error> {
    let (mut x, mut u) = (vec![Vector4::new(0.0, PI, 0.0, 0.0)], Vec::new());
    for k in 0..STEPS {
        u.push(torque(k, &x[k]));
        let (theta, dtheta) = x[k].as_slice().split_at(2);
        let (theta, dtheta) = held_step(pendulum, theta, dtheta, &[u[k], 0.0], &Options::new(SECONDS, STEPS))?;
        x.push(Vector4::from_iterator(theta.into_iter().chain(dtheta)));
    }
    Ok(Motion { x, u })
}

/// The change δu of each step, and its feedback gain on δx.
fn improve(pendulum: &Model, Motion { x, u }: &Motion) -> Result<Vec<(f64, RowVector4<f64>)>, Error> {
    let (mut V, mut v, mut policy) = (weights(STEPS), weights(STEPS) * x[STEPS], Vec::new());
    for k in (0..STEPS).rev() {
        let (theta, dtheta) = x[k].as_slice().split_at(2);
        let step = step_sensitivity(pendulum, theta, dtheta, &[u[k], 0.0], &Options::new(SECONDS, STEPS), &[])?;
        let (A, B) = (Matrix4::from_column_slice(step.A.as_slice()), step.B.fixed_columns::<1>(0).into_owned());
        let B = Vector4::from_column_slice(B.as_slice());
        let (Q_u, Q_uu, Q_ux) = (R * u[k] + B.dot(&v), R + B.dot(&(V * B)), B.transpose() * V * A);
        let (open, feedback) = (-Q_u / (Q_uu + R), -Q_ux / (Q_uu + R));
        v = weights(k) * x[k]
            + A.transpose() * v
            + feedback.transpose() * (Q_uu * open + Q_u)
            + Q_ux.transpose() * open;
        let cross = feedback.transpose() * Q_ux;
        V = weights(k) + A.transpose() * V * A + feedback.transpose() * Q_uu * feedback + cross + cross.transpose();
        policy.push((open, feedback));
    }
    policy.reverse();
    Ok(policy)
}
