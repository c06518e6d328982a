//! Task-space control (Modern Robotics, section 11.4.3): the tool's error obeys 𝒱̇_e + K_d 𝒱_e + K_p X_e = 0, by
//!
//! > τ = Jᵀ(Λ(a + K_d 𝒱_e + K_p X_e) + η),  X_e = log(T⁻¹T_d),  𝒱_e = [Ad_{T⁻¹T_d}]𝒱_d − 𝒱
//!
//! with a the acceleration at which 𝒱̇_e = 0. The Panda's seventh joint keeps its posture in the null space of the
//! task.

use mozzi_examples::tracking::{Arm, both_loads};
use mozzi_motion::controllers::{Gains, Law, TaskSpace};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arms = Arm::both()?;
    let law = Law::Acceleration { p: [400.0; 6], d: [40.0; 6] };
    let errors = both_loads(&arms, "task space", |arm| {
        Ok(TaskSpace::new(&arm.model, arm.motion()?, arm.tool, law, Gains::critical(arm.model.n(), 10.0))?)
    })?;
    for [free, loaded] in errors {
        assert!(free < 1e-6 && loaded > 1e-3 && loaded < 0.3, "exact of the robot as modelled: {free:e}, {loaded:e}");
    }
    Ok(())
}
