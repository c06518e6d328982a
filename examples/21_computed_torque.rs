//! Computed torque control (Modern Robotics, section 11.4.3), τ = M(θ)(θ̈_d + K_d ė + K_p e) + h(θ, θ̇).
//!
//! Inserted into the equation of motion it leaves ë + K_d ė + K_p e = 0, which does not depend on the robot: an arm
//! that matches its model tracks up to the integration error. A load that is missing in the model adds M⁻¹ times its
//! torques.

use mozzi_examples::tracking::{Arm, both_loads};
use mozzi_motion::controllers::{ComputedTorque, Gains};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arms = Arm::both()?;
    let errors = both_loads(&arms, "computed torque", |arm| {
        Ok(ComputedTorque::new(&arm.model, arm.motion()?, Gains::critical(arm.model.n(), 20.0))?)
    })?;
    for [free, loaded] in errors {
        assert!(free < 1e-6 && loaded > 1e-3 && loaded < 0.3, "exact of the robot as modelled: {free:e}, {loaded:e}");
    }
    Ok(())
}
