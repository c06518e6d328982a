//! Reaching by gradients: the torques of each of 100 Runge-Kutta steps that bring the Panda's hand to a point, at rest.
//!
//! The loss of a rollout x[k+1] = Φ(x[k], τ[k]) is
//!
//! > L = ½ w ‖p(θ[N]) − p*‖² + ½ w_v ‖θ̇[N]‖² + ½ r h Σ ‖x[k]‖²,  τ[k] = g + D x[k]
//!
//! with g the torques that hold the start and D the diagonal of M there: x is about an acceleration, so that a step
//! moves a wrist of 0.001 kg m² no further than a shoulder of 1 kg m². `Rollout::gradient` takes ∂L/∂x[N] back through
//! the steps, x̄[k] = (∂Φ/∂x)ᵀx̄[k+1], and returns (∂Φ/∂τ)ᵀx̄[k+1] of each step: exact for the discrete steps, as a
//! difference of losses shows. L-BFGS (Nocedal 1980) descends along it. At the end: what a gradient costs, compared
//! with its rollout.

use mozzi::{FrameId, Model};
use mozzi_sim::{Error, Method, Rollout};
use std::collections::VecDeque;
use std::time::Instant;

const STEPS: usize = 100;
const STEP: f64 = 0.01;
const GOAL: [f64; 3] = [0.4, 0.3, 0.5];
const START: [f64; 7] = [0.0, -0.3, 0.0, -2.2, 0.0, 2.0, 0.8];
const WEIGHTS: [f64; 3] = [100.0, 1.0, 1e-3];

struct Task<'m> {
    model: &'m Model,
    hand: FrameId,
    rollout: Rollout<'m>,
    hold: Vec<f64>,
    inertia: Vec<f64>,
}

impl Task<'_> {
    /// τ[k] = g + D x[k].
    fn torques(&self, x: &[f64]) -> Vec<f64> {
        let n = self.hold.len();
        x.iter().enumerate().map(|(k, x)| self.hold[k % n] + self.inertia[k % n] * x).collect()
    }

    /// L and ∂L/∂x; an infinite loss where the motion diverges.
    fn loss(&mut self, x: &[f64]) -> Result<(f64, Vec<f64>), Error> {
        let [w, w_v, r] = WEIGHTS;
        let tau = self.torques(x);
        let (model, hand, n) = (self.model, self.hand, self.model.n());
        let (mut loss, mut failed) = (0.0, None);
        let mut at_end = |theta: &[f64], dtheta: &[f64], theta_bar: &mut [f64], dtheta_bar: &mut [f64]| {
            let (T, J_b) = (model.forward_kinematics(theta, hand)?, model.body_jacobian(theta, hand)?);
            let off = T.p - mozzi::Vec3(GOAL);
            for j in 0..n {
                theta_bar[j] += w * (T.R * J_b.0[j].v).dot(off); // ṗ = R v_b
                dtheta_bar[j] += w_v * dtheta[j];
            }
            loss = 0.5 * w * off.dot(off) + 0.5 * w_v * dtheta.iter().map(|v| v * v).sum::<f64>();
            Ok::<_, Error>(())
        };
        let found = self.rollout.gradient(&START, &vec![0.0; n], &tau, |k, theta, dtheta, theta_bar, dtheta_bar| {
            if k == STEPS {
                failed = at_end(theta, dtheta, theta_bar, dtheta_bar).err();
            }
        });
        if let Some(error) = failed {
            return Err(error);
        }
        let mut gradient = match found {
            Ok(found) => found.tau,
            Err(Error::Diverged { .. }) => return Ok((f64::INFINITY, vec![0.0; x.len()])),
            Err(error) => return Err(error),
        };
        for (k, slope) in gradient.iter_mut().enumerate() {
            *slope = self.inertia[k % n] * *slope + r * STEP * x[k]; // ∂L/∂x = D ∂L/∂τ + r h x
            loss += 0.5 * r * STEP * x[k] * x[k];
        }
        Ok((loss, gradient))
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let model = damped(mozzi_urdf::open("panda")?.build()?.with_locked_joints(&[("panda_finger_joint1", 0.03)])?)?;
    let (n, hand) = (model.n(), model.frame("panda_hand")?);
    let hold = model.gravity_forces(&START)?.as_slice().to_vec();
    let rollout = Rollout::new(&model, STEP, Method::RungeKutta4)?;
    let M = model.mass_matrix(&START)?;
    let inertia = (0..n).map(|j| M[(j, j)]).collect();
    let mut task = Task { model: &model, hand, rollout, hold, inertia };

    let mut x = vec![0.0; STEPS * n];
    let (mut loss, mut gradient) = task.loss(&x)?;
    check_slope(&mut task, &x, &gradient)?;
    println!("\niteration        loss    slope");
    let mut memory = VecDeque::new();
    for iteration in 0..200 {
        if iteration % 10 == 0 {
            println!("{iteration:9}  {loss:10.3e}  {:7.1e}", dot(&gradient, &gradient).sqrt());
        }
        let way = descent(&memory, &gradient);
        let slope = dot(&way, &gradient);
        let mut size = if memory.is_empty() { 0.1 / dot(&way, &way).sqrt() } else { 1.0 };
        let (next, next_loss, next_gradient) = loop {
            let next: Vec<f64> = x.iter().zip(&way).map(|(x, d)| x + size * d).collect();
            let (next_loss, next_gradient) = task.loss(&next)?;
            if next_loss <= loss + 1e-4 * size * slope || size < 1e-10 {
                break (next, next_loss, next_gradient);
            }
            size *= 0.5;
        };
        let s: Vec<f64> = next.iter().zip(&x).map(|(a, b)| a - b).collect();
        let y: Vec<f64> = next_gradient.iter().zip(&gradient).map(|(a, b)| a - b).collect();
        if dot(&s, &y) > 0.0 {
            memory.push_front((s, y));
            memory.truncate(10);
        }
        (x, loss, gradient) = (next, next_loss, next_gradient);
        if dot(&gradient, &gradient).sqrt() < 1e-6 {
            break;
        }
    }

    let end = task.rollout.states(&START, &vec![0.0; n], &task.torques(&x))?;
    let theta = &end.theta[STEPS * n..];
    let off = (model.forward_kinematics(theta, hand)?.p - mozzi::Vec3(GOAL)).norm();
    let speed = dot(&end.dtheta[STEPS * n..], &end.dtheta[STEPS * n..]).sqrt();
    println!("\nthe hand ends {:.2} mm from the goal, at {speed:.4} rad/s", 1e3 * off);
    assert!(off < 2e-3 && speed < 0.05, "{off} {speed}");
    cost(&model)
}

/// A copy of the robot with damping M_jj/0.2 s at each joint j. Without damping the wrist is an inverted pendulum whose
/// deviation grows a thousandfold in a second; a loss of torques alone is then not a smooth function.
fn damped(model: Model) -> Result<Model, Error> {
    let M = model.mass_matrix(&START)?;
    let mut parameters = model.parameters();
    let joints = model.parameter_names();
    let dampings = parameters.iter_mut().zip(joints).filter(|(_, name)| name.ends_with(".damping"));
    dampings.enumerate().for_each(|(j, (damping, _))| *damping = M[(j, j)] / 0.2);
    Ok(model.with_parameters(&parameters))
}

/// The gradient along itself against a difference of losses.
fn check_slope(task: &mut Task<'_>, x: &[f64], gradient: &[f64]) -> Result<(), Error> {
    let e = 1e-5 / dot(gradient, gradient).sqrt();
    let mut at = |e: f64| {
        let moved: Vec<f64> = x.iter().zip(gradient).map(|(x, d)| x + e * d).collect();
        task.loss(&moved).map(|(loss, _)| loss)
    };
    let slope = (at(e)? - at(-e)?) / (2.0 * e);
    println!("‖∂L/∂x‖²: {:.9}, by a difference {slope:.9}", dot(gradient, gradient));
    assert!((slope / dot(gradient, gradient) - 1.0).abs() < 1e-6);
    Ok(())
}

/// −H∂L/∂τ, with the inverse Hessian H of the last steps s and changes y of the gradient.
fn descent(memory: &VecDeque<(Vec<f64>, Vec<f64>)>, gradient: &[f64]) -> Vec<f64> {
    let mut way: Vec<f64> = gradient.iter().map(|x| -x).collect();
    let add = |way: &mut Vec<f64>, by: f64, x: &[f64]| way.iter_mut().zip(x).for_each(|(a, b)| *a += by * b);
    let mut alphas = Vec::new();
    for (s, y) in memory {
        let alpha = dot(s, &way) / dot(s, y);
        add(&mut way, -alpha, y);
        alphas.push(alpha);
    }
    if let Some((s, y)) = memory.front() {
        let scale = dot(s, y) / dot(y, y);
        way.iter_mut().for_each(|x| *x *= scale);
    }
    for ((s, y), alpha) in memory.iter().zip(alphas).rev() {
        let beta = dot(y, &way) / dot(s, y);
        add(&mut way, alpha - beta, s);
    }
    way
}

/// The least times of a rollout of 1000 Runge-Kutta steps, and of its gradient with respect to the start and all
/// torques.
fn cost(model: &Model) -> Result<(), Box<dyn std::error::Error>> {
    let (n, steps) = (model.n(), 1000);
    let hold = model.gravity_forces(&START)?;
    let tau: Vec<f64> = (0..steps * n).map(|k| hold[k % n] + 0.1 * (k as f64).sin()).collect();
    let (still, bars) = (vec![0.0; n], vec![1.0; (steps + 1) * n]);
    let (mut theta, mut dtheta) = (bars.clone(), bars.clone());
    let mut rollout = Rollout::new(model, 1e-3, Method::RungeKutta4)?;
    let mut by_checkpoints = Rollout::new(model, 1e-3, Method::RungeKutta4)?.with_checkpoints_every(32)?;
    let mut least = [f64::INFINITY; 3];
    for _ in 0..if cfg!(debug_assertions) { 1 } else { 200 } {
        let mut times = [0.0; 3];
        let start = Instant::now();
        rollout.write_states(&START, &still, &tau, &mut theta, &mut dtheta)?;
        times[0] = start.elapsed().as_secs_f64();
        for (time, rollout) in times[1..].iter_mut().zip([&mut rollout, &mut by_checkpoints]) {
            let start = Instant::now();
            rollout.vjp(&START, &still, &tau, &bars, &bars)?;
            *time = start.elapsed().as_secs_f64();
        }
        least.iter_mut().zip(times).for_each(|(least, time)| *least = least.min(time));
    }
    let [alone, whole, parts] = least;
    println!("\n{steps} steps: {:.2} ms; a gradient takes {:.2} times as long,", 1e3 * alone, whole / alone);
    println!("{:.2} times with checkpoints every 32 steps", parts / alone);
    Ok(())
}

fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}
