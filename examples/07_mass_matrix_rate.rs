//! The rate of the mass matrix (Modern Robotics, exercise 8.7), and the C for which Ṁ − 2C is skew-symmetric.
//!
//! In M = 𝒜ᵀℒᵀ𝒢ℒ𝒜 only ℒ = (I − 𝒲)⁻¹ depends on θ. From d/dt Ad_{T_{i,i−1}} = −ad_{A_iθ̇_i}Ad_{T_{i,i−1}} follow
//!
//! > 𝒲̇ = −[ad_𝒜θ̇]𝒲,  ℒ̇ = ℒ𝒲̇ℒ = −ℒ[ad_𝒜θ̇]𝒲ℒ
//! > Ṁ = 𝒜ᵀℒ̇ᵀ𝒢ℒ𝒜 + 𝒜ᵀℒᵀ𝒢ℒ̇𝒜 = −(X + Xᵀ) with X = 𝒜ᵀℒᵀ𝒢ℒ[ad_𝒜θ̇]𝒲ℒ𝒜
//!
//! The book writes c = Cθ̇ with C = −𝒜ᵀℒᵀ(𝒢ℒ[ad_𝒜θ̇]𝒲 + [ad_𝒱]ᵀ𝒢)ℒ𝒜. A matrix with Cθ̇ = c is not unique, and this one
//! lacks the property that control theory needs: Ṁ − 2C + its transpose = 2𝒜ᵀℒᵀ([ad_𝒱]ᵀ𝒢 + 𝒢[ad_𝒱])ℒ𝒜, which is not 0.
//! The C of the Christoffel symbols has it: Ṁ = C + Cᵀ, so that Ṁ − 2C = Cᵀ − C. Both give θ̇ᵀ(Ṁ − 2C)θ̇ = 0, the
//! conservation of energy.

use mozzi_examples::{agree, row, show};
use nalgebra::{DMatrix, DVector};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let model = mozzi_urdf::open("ur5")?.build()?;
    let theta = [0.3, -1.2, 1.4, -0.5, 0.9, 2.0];
    let dtheta = [0.5, -0.3, 0.8, 1.1, -0.6, 0.4];
    let form = model.closed_form(&theta, &dtheta, &model.environment())?;

    // the exercise
    let (A, G, W, L) = (&form.A, &form.G, &form.W, &form.L);
    let X = A.transpose() * L.transpose() * G * L * &form.ad_Adtheta * W * L * A;
    let dM = -(&X + X.transpose());

    // along the motion θ + hθ̇, by central differences
    let h = 1e-5;
    let at = |h: f64| -> Vec<f64> { theta.iter().zip(dtheta).map(|(theta, rate)| theta + h * rate).collect() };
    let differences = (model.mass_matrix(&at(h))? - model.mass_matrix(&at(-h))?) / (2.0 * h);

    show("Ṁ (kg m²/s)", &dM);
    agree("the exercise and the library's kernel", &dM, &model.mass_matrix_rate(&theta, &dtheta)?, 1e-13);
    agree("the exercise and central differences", &dM, &differences, 1e-8);

    let velocity = DVector::from_column_slice(&dtheta);
    let c = model.velocity_product(&theta, &dtheta)?;
    println!("\nc = [{}] N m", row(&c));
    let asymmetry = |C: &DMatrix<f64>| {
        let N = &dM - C * 2.0;
        (&N + N.transpose()).amax()
    };
    let christoffel = model.coriolis_matrix(&theta, &dtheta)?;
    let of_the_text = form.book_coriolis_matrix();
    agree("C of the Christoffel symbols: Cθ̇ = c", &(&christoffel * &velocity), &c, 1e-13);
    agree("C of the text's formula:      Cθ̇ = c", &(&of_the_text * &velocity), &c, 1e-13);

    println!("\nthe largest entry of N + Nᵀ, N = Ṁ − 2C, which is 0 when N is skew-symmetric:");
    println!("  C of the Christoffel symbols: {:.1e}", asymmetry(&christoffel));
    println!("  C of the text's formula:      {:.1e}", asymmetry(&of_the_text));
    assert!(asymmetry(&christoffel) < 1e-13 * dM.amax());
    assert!(asymmetry(&of_the_text) > 1e-2 * dM.amax());

    println!("θ̇ᵀNθ̇, 0 for both:");
    for (name, C) in [("the Christoffel symbols", &christoffel), ("the text's formula", &of_the_text)] {
        let power = velocity.dot(&((&dM - C * 2.0) * &velocity));
        println!("  {name}: {power:.1e}");
        assert!(power.abs() < 1e-13);
    }
    Ok(())
}
