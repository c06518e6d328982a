//! The inverse of the mass matrix, from the factors of M along the tree (Featherstone 2008, section 6.5).

use super::mass_matrix::mass_matrix;
use crate::linalg::ldlt;
use crate::model::Model;
use crate::quantities::{Call, Declaration, Kernel, MATRIX, Quantity, THETA, symmetric};
use crate::scalar::Scalar;
use crate::workspace::Workspace;

/// M(θ)⁻¹, symmetric, n × n, row-major into `inverse`: the accelerations produced by a unit force at each joint. 1/(kg
/// m²), 1/(kg m) or 1/kg.
///
/// If M is singular, the result is infinite, NaN or meaningless: the methods of [`Model`] check the pivots.
///
/// Cost O(n² · depth), no allocation.
///
/// # Panics
/// When θ is not nq long, or `inverse` not n².
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn mass_matrix_inverse<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    workspace: &mut Workspace<S>,
    inverse: &mut [S],
) {
    let pattern = &model.structure.pattern;
    mass_matrix(model, theta, workspace, inverse);
    ldlt::factor(pattern, inverse, &mut workspace.pivots);
    ldlt::invert(pattern, inverse, &mut workspace.vector);
}

/// See [`mass_matrix_inverse`].
#[derive(Clone, Copy, Debug)]
pub struct MassMatrixInverse;
impl Quantity for MassMatrixInverse {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "mass_matrix_inverse",
        "M(θ)⁻¹, the accelerations that a unit of each joint force produces",
        &[THETA],
        &[symmetric("inverse", MATRIX, "1/(kg m²), 1/(kg m) or 1/kg")],
    )
    .divides();
}
impl Kernel for MassMatrixInverse {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, ..], [inverse, ..]) = (c.inputs, c.outputs);
        mass_matrix_inverse(c.model, theta, &mut c.memory.workspace, inverse);
    }
}
