//! The ellipsoid of velocities of a frame's origin.

use super::{Call, Drawn, output};
use crate::request::Output;
use mozzi::nalgebra::{Matrix3, Vector3};
use mozzi::{Error, Freedom, Model, Place};

/// { J_v θ̇ : ‖θ̇‖ = 1 }, a floating base and free joints held. That of forces, { f : ‖J_vᵀf‖ = 1 }, has the semi-axes
/// 1/σ.
pub const VELOCITY_ELLIPSOID: Drawn = Drawn {
    name: "velocity_ellipsoid",
    formula: "the singular values σ of J_v, ascending, and their directions u in {s}, by rows: J_v of a frame's origin",
    inputs: &["theta"],
    of_frame: true,
    outputs,
    compute,
};

fn outputs(_: &Model) -> Vec<Output> {
    vec![output("sigma", [3], "m or 1"), output("u", [3, 3], "1")]
}

fn compute(call: &Call) -> Result<Vec<f64>, Error> {
    let (model, theta) = (call.model, call.inputs[0]);
    let Some(frame) = call.frame else { return Ok(vec![f64::NAN; 12]) }; // refused when it was requested
    let R = model.forward_kinematics(theta, frame)?.R;
    let J = model.body_jacobian(theta, frame)?;
    let driven = model.places().iter().filter(|place| place.freedom != Freedom::Free).flat_map(Place::velocities);
    let columns = driven.map(|j| Vector3::from((R * J.0[j].v).0));
    let gram = columns.fold(Matrix3::zeros(), |sum, v| sum + v * v.transpose()).symmetric_eigen();
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| gram.eigenvalues[a].total_cmp(&gram.eigenvalues[b]));
    let sigma = order.iter().map(|&k| gram.eigenvalues[k].max(0.0).sqrt());
    let directions = order.iter().flat_map(|&k| gram.eigenvectors.column(k).iter().copied().collect::<Vec<_>>());
    Ok(sigma.chain(directions).collect())
}
