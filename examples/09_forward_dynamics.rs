//! Forward dynamics in three ways (Modern Robotics, section 8.5): given τ, the accelerations θ̈ with
//!
//! > M(θ)θ̈ = τ − h(θ, θ̇) − JᵀF_tip
//!
//! 1. The book's: h by one call of inverse dynamics with θ̈ = 0, column i of M by a call with θ̈ = e_i and nothing
//!    else; then a general solver. O(n³).
//! 2. Composite rigid bodies for M, and its factors M = LᵀDL along the tree. O(n · depth²) at most.
//! 3. Articulated bodies: what each link, with all that hangs from it free to move, would feel like to a push. O(n),
//!    and what `forward_dynamics` does.
//!
//! From θ̈, inverse dynamics recovers τ. (For robots with mimic joints the articulated-body algorithm does not apply,
//! and `forward_dynamics` uses the second way.)

use mozzi::{Environment, Model, Vec3, Wrench};
use mozzi_examples::{agree, row};
use nalgebra::DMatrix;
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let ur5 = mozzi_urdf::open("ur5")?.build()?;
    compare("UR5", &ur5, "tool0")?;
    // its second finger is a mimic joint of the first: both are locked, so that all joints are independent
    let panda = mozzi_urdf::open("panda")?.build()?.with_locked_joints(&[("panda_finger_joint1", 0.03)])?;
    compare("Panda", &panda, "panda_hand")
}

fn compare(name: &str, model: &Model, tip: &str) -> Result<(), Box<dyn Error>> {
    let n = model.n();
    let number = |seed: f64| move |i: usize| (seed * (i + 1) as f64).sin(); // any numbers
    let theta: Vec<f64> = (0..n).map(number(0.7)).collect();
    let dtheta: Vec<f64> = (0..n).map(number(1.9)).collect();
    let tau: Vec<f64> = (0..n).map(number(2.3)).collect();
    let push = [(model.frame(tip)?, Wrench::from_array([0.1, -0.2, 0.3, 4.0, 5.0, -6.0]))];
    let environment = Environment { applied: &push, ..model.environment() };

    let by_columns = model.forward_dynamics_by_inverse_dynamics(&theta, &dtheta, &tau, &environment)?;
    let by_mass_matrix = model.forward_dynamics_by_mass_matrix(&theta, &dtheta, &tau, &environment)?;
    let by_articulated_bodies = model.forward_dynamics(&theta, &dtheta, &tau, &environment)?;
    println!("{name}: θ̈ in rad/s²");
    for found in [&by_columns, &by_mass_matrix, &by_articulated_bodies] {
        println!("  [{}]", row(found));
    }
    agree("composite bodies and n + 1 calls", &by_mass_matrix, &by_columns, 1e-12);
    agree("articulated bodies and n + 1 calls", &by_articulated_bodies, &by_columns, 1e-12);

    // the n calls, by hand: no gravity, no velocity, θ̈ = e_i
    let (zero, rest) = (vec![0.0; n], Environment::with_gravity(Vec3::zero()));
    let mut M = DMatrix::zeros(n, n);
    for i in 0..n {
        let mut e = zero.clone();
        e[i] = 1.0;
        M.set_column(i, &model.inverse_dynamics(&theta, &zero, &e, &rest)?);
    }
    agree("M by columns and by composite bodies", &M, &model.mass_matrix(&theta)?, 1e-14);
    let again = model.inverse_dynamics(&theta, &dtheta, by_articulated_bodies.as_slice(), &environment)?;
    agree("inverse dynamics gives τ back", &again, &tau, 1e-12);
    println!();
    Ok(())
}
