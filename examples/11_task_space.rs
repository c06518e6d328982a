//! Dynamics in the task space (Modern Robotics, section 8.6): the apparent mass of the hand, and the wrenches on it.
//!
//! From 𝒱 = Jθ̇ follows 𝒱̇ = J̇θ̇ + Jθ̈. Put into τ = Mθ̈ + h and multiplied by J⁻ᵀ:
//!
//! > 𝓕 = Λ𝒱̇ + η,  Λ = J⁻ᵀMJ⁻¹,  η = J⁻ᵀh − ΛJ̇J⁻¹𝒱,  τ = Jᵀ𝓕
//!
//! If the robot has more joints than the task has rows, J has no inverse. A wrench on the hand alone then accelerates
//! it by 𝒱̇ = J̇θ̇ + JM⁻¹(Jᵀ𝓕 − h), which gives
//!
//! > Λ = (JM⁻¹Jᵀ)⁻¹,  η = Λ(JM⁻¹h − J̇θ̇)
//!
//! which is the same if J is square. Either way τ = Jᵀ(Λa + η) makes 𝒱̇ = a: the basis of computed-force control.

use mozzi::{Model, Task, TaskFrame};
use mozzi_examples::{agree, row, show};
use nalgebra::DVector;
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let ur5 = mozzi_urdf::open("ur5")?.build()?;
    let theta = [0.3, -1.2, 1.4, -0.5, 0.9, 2.0];
    let dtheta = [0.5, -0.3, 0.8, 1.1, -0.6, 0.4];
    let task = Task::all(ur5.end_effector()?, TaskFrame::Body);
    let found = ur5.task_space_dynamics(&theta, &dtheta, task, &ur5.environment())?;

    println!("UR5, all six rows (ω, v) of its tool, in the tool's frame:");
    show("Λ (kg m², kg m, kg)", &found.Lambda);
    println!("η = [{}] N m, N", row(&found.eta));
    let J_inverse = found.J.clone().try_inverse().ok_or("not singular here")?;
    let Lambda = J_inverse.transpose() * ur5.mass_matrix(&theta)? * &J_inverse;
    let h = ur5.bias_forces(&theta, &dtheta, &ur5.environment())?;
    agree("Λ and J⁻ᵀMJ⁻¹", &found.Lambda, &Lambda, 1e-11);
    agree("η and J⁻ᵀh − ΛJ̇θ̇", &found.eta, &(J_inverse.transpose() * h - Lambda * &found.dJ_dtheta), 1e-11);
    computed_force(&ur5, &theta, &dtheta, task, &[0.5, -1.0, 0.2, 0.3, 0.8, -0.6])?;

    // seven joints, three rows: the velocity of the hand's origin
    let panda = mozzi_urdf::open("panda")?.build()?.with_locked_joints(&[("panda_finger_joint1", 0.03)])?;
    let theta = [0.3, -0.5, 0.2, -2.0, 0.4, 1.8, 0.7];
    let dtheta = [0.4, -0.3, 0.6, 0.5, -0.8, 0.3, 0.9];
    let task = Task { frame: panda.frame("panda_hand")?, coordinates: TaskFrame::Body, rows: &[3, 4, 5] };
    let found = panda.task_space_dynamics(&theta, &dtheta, task, &panda.environment())?;
    println!("\nPanda, seven joints, the three rows v of its hand, in the hand's frame:");
    show("Λ (kg)", &found.Lambda);
    println!("η = [{}] N", row(&found.eta));
    computed_force(&panda, &theta, &dtheta, task, &[1.0, -2.0, 0.5])?;

    // with the arm stretched out, the rows cannot be moved independently: the error contains the numbers
    let stretched = ur5.task_space_dynamics(
        &[0.0; 6],
        &[0.0; 6],
        Task::all(ur5.end_effector()?, TaskFrame::Body),
        &ur5.environment(),
    );
    let error = stretched.err().ok_or("the UR5 is singular at θ = 0")?;
    println!("\nUR5 at θ = 0: {error}");
    Ok(())
}

/// Chooses the task's acceleration a, applies τ = Jᵀ(Λa + η), and checks the result with forward dynamics.
fn computed_force(model: &Model, theta: &[f64], dtheta: &[f64], task: Task, a: &[f64]) -> Result<(), Box<dyn Error>> {
    let dynamics = model.task_space_dynamics(theta, dtheta, task, &model.environment())?;
    let a = DVector::from_column_slice(a);
    let tau = dynamics.J.transpose() * dynamics.wrench(&a);
    let ddtheta = model.forward_dynamics(theta, dtheta, tau.as_slice(), &model.environment())?;
    let moved = &dynamics.J * ddtheta + &dynamics.dJ_dtheta;
    println!("a = [{}] asked for, by τ = [{}] N m", row(&a), row(&tau));
    agree("J̇θ̇ + Jθ̈ of forward dynamics and a", &moved, &a, 1e-10);
    Ok(())
}
