//! The dynamics in closed form (Modern Robotics, section 8.4): the stacked matrices of the UR5.
//!
//! The recursion of Newton and Euler, all links at once, is a system of linear equations. With 𝒜 and 𝒢 constant and
//! block diagonal, and 𝒲(θ) holding [Ad_{T_{i,i−1}}] below the diagonal (base at rest):
//!
//! > 𝒱 = 𝒲𝒱 + 𝒜θ̇,  𝒱̇ = 𝒲𝒱̇ + 𝒜θ̈ − [ad_𝒜θ̇]𝒲𝒱 + 𝒱̇_base,  𝓕 = 𝒲ᵀ𝓕 + 𝒢𝒱̇ − [ad_𝒱]ᵀ𝒢𝒱 + 𝓕_tip,  τ = 𝒜ᵀ𝓕
//!
//! 𝒲 maps quantities to the next link, so 𝒲ⁿ = 0 and ℒ = (I − 𝒲)⁻¹ = I + 𝒲 + … + 𝒲ⁿ⁻¹ exists for every θ. Solved:
//!
//! > M = 𝒜ᵀℒᵀ𝒢ℒ𝒜,  c = −𝒜ᵀℒᵀ(𝒢ℒ[ad_𝒜θ̇]𝒲 + [ad_𝒱]ᵀ𝒢)ℒ𝒜θ̇,  g = 𝒜ᵀℒᵀ𝒢ℒ𝒱̇_base,  τ = Mθ̈ + c + g + 𝒜ᵀℒᵀ𝓕_tip

use mozzi::{Environment, Wrench};
use mozzi_examples::{agree, row, show};
use nalgebra::DMatrix;
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let model = mozzi_urdf::open("ur5")?.build()?;
    let n = model.n();
    let theta = [0.3, -1.2, 1.4, -0.5, 0.9, 2.0];
    let dtheta = [0.5, -0.3, 0.8, 1.1, -0.6, 0.4];
    let push = [(model.end_effector()?, Wrench::from_array([0.1, -0.2, 0.3, 4.0, 5.0, -6.0]))];
    let environment = Environment { applied: &push, ..model.environment() };

    let form = model.closed_form(&theta, &dtheta, &environment)?;
    for (name, matrix) in [
        ("𝒜", &form.A),
        ("𝒢", &form.G),
        ("𝒲", &form.W),
        ("ℒ", &form.L),
        ("[ad_𝒱]", &form.ad_V),
        ("[ad_𝒜θ̇]", &form.ad_Adtheta),
    ] {
        println!("{name:>8}: {} × {}", matrix.nrows(), matrix.ncols());
    }
    for (name, vector) in [("𝒱", &form.V), ("𝒱̇_base", &form.dV_base), ("𝓕_tip", &form.F_tip)] {
        println!("{name:>8}: {}", vector.len());
    }

    // 𝒲 is nilpotent: the sum of its powers is finite
    println!("\nlargest entry of the powers of 𝒲, which move quantities 1, 2, … links on:");
    let (mut power, mut sum) = (form.W.clone(), DMatrix::identity(6 * n, 6 * n));
    for k in 1..n {
        println!("  𝒲^{k}: {:.4}", power.amax());
        sum += &power;
        power = &form.W * power;
    }
    println!("  𝒲^{n}: {}\n", power.amax());
    assert_eq!(power.amax(), 0.0, "exactly");
    let inverse = (DMatrix::identity(6 * n, 6 * n) - &form.W).try_inverse().ok_or("I − 𝒲 is regular")?;
    agree("ℒ and (I − 𝒲)⁻¹", &form.L, &inverse, 1e-14);
    agree("ℒ and I + 𝒲 + … + 𝒲ⁿ⁻¹", &form.L, &sum, 1e-14);

    // the formulas, literally
    let (A, G, W, L) = (&form.A, &form.G, &form.W, &form.L);
    let (At, Lt, dtheta_vector) = (A.transpose(), L.transpose(), nalgebra::DVector::from_column_slice(&dtheta));
    let M = &At * &Lt * G * L * A;
    let c = -(&At * &Lt * (G * L * &form.ad_Adtheta * W + form.ad_V.transpose() * G) * L * A * dtheta_vector);
    let g = &At * &Lt * G * L * &form.dV_base;
    let J_transpose_F = &At * &Lt * &form.F_tip;

    agree("M against the composite-rigid-body kernel", &M, &model.mass_matrix(&theta)?, 1e-14);
    agree("c against the Newton-Euler kernel", &c, &model.velocity_product(&theta, &dtheta)?, 1e-13);
    agree("g", &g, &model.gravity_forces(&theta)?, 1e-14);
    agree("JᵀF", &J_transpose_F, &model.tip_forces(&theta, &push)?, 1e-14);
    println!();
    show("M (kg m²)", &M);
    println!("c = [{}] N m\ng = [{}] N m\nJᵀF = [{}] N m", row(&c), row(&g), row(&J_transpose_F));
    Ok(())
}
