//! The controller at 1 kHz on a simulated arm, for four seconds: first the arm of its model, then one that carries half
//! a kilogram more.

use panda_controller::{ComputedTorque, Joints, Reference, panda};

/// The arm with its load.
mod loaded {
    include!(concat!(env!("OUT_DIR"), "/panda_loaded.rs"));
}

/// θ̈ of (θ, θ̇, τ), and the pivots that it divides by.
type Plant = fn(&Joints, &Joints, &Joints, &mut Joints, &mut Joints);

const STEP: f64 = 1e-3;
const HOME: Joints = [0.0, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8];

/// All joints oscillate by 0.3 rad about their home position, with a period of two seconds.
fn reference(t: f64) -> Reference {
    let w = std::f64::consts::PI;
    let (s, c) = (w * t).sin_cos();
    Reference { theta: HOME.map(|q| q + 0.3 * s), dtheta: [0.3 * w * c; 7], ddtheta: [-0.3 * w * w * s; 7] }
}

/// One Runge-Kutta step with constant torque.
fn step(plant: Plant, theta: &mut Joints, dtheta: &mut Joints, tau: &Joints) {
    let along = |x: &Joints, h: f64, dx: &Joints| -> Joints { std::array::from_fn(|j| x[j] + h * dx[j]) };
    let (mut v, mut a, mut pivots) = ([[0.0; 7]; 4], [[0.0; 7]; 4], [0.0; 7]);
    for k in 0..4 {
        let h = [0.0, STEP / 2.0, STEP / 2.0, STEP][k];
        let before = k.saturating_sub(1);
        let (q, dq) = (along(theta, h, &v[before]), along(dtheta, h, &a[before]));
        plant(&q, &dq, tau, &mut a[k], &mut pivots);
        v[k] = dq;
    }
    let mean = |x: [Joints; 4]| -> Joints { std::array::from_fn(|j| (x[0][j] + 2.0 * x[1][j] + 2.0 * x[2][j] + x[3][j]) / 6.0) };
    (*theta, *dtheta) = (along(theta, STEP, &mean(v)), along(dtheta, STEP, &mean(a)));
}

fn main() {
    let controller = ComputedTorque { k_p: 400.0, k_d: 40.0, limits: [87.0, 87.0, 87.0, 87.0, 12.0, 12.0, 12.0] };
    let plants: [(&str, Plant); 2] = [("known arm", panda::forward_dynamics), ("0.5 kg more", loaded::forward_dynamics)];
    for (name, plant) in plants {
        let mut theta = reference(0.0).theta.map(|q| q + 0.05); // 0.05 rad off the reference, at rest
        let mut dtheta = [0.0; 7];
        let mut squares = 0.0;
        for k in 0..4000 {
            let now = reference(f64::from(k) * STEP);
            let Some(tau) = controller.torque(&now, &theta, &dtheta) else {
                println!("{name}: stopped at {} s", f64::from(k) * STEP);
                return;
            };
            if k >= 2000 {
                squares += theta.iter().zip(&now.theta).map(|(q, to)| (q - to) * (q - to)).sum::<f64>();
            }
            step(plant, &mut theta, &mut dtheta, &tau);
        }
        println!("{name}: {:.6e} rad from the reference in the last two seconds (rms)", (squares / (2000.0 * 7.0)).sqrt());
    }
}
