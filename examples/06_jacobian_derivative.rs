//! Derivatives of the Jacobian's columns (Modern Robotics, exercise 8.6).
//!
//! The space Jacobian's column i is the screw axis S_i carried along by the joints before it,
//!
//! > J_i = Ad_P S_i with P = e^{[S_1]θ_1} ⋯ e^{[S_{i−1}]θ_{i−1}}.
//!
//! A change of θ_j, j < i, moves everything beyond joint j about its present axis J_j: P becomes e^{[J_j]δ}P, and the
//! derivative of Ad_{e^{[V]δ}} at δ = 0 is ad_V. The joints from i on do not move axis i:
//!
//! > ∂J_i/∂θ_j = ad_{J_j}(J_i) for j < i, 0 for j ≥ i        (space)
//!
//! The body Jacobian's column is J_i = Ad_Q B_i, Q = e^{−[B_n]θ_n} ⋯ e^{−[B_{i+1}]θ_{i+1}}: seen from the end
//! effector the joints beyond it move axis i, and backwards, −ad_{J_j}(J_i):
//!
//! > ∂J_i/∂θ_j = ad_{J_i}(J_j) for j > i, 0 for j ≤ i        (body)
//!
//! The rates are J̇ = Σ_j ∂J/∂θ_j θ̇_j.

use mozzi::{Error as ModelError, Jacobian, Model, Twist};
use mozzi_examples::{agree, row};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let model = mozzi_urdf::open("ur5")?.build()?;
    let (n, tool) = (model.n(), model.end_effector()?);
    let theta = [0.3, -1.2, 1.4, -0.5, 0.9, 2.0];
    let dtheta = [0.5, -0.3, 0.8, 1.1, -0.6, 0.4];

    let space = model.space_jacobian(&theta, tool)?.0;
    let body = model.body_jacobian(&theta, tool)?.0;
    let by_hand_space = derivative(n, |i, j| if j < i { space[j].ad() * space[i] } else { Twist::zero() });
    let by_hand_body = derivative(n, |i, j| if j > i { body[i].ad() * body[j] } else { Twist::zero() });
    println!("UR5, θ = {theta:?}; for instance");
    println!("  ∂J_s5/∂θ_2 = ({})", row(&by_hand_space[1].0[4].to_array()));
    println!("  ∂J_b2/∂θ_5 = ({})\n", row(&by_hand_body[4].0[1].to_array()));

    let library = model.space_jacobian_derivative(&theta, tool)?;
    agree("space, by hand and by the library", &flat(&by_hand_space), &flat(&library), 1e-14);
    let differences = central(&model, &theta, |theta| model.space_jacobian(theta, tool))?;
    agree("space, by hand and by central differences", &flat(&by_hand_space), &flat(&differences), 1e-9);

    let library = model.body_jacobian_derivative(&theta, tool)?;
    agree("body, by hand and by the library", &flat(&by_hand_body), &flat(&library), 1e-14);
    let differences = central(&model, &theta, |theta| model.body_jacobian(theta, tool))?;
    agree("body, by hand and by central differences", &flat(&by_hand_body), &flat(&differences), 1e-9);

    let rate = |list: &[Jacobian]| -> Vec<f64> {
        let column = |i: usize| (0..n).fold(Twist::zero(), |sum, j| sum + list[j].0[i] * dtheta[j]);
        (0..n).flat_map(|i| column(i).to_array()).collect()
    };
    let found = [model.space_jacobian_rate(&theta, &dtheta, tool)?];
    agree("rate of the space Jacobian", &flat(&found), &rate(&by_hand_space), 1e-14);
    let found = [model.body_jacobian_rate(&theta, &dtheta, tool)?];
    agree("rate of the body Jacobian", &flat(&found), &rate(&by_hand_body), 1e-14);
    Ok(())
}

/// For each j, the Jacobian whose column i is ∂J_i/∂θ_j.
fn derivative(n: usize, entry: impl Fn(usize, usize) -> Twist) -> Vec<Jacobian> {
    (0..n).map(|j| Jacobian((0..n).map(|i| entry(i, j)).collect())).collect()
}

/// (J(θ + he_j) − J(θ − he_j)) / 2h for each j.
fn central(
    model: &Model,
    theta: &[f64],
    J: impl Fn(&[f64]) -> Result<Jacobian, ModelError>,
) -> Result<Vec<Jacobian>, ModelError> {
    let h = 1e-5;
    let at = |j: usize, step: f64| {
        let mut moved = theta.to_vec();
        moved[j] += step;
        J(&moved)
    };
    let quotient = |j: usize| -> Result<Jacobian, ModelError> {
        let (after, before) = (at(j, h)?, at(j, -h)?);
        Ok(Jacobian(after.0.iter().zip(&before.0).map(|(&a, &b)| (a - b) * (0.5 / h)).collect()))
    };
    (0..model.n()).map(quotient).collect()
}

fn flat(list: &[Jacobian]) -> Vec<f64> {
    list.iter().flat_map(|J| &J.0).flat_map(|column| column.to_array()).collect()
}
