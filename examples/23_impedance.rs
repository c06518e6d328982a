//! Impedance control (Modern Robotics, section 11.7; Hogan 1985): the tool behaves as a spring and a damper,
//!
//! > τ = Jᵀ(Λa + η + B𝒱_e + KX_e),  so that Λ𝒱̇_e + B𝒱_e + KX_e = 𝓕,
//!
//! the wrench that it applies to its environment. Only the joints are measured. First the tool follows a motion; then
//! it pushes against a wall with 15 N, and yields by KX_e = 𝓕.

use mozzi::{Vec3, Wrench};
use mozzi_examples::agree;
use mozzi_examples::tracking::{Arm, both_loads};
use mozzi_motion::controllers::{Gains, Law, TaskSpace};
use mozzi_motion::trajectories::{Hold, Reference};
use mozzi_sim::{Options, applied};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arms = Arm::both()?;
    let (stiffness, damping) = ([20.0, 20.0, 20.0, 1000.0, 1000.0, 1000.0], [1.5, 1.5, 1.5, 90.0, 90.0, 90.0]);
    let law = Law::Impedance { stiffness, damping };
    let errors = both_loads(&arms, "impedance", |arm| {
        Ok(TaskSpace::new(&arm.model, arm.motion()?, arm.tool, law, Gains::critical(arm.model.n(), 10.0))?)
    })?;
    for [free, loaded] in errors {
        assert!(free < 1e-6 && loaded > 1e-3 && loaded < 0.5, "soft under a load: {free:e}, {loaded:e}");
    }
    println!();
    let push = Wrench { m: Vec3::zero(), f: Vec3([0.0, 0.0, 15.0]) };
    for arm in &arms {
        let (start, n) = (arm.motion()?.at(0.0).theta, arm.model.n());
        let control = TaskSpace::new(&arm.model, Hold::new(&start, n), arm.tool, law, Gains::critical(n, 10.0))?;
        let input = (control, applied(arm.tool, move |_, _, _| push));
        let held = mozzi_sim::simulate(&arm.model, &start, &vec![0.0; n], input, &Options::new(2.1, 700))?;
        let T = |theta: &[f64]| arm.model.forward_kinematics(theta, arm.tool);
        let X = (T(held.last().theta)?.inverse() * T(&start)?).log();
        println!("{}: pushed back by 15 N, the tool yields by {:.2} mm along its axis", arm.name, 1e3 * X.v.0[2]);
        let spring: Vec<f64> = X.to_array().iter().zip(stiffness).map(|(x, k)| k * x).collect();
        agree("KX_e and 𝓕", &spring, &push.to_array(), 5e-3);
    }
    Ok(())
}
