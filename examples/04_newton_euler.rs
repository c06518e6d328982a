//! The recursive Newton-Euler algorithm spelled out (Modern Robotics, section 8.3) on the UR5.
//!
//! Frame {i} is at the centre of mass of link i, {n+1} at the end effector. Base to tip, with V_0 = 0, V̇_0 = (0, −g):
//!
//! > T_{i,i−1} = e^{−[A_i]θ_i} M_{i,i−1}
//! > V_i = Ad_{T_{i,i−1}}(V_{i−1}) + A_iθ̇_i
//! > V̇_i = Ad_{T_{i,i−1}}(V̇_{i−1}) + ad_{V_i}(A_i)θ̇_i + A_iθ̈_i
//!
//! and back, from the wrench F_{n+1} = F_tip that the end effector applies to the environment:
//!
//! > F_i = Ad_{T_{i+1,i}}ᵀ(F_{i+1}) + G_iV̇_i − ad_{V_i}ᵀ(G_iV_i)
//! > τ_i = F_iᵀA_i

use mozzi::{BodyFrame, Environment, SE3, Twist, Wrench};
use mozzi_examples::{agree, row};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let model = mozzi_urdf::open("ur5")?.build()?;
    let n = model.n();
    let theta = [0.3, -1.2, 1.4, -0.5, 0.9, 2.0];
    let dtheta = [0.5, -0.3, 0.8, 1.1, -0.6, 0.4];
    let ddtheta = [1.0, 2.0, -1.0, 0.5, -0.7, 1.5];
    let F_tip = Wrench::from_array([0.1, -0.2, 0.3, 4.0, 5.0, -6.0]);

    // the constants, numbered from 1 as in the book: M[i] is M_{i,i−1}
    let lists = model.screws()?;
    let (_, M_tip) = lists.end_effector.ok_or("the UR5 ends in its tool")?;
    let (A, G) = (|i: usize| lists.A[i - 1], |i: usize| lists.G[i - 1]);
    let mut M = vec![SE3::identity()];
    M.extend(lists.M_relative.iter().map(|M| M.inverse()));
    M.push(M_tip.inverse() * lists.M[n - 1]);

    // base to tip
    let (mut T, mut V, mut dV) = (M.clone(), vec![Twist::zero(); n + 1], vec![Twist::zero(); n + 1]);
    dV[0] = Twist::linear(-model.gravity());
    for i in 1..=n {
        let (rate, acceleration) = (dtheta[i - 1], ddtheta[i - 1]);
        T[i] = SE3::exp(A(i) * -theta[i - 1]) * M[i];
        V[i] = T[i].Ad() * V[i - 1] + A(i) * rate;
        dV[i] = T[i].Ad() * dV[i - 1] + V[i].ad() * (A(i) * rate) + A(i) * acceleration;
    }
    // tip to base
    let (mut F, mut tau) = (vec![Wrench::zero(); n + 2], vec![0.0; n]);
    F[n + 1] = F_tip;
    for i in (1..=n).rev() {
        F[i] = T[i + 1].Ad().transpose() * F[i + 1] + G(i) * dV[i] - V[i].ad().transpose() * (G(i) * V[i]);
        tau[i - 1] = A(i).twist().dot(F[i]);
    }

    for i in 1..=n {
        println!("link {i}: {}", lists.links[i - 1]);
        println!("  V_{i}  = ({})", row(&V[i].to_array()));
        println!("  V̇_{i}  = ({})", row(&dV[i].to_array()));
        println!("  F_{i}  = ({})", row(&F[i].to_array()));
    }
    println!("τ = ({}) N m\n", row(&tau));

    // by the library
    let applied = [(model.end_effector()?, F_tip)];
    let environment = Environment { applied: &applied, ..model.environment() };
    agree("τ", &tau, &model.inverse_dynamics(&theta, &dtheta, &ddtheta, &environment)?, 1e-14);
    let found = model.newton_euler(&theta, &dtheta, &ddtheta, &environment, BodyFrame::CenterOfMass)?;
    let twists = |list: &[Twist]| list.iter().flat_map(|V| V.to_array()).collect::<Vec<f64>>();
    let wrenches = |list: &[Wrench]| list.iter().flat_map(|F| F.to_array()).collect::<Vec<f64>>();
    agree("all V_i", &twists(&V[1..]), &twists(&found.twists), 1e-14);
    agree("all V̇_i", &twists(&dV[1..]), &twists(&found.accelerations), 1e-14);
    agree("all F_i", &wrenches(&F[1..=n]), &wrenches(&found.wrenches), 1e-14);
    Ok(())
}
