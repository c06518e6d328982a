//! The falling cat: a free-floating arm turns its base by moving its joints, although its angular momentum stays 0.
//!
//! With A(θ) the matrix of the momentum h = A θ̇ and its base columns separated, h = A_b 𝒱_b + A_j θ̇_j = 0 gives the
//! base's twist for any motion of the joints: 𝒱_b = −A_b⁻¹ A_j θ̇_j. After a closed loop of the joints, back to the
//! same posture, the base is rotated by an angle that depends on the loop but not on its duration. The reversed loop
//! rotates it back.
//!
//! The second computation is by forward dynamics: motors make the joints follow the loop, and no wrench acts on the
//! base.

use mozzi::model::integrate;
use mozzi::nalgebra::{DMatrix, DVector};
use mozzi::{Model, SE3, Vec3};
use mozzi_examples::agree;
use mozzi_sim::{Options, torque};
use std::error::Error;
use std::f64::consts::TAU;

/// The loop: a circle of the shoulder's and the elbow's angles that starts and ends at the posture POSE.
const POSE: [f64; 6] = [0.0, -1.2, 0.9, 0.3, 0.4, 0.0];
const RADIUS: f64 = 1.4;

/// Joint positions, rates and accelerations at the phase s ∈ [0, 1], which passes in one second, starting and ending at
/// rest.
fn on_the_loop(t: f64) -> [[f64; 6]; 3] {
    // s = t − sin(2πt)/2π, so that ṡ = s̈ = 0 at both ends
    let (s, ds, dds) = (t - (TAU * t).sin() / TAU, 1.0 - (TAU * t).cos(), TAU * (TAU * t).sin());
    let ((sin, cos), r) = ((TAU * s).sin_cos(), RADIUS);
    let (mut q, mut dq, mut ddq) = (POSE, [0.0; 6], [0.0; 6]);
    let (u, du, ddu) =
        ([r * (1.0 - cos), r * sin], [r * TAU * sin, r * TAU * cos], [r * TAU * TAU * cos, -r * TAU * TAU * sin]);
    for k in 0..2 {
        q[1 + k] += u[k];
        dq[1 + k] = du[k] * ds;
        ddq[1 + k] = ddu[k] * ds * ds + du[k] * dds;
    }
    [q, dq, ddq]
}

fn main() -> Result<(), Box<dyn Error>> {
    let arm = mozzi_urdf::open("ur5")?.description.floating().with_gravity([0.0; 3]).build()?;
    println!(
        "A UR5 adrift: {:.1} kg, of which the base is {:.1} kg.",
        arm.mass(),
        arm.description().links[0].inertia.mass
    );

    let there = by_momentum(&arm, 1000, false)?;
    let (angle, axis) = turn(there);
    println!(
        "One loop of two joints in one second turns the base by {:.3}° about [{:.3?}].",
        angle.to_degrees(),
        axis.0
    );
    let back = by_momentum(&arm, 1000, true)?;
    agree("the loop backwards turns it back", &(there * back).to_pose(), &SE3::identity().to_pose(), 1e-5);
    let ways = by_forces(&arm)?;
    agree("the same by forces", &ways.log().to_array(), &there.log().to_array(), 1e-3);
    assert!(angle.to_degrees() > 5.0, "a turn that one can see");
    Ok(())
}

/// The angle and axis of a turn.
fn turn(T: SE3) -> (f64, Vec3) {
    let w = T.R.log();
    (w.norm(), w * (1.0 / w.norm()))
}

/// The base's configuration after the loop, by 𝒱_b = −A_b⁻¹ A_j θ̇_j and the midpoint rule on SE(3).
fn by_momentum(arm: &Model, steps: usize, backwards: bool) -> Result<SE3, Box<dyn Error>> {
    let mut theta: Vec<f64> = arm.neutral_configuration();
    let h = 1.0 / steps as f64;
    let rates = |theta: &[f64], t: f64| -> Result<Vec<f64>, Box<dyn Error>> {
        let (dq, sign) = if backwards { (on_the_loop(1.0 - t)[1], -1.0) } else { (on_the_loop(t)[1], 1.0) };
        let A = arm.centroidal_momentum_matrix(theta)?;
        let joints = DVector::from_fn(6, |j, _| sign * dq[j]);
        let A_b: DMatrix<f64> = A.columns(0, 6).into_owned();
        let V_b = A_b.lu().solve(&-(A.columns(6, 6) * &joints)).ok_or("a base without inertia")?;
        Ok(V_b.iter().chain(joints.iter()).copied().collect())
    };
    theta[7..].copy_from_slice(&POSE);
    for k in 0..steps {
        let t = k as f64 * h;
        let mut middle = theta.clone();
        integrate(arm, &mut middle, &rates(&theta, t)?, 0.5 * h);
        let along = rates(&middle, t + 0.5 * h)?;
        integrate(arm, &mut theta, &along, h);
    }
    Ok(SE3::from_pose(*theta.first_chunk().ok_or("a base")?))
}

/// The pose of the base after the loop, driven by motors. The joints' accelerations are given. Mθ̈ + h = τ then gives
/// the acceleration of the base (its rows, where τ = 0) and the torques (the other rows).
fn by_forces(arm: &Model) -> Result<SE3, Box<dyn Error>> {
    let motors = torque(|t, theta, dtheta, tau| {
        let [q, dq, ddq] = on_the_loop(t);
        // the loop's acceleration, and a little to hold the joints on it
        let joints =
            DVector::from_fn(6, |j, _| ddq[j] + 400.0 * (q[j] - theta[7 + j]) + 40.0 * (dq[j] - dtheta[6 + j]));
        let (Ok(M), Ok(h)) = (arm.mass_matrix(theta), arm.bias_forces(theta, dtheta, &arm.environment())) else {
            return;
        };
        let M_b: DMatrix<f64> = M.view((0, 0), (6, 6)).into_owned();
        let Some(dV) = M_b.lu().solve(&-(M.view((0, 6), (6, 6)) * &joints + h.rows(0, 6))) else { return };
        let needed = M.view((6, 0), (6, 6)) * dV + M.view((6, 6), (6, 6)) * joints + h.rows(6, 6);
        tau[6..].copy_from_slice(needed.as_slice());
    });
    let mut theta: Vec<f64> = arm.neutral_configuration();
    theta[7..].copy_from_slice(&POSE);
    let end = mozzi_sim::simulate(arm, &theta, &vec![0.0; arm.n()], motors, &Options::new(1.0, 1000))?;
    let momentum = arm.momentum(end.last().theta, end.last().dtheta, Vec3::zero())?;
    println!("  by forces: momentum at the end {:.0e}, base {:.0e} rad/s", momentum.norm(), end.last().dtheta[0].abs());
    Ok(SE3::from_pose(*end.last().theta.first_chunk().ok_or("a base")?))
}
