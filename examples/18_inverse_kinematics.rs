//! Inverse kinematics (Modern Robotics, chapter 6): joint positions that place the hand at a desired pose.
//!
//! With e = log(T⁻¹T_d) the body twist that moves the hand's pose to the goal in one second, J_b δ = e is the
//! Newton-Raphson step. Near singular positions δ is unbounded; the Levenberg-Marquardt step minimizes
//!
//! > ‖J_b δ − e‖² + λ‖δ‖²,  δ = Jᵀ(JJᵀ + λI)⁻¹e
//!
//! This example computes it by hand on the UR5 first, then with the library, which adds limits, random starts and, for
//! the Panda's seventh joint, a secondary goal: among all positions with the hand at its goal, the one nearest to a
//! posture.

use mozzi::kinematics::{body_jacobian, forward_kinematics};
use mozzi::nalgebra::DVector;
use mozzi::{Model, SE3};
use mozzi_examples::{agree, row};
use mozzi_motion::inverse_kinematics::Secondary;
use mozzi_motion::{Goal, InverseKinematics};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let ur5 = mozzi_urdf::open("ur5")?.build()?;
    let tool = ur5.end_effector()?;
    let (goal, guess) =
        (ur5.forward_kinematics(&[0.3, -1.2, 1.4, -0.5, 0.9, 2.0], tool)?, [0.0, -1.0, 1.0, 0.0, 0.5, 1.5]);

    println!("UR5, the book's Newton-Raphson by hand, from θ = [{}]:", row(&guess));
    let by_hand = newton(&ur5, goal, &guess)?;
    let found = InverseKinematics::new(&ur5, tool)?.solve(Goal::Pose(goal), &guess)?;
    println!("by the library: {} iterations, {} away", found.iterations, found.residual);
    agree("θ, by hand and by the library", &found.theta, &by_hand, 1e-7);

    // from any start, within the limits
    let far = InverseKinematics::new(&ur5, tool)?.solve(Goal::Pose(goal), &[3.0, 2.0, -2.5, 1.0, -3.0, 0.0])?;
    println!("from afar: θ = [{}], {} starts", row(&far.theta), far.starts);
    agree("the pose there and the goal", &pose(&ur5, &far.theta)?, &goal.to_pose(), 1e-7);

    // out of reach: the error gives the remaining distance
    let away = InverseKinematics::new(&ur5, tool)?.solve(Goal::Pose(SE3::translation([2.0, 0.0, 0.0])), &guess);
    println!("2 m away: {}", away.err().ok_or("the UR5 does not reach that far")?);

    // seven joints, six rows: a line of solutions
    let panda = mozzi_urdf::open("panda")?.build()?.with_locked_joints(&[("panda_finger_joint1", 0.02)])?;
    let hand = panda.frame("panda_hand")?;
    let start = [0.1, 0.2, 0.1, -1.0, 0.0, 1.0, 0.0];
    let goal = Goal::Pose(panda.forward_kinematics(&[0.5, -0.3, -0.4, -1.7, 0.1, 1.5, 1.0], hand)?);
    let posture = [0.3, -0.5, 0.2, -2.0, 0.4, 1.8, 0.7];
    let mut solver = InverseKinematics::new(&panda, hand)?;
    let first = solver.solve(goal, &start)?;
    let nearest = solver.solve_with(goal, &start, &Secondary::Near(&posture))?;
    let away = |theta: &[f64]| theta.iter().zip(&posture).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt();
    println!("\nPanda, the hand at a pose; how far the joints are from the posture [{}]:", row(&posture));
    println!("  the first solution [{}]: {:.4} rad", row(&first.theta), away(&first.theta));
    println!("  the nearest        [{}]: {:.4} rad", row(&nearest.theta), away(&nearest.theta));
    assert!(away(&nearest.theta) < away(&first.theta));
    Ok(())
}

/// θ ← θ + J_b⁻¹ log(T⁻¹T_d), six by six.
fn newton(model: &Model, goal: SE3, guess: &[f64]) -> Result<Vec<f64>, Box<dyn Error>> {
    let (tool, mut theta) = (model.end_effector()?, DVector::from_column_slice(guess));
    let mut columns = vec![mozzi::Twist::zero(); model.n()];
    for iteration in 0..20 {
        let e = (forward_kinematics(model, theta.as_slice(), tool).inverse() * goal).log();
        println!("  iteration {iteration}: {:.1e} rad, {:.1e} m", e.w.dot(e.w).sqrt(), e.v.dot(e.v).sqrt());
        if e.norm() < 1e-12 {
            return Ok(theta.as_slice().to_vec());
        }
        body_jacobian(model, theta.as_slice(), tool, &mut columns);
        let J = mozzi::Jacobian(columns.clone()).matrix();
        theta += J.lu().solve(&DVector::from_column_slice(&e.to_array())).ok_or("a singular position")?;
    }
    Err("no convergence in 20 iterations".into())
}

fn pose(model: &Model, theta: &[f64]) -> Result<[f64; 7], mozzi::Error> {
    Ok(model.forward_kinematics(theta, model.end_effector()?)?.to_pose())
}
