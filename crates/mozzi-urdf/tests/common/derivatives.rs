//! Derivatives and the regressor, compared with Pinocchio's.

use super::{Worst, column, matrix};
use mozzi::Model;
use mozzi::conventions::Pinocchio;
use nalgebra::DMatrix;
use serde_json::Value;

/// Compares those that the state contains; `velocities` are mozzi's indices of the oracle's velocities.
pub fn compare(
    model: &Model,
    velocities: &[usize],
    [theta, dtheta, ddtheta, tau]: [&[f64]; 4],
    oracle: &Value,
    state: &Value,
    worst: &mut Worst,
) {
    let environment = model.environment();
    let theirs = |X: &DMatrix<f64>| DMatrix::from_fn(X.nrows(), X.ncols(), |i, j| X[(velocities[i], velocities[j])]);
    if state.get("dtau_dq").is_some() {
        let mine = model.inverse_dynamics_derivatives(theta, dtheta, ddtheta, &environment).unwrap();
        worst.add("∂τ/∂θ", &theirs(&mine.d_theta), &matrix(&state["dtau_dq"]), 0.0);
        worst.add("∂τ/∂θ̇", &theirs(&mine.d_dtheta), &matrix(&state["dtau_dv"]), 0.0);
    }
    if state.get("ddq_dq").is_some() {
        // backward error: M times the difference, relative to the size of M's products with it; for derivatives by θ
        // also relative to the uncertainty of θ̈ (M⁻¹ times τ's rounding) times ∂M/∂θ, which is as large as M
        let M = theirs(&model.mass_matrix(theta).unwrap());
        let mine = model.forward_dynamics_derivatives(theta, dtheta, tau, &environment).unwrap();
        let largest = tau.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let of_ddtheta = M.amax() * mine.d_tau.amax() * largest;
        let by = [
            ("∂θ̈/∂θ", mine.d_theta, "ddq_dq", of_ddtheta),
            ("∂θ̈/∂θ̇", mine.d_dtheta, "ddq_dv", 0.0),
            ("M⁻¹", mine.d_tau, "Minv", 0.0),
        ];
        for (what, mine, key, size) in by {
            let (mine, reference) = (theirs(&mine), matrix(&state[key]));
            worst.add(what, &(&M * mine), &(&M * &reference), M.amax() * reference.amax() + size);
        }
    }
    if state.get("regressor").is_some() {
        let reference = matrix(&state["regressor"]);
        let mine = model.regressor(theta, dtheta, ddtheta, &environment).unwrap();
        let bodies = bodies(model, oracle);
        assert_eq!(reference.ncols(), 10 * bodies.len());
        for (k, body) in bodies.into_iter().enumerate() {
            for (i, &row) in velocities.iter().enumerate() {
                let columns: [f64; 10] = core::array::from_fn(|c| mine[(row, 10 * body + c)]);
                let columns = column(&Pinocchio::body_parameters(columns));
                let reference = reference.view((i, 10 * k), (1, 10)).transpose();
                worst.add("Y", &columns, &reference, reference.amax().max(mine.row(row).amax()));
            }
        }
    }
}

/// mozzi's index of each of the oracle's bodies: a floating base, and the body that each joint moves, including mimic
/// joints.
fn bodies(model: &Model, oracle: &Value) -> Vec<usize> {
    let base = usize::from(model.is_floating());
    let of =
        |name: &Value| base + model.moving_joints().position(|joint| Some(&joint.name[..]) == name.as_str()).unwrap();
    (0..base).chain(oracle["bodies"].as_array().unwrap().iter().map(of)).collect()
}
