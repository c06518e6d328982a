//! PD control with gravity compensation (Modern Robotics, section 11.4.2), τ = g(θ) + K_p e + K_d ė.
//!
//! It holds any posture: with 𝒦 + ½ eᵀK_p e as Lyapunov function, the robot comes to rest with e = 0. It ignores
//! accelerations, and so lags behind a motion. A load that is missing in its model causes a steady-state error: K_p e =
//! the load's torques.

use mozzi_examples::tracking::{Arm, both_loads};
use mozzi_motion::controllers::{Gains, PdGravity};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arms = Arm::both()?;
    // stiff at the base, soft at the wrist, where the inertia is small
    let (p, d) = ([600.0, 600.0, 400.0, 300.0, 30.0, 30.0, 10.0], [20.0, 20.0, 15.0, 10.0, 0.6, 0.6, 0.2]);
    let gains = |n: usize| Gains { p: p[..n].to_vec(), d: d[..n].to_vec() };
    let errors =
        both_loads(&arms, "pd gravity", |arm| Ok(PdGravity::new(&arm.model, arm.motion()?, gains(arm.model.n()))?))?;
    for [free, loaded] in errors {
        assert!(free > 1e-3 && free < 0.3 && loaded < 0.3, "it lags, and follows all the same");
    }
    Ok(())
}
