//! The planar arm with two joints (Modern Robotics, section 8.1): hand formulas against the library.
//!
//! Two massless rods of lengths L1 and L2, a point mass at the tip of each, in a vertical plane; θ1 is measured from
//! the horizontal, θ2 from the first rod. (The robot's file states how the book's x-y plane lies there.) Lagrange's
//! way, with c1 = cos θ1, c12 = cos(θ1 + θ2), s2 = sin θ2 …:
//!
//! > p1 = L1 (c1, s1),  p2 = p1 + L2 (c12, s12)
//! > ‖ṗ1‖² = L1²θ̇1²,  ‖ṗ2‖² = (L1² + 2L1L2c2 + L2²)θ̇1² + 2(L2² + L1L2c2)θ̇1θ̇2 + L2²θ̇2²
//! > 𝒦 = ½m1‖ṗ1‖² + ½m2‖ṗ2‖² = ½θ̇ᵀMθ̇,  𝒫 = m1 g L1s1 + m2 g (L1s1 + L2s12)
//!
//! so that, of τ = d/dt ∂𝒦/∂θ̇ − ∂𝒦/∂θ + ∂𝒫/∂θ,
//!
//! > M = [[m1L1² + m2(L1² + 2L1L2c2 + L2²), m2(L1L2c2 + L2²)], [m2(L1L2c2 + L2²), m2L2²]]
//! > c = (−m2L1L2s2(2θ̇1θ̇2 + θ̇2²), m2L1L2s2θ̇1²)
//! > g = ((m1 + m2)L1 g c1 + m2 g L2c12, m2 g L2c12)

use mozzi_examples::{agree, row, show};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let (m1, m2, L1, L2, gravity) = (2.0, 1.0, 0.5, 0.4, 9.81); // the robot's file says these
    let model = mozzi_urdf::open("two_link_planar")?.build()?;

    let (theta, dtheta, ddtheta): ([f64; 2], _, _) = ([0.6, -1.1], [0.8, 1.5], [2.0, -1.0]);
    let (c1, c2, s2, c12) = (theta[0].cos(), theta[1].cos(), theta[1].sin(), (theta[0] + theta[1]).cos());

    // by hand
    let M12 = m2 * (L1 * L2 * c2 + L2 * L2);
    let M_hand = [m1 * L1 * L1 + m2 * (L1 * L1 + 2.0 * L1 * L2 * c2 + L2 * L2), M12, M12, m2 * L2 * L2];
    let k = m2 * L1 * L2 * s2;
    let c_hand = [-k * (2.0 * dtheta[0] * dtheta[1] + dtheta[1] * dtheta[1]), k * dtheta[0] * dtheta[0]];
    let g_hand = [(m1 + m2) * L1 * gravity * c1 + m2 * gravity * L2 * c12, m2 * gravity * L2 * c12];
    let tau_hand: Vec<f64> =
        (0..2).map(|i| M_hand[2 * i] * ddtheta[0] + M_hand[2 * i + 1] * ddtheta[1] + c_hand[i] + g_hand[i]).collect();

    // by the library
    let M = model.mass_matrix(&theta)?;
    let c = model.velocity_product(&theta, &dtheta)?;
    let g = model.gravity_forces(&theta)?;
    let tau = model.inverse_dynamics(&theta, &dtheta, &ddtheta, &model.environment())?;

    println!("2R arm at θ = {theta:?} rad, θ̇ = {dtheta:?} rad/s, θ̈ = {ddtheta:?} rad/s²\n");
    show("M (kg m²)", &M);
    println!("c = [{}] N m\ng = [{}] N m\nτ = [{}] N m\n", row(&c), row(&g), row(&tau));
    agree("M, by hand and by the library", &M, &M_hand, 1e-14);
    agree("c", &c, &c_hand, 1e-14);
    agree("g", &g, &g_hand, 1e-14);
    agree("τ = Mθ̈ + c + g", &tau, &tau_hand, 1e-14);
    Ok(())
}
