//! Quantities of a robot as machine code: `Model.compile`.

use crate::describe::refused;
use crate::failure::of_model;
use crate::quantity::{Quantity, jacobian_rows};
use mozzi::{Error, FrameId, Model};
use mozzi_codegen::{Compiled, Engine, Quantity as Coded};
use pyo3::prelude::*;

/// What can be asked for by name.
const NAMES: [&str; 11] = [
    "inverse_dynamics",
    "forward_dynamics",
    "mass_matrix",
    "bias_forces",
    "velocity_product",
    "gravity_forces",
    "forward_kinematics",
    "space_jacobian",
    "body_jacobian",
    "inverse_dynamics_derivatives",
    "forward_dynamics_derivatives",
];

/// The quantity of this name.
pub fn named(model: &Model, name: &str, frame: Result<FrameId, Error>) -> PyResult<Coded> {
    Ok(match name {
        "inverse_dynamics" => Coded::InverseDynamics,
        "forward_dynamics" => Coded::ForwardDynamics,
        "mass_matrix" => Coded::MassMatrix,
        "bias_forces" => Coded::BiasForces,
        "velocity_product" => Coded::VelocityProduct,
        "gravity_forces" => Coded::GravityForces,
        "forward_kinematics" => Coded::ForwardKinematics(frame.map_err(of_model)?),
        "space_jacobian" => Coded::SpaceJacobian(frame.map_err(of_model)?),
        "body_jacobian" => Coded::BodyJacobian(frame.map_err(of_model)?),
        "inverse_dynamics_derivatives" => Coded::InverseDynamicsDerivatives,
        "forward_dynamics_derivatives" => Coded::ForwardDynamicsDerivatives,
        _ => {
            let (robot, names) = (&model.description().name, NAMES.join("', '"));
            return Err(refused(format!("'{name}' of '{robot}' cannot be compiled, expected one of '{names}'")));
        }
    })
}

/// As machine code has it.
fn coded(quantity: Quantity) -> Option<Coded> {
    Some(match quantity {
        Quantity::InverseDynamics => Coded::InverseDynamics,
        Quantity::ForwardDynamics => Coded::ForwardDynamics,
        Quantity::MassMatrix => Coded::MassMatrix,
        Quantity::BiasForces => Coded::BiasForces,
        Quantity::VelocityProduct => Coded::VelocityProduct,
        Quantity::GravityForces => Coded::GravityForces,
        Quantity::ForwardKinematics(frame) => Coded::ForwardKinematics(frame),
        Quantity::SpaceJacobian(frame) => Coded::SpaceJacobian(frame),
        Quantity::BodyJacobian(frame) => Coded::BodyJacobian(frame),
        Quantity::InverseDynamicsDerivatives => Coded::InverseDynamicsDerivatives,
        Quantity::ForwardDynamicsDerivatives => Coded::ForwardDynamicsDerivatives,
        _ => return None,
    })
}

/// The quantity at one state by machine code; false where there is none. Lengths were checked, and what surrounds the robot is its own.
///
/// # Errors
/// As of the model's method.
pub fn one(compiled: &Compiled, quantity: Quantity, s: &[&[f64]], out: &mut [&mut [f64]]) -> Result<bool, Error> {
    let Some(coded) = coded(quantity) else { return Ok(false) };
    if !matches!(compiled.engine(coded), Engine::MachineCode(..)) {
        return Ok(false);
    }
    if compiled.model().is_floating() {
        compiled.model().check_configuration(s[0])?;
    }
    match coded {
        Coded::ForwardDynamics => out[0].copy_from_slice(compiled.forward_dynamics(s[0], s[1], s[2])?.as_slice()),
        Coded::ForwardKinematics(frame) => {
            out[0].copy_from_slice(compiled.forward_kinematics(s[0], frame)?.to_matrix().as_flattened());
        }
        Coded::SpaceJacobian(frame) => jacobian_rows(&compiled.space_jacobian(s[0], frame)?.0, out[0]),
        Coded::BodyJacobian(frame) => jacobian_rows(&compiled.body_jacobian(s[0], frame)?.0, out[0]),
        Coded::ForwardDynamicsDerivatives => return Ok(false), // its pivots are looked at by the kernels' way
        _ => compiled.evaluate(coded, s, out),
    }
    Ok(true)
}

/// The quantity at many states by machine code; `None` where there is none.
pub fn many(
    compiled: &Compiled,
    quantity: Quantity,
    s: &[&[f64]],
    out: &mut [&mut [f64]],
) -> Option<Result<(), mozzi_batch::Error>> {
    Some(match (quantity, out) {
        (Quantity::InverseDynamics, [x]) => compiled.inverse_dynamics_batch(s[0], s[1], s[2], x),
        (Quantity::ForwardDynamics, [x]) => compiled.forward_dynamics_batch(s[0], s[1], s[2], x),
        (Quantity::BiasForces, [x]) => compiled.bias_forces_batch(s[0], s[1], x),
        (Quantity::VelocityProduct, [x]) => compiled.velocity_product_batch(s[0], s[1], x),
        (Quantity::MassMatrix, [x]) => compiled.mass_matrix_batch(s[0], x),
        (Quantity::InverseDynamicsDerivatives, [x, y, z]) => {
            compiled.inverse_dynamics_derivatives_batch(s[0], s[1], s[2], x, y, z)
        }
        (Quantity::ForwardDynamicsDerivatives, [x, y, z, w]) => {
            compiled.forward_dynamics_derivatives_batch(s[0], s[1], s[2], x, y, z, w)
        }
        _ => return None,
    })
}
