//! Gradients of xᵀτ and xᵀθ̈.

use crate::model::{Environment, Error, Model};
use crate::quantities as q;
use alloc::vec::Vec;
use nalgebra::DVector;

/// A vector x times the derivatives of τ, n numbers each: the gradient of xᵀτ. Derivatives with respect to θ are
/// along the velocities: for a floating base, along its body twist.
#[derive(Clone, Debug, PartialEq)]
pub struct InverseDynamicsVjp {
    /// xᵀ∂τ/∂θ.
    pub d_theta: DVector<f64>,
    /// xᵀ∂τ/∂θ̇.
    pub d_dtheta: DVector<f64>,
    /// xᵀ∂τ/∂θ̈ = M(θ)x.
    pub d_ddtheta: DVector<f64>,
}

/// A vector x times the derivatives of θ̈, n numbers each: the gradient of xᵀθ̈. Derivatives with respect to θ are
/// along the velocities: for a floating base, along its body twist.
#[derive(Clone, Debug, PartialEq)]
pub struct ForwardDynamicsVjp {
    /// xᵀ∂θ̈/∂θ.
    pub d_theta: DVector<f64>,
    /// xᵀ∂θ̈/∂θ̇.
    pub d_dtheta: DVector<f64>,
    /// xᵀ∂θ̈/∂τ = M(θ)⁻¹x.
    pub d_tau: DVector<f64>,
}

impl Model<f64> {
    /// xᵀ∂τ/∂θ, xᵀ∂τ/∂θ̇ and xᵀ∂τ/∂θ̈ in O(n): see [`inverse_dynamics_vjp`](crate::inverse_dynamics_vjp()).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn inverse_dynamics_vjp(
        &self,
        theta: &[f64],
        dtheta: &[f64],
        ddtheta: &[f64],
        x: &[f64],
        environment: &Environment,
    ) -> Result<InverseDynamicsVjp, Error> {
        let found = self.compute(q::InverseDynamicsVjp, &[theta, dtheta, ddtheta, x], environment)?;
        let [d_theta, d_dtheta, d_ddtheta] = vectors(found);
        Ok(InverseDynamicsVjp { d_theta, d_dtheta, d_ddtheta })
    }

    /// xᵀ∂θ̈/∂θ, xᵀ∂θ̈/∂θ̇ and xᵀ∂θ̈/∂τ in O(n): see [`forward_dynamics_vjp`](crate::forward_dynamics_vjp()).
    ///
    /// # Errors
    /// [`Error::WrongLength`], and [`Error::SingularMassMatrix`] naming the joint.
    pub fn forward_dynamics_vjp(
        &self,
        theta: &[f64],
        dtheta: &[f64],
        tau: &[f64],
        x: &[f64],
        environment: &Environment,
    ) -> Result<ForwardDynamicsVjp, Error> {
        let found = self.compute(q::ForwardDynamicsVjp, &[theta, dtheta, tau, x], environment)?;
        let [d_theta, d_dtheta, d_tau] = vectors(found);
        Ok(ForwardDynamicsVjp { d_theta, d_dtheta, d_tau })
    }
}

fn vectors<const K: usize>(found: Vec<Vec<f64>>) -> [DVector<f64>; K] {
    let mut found = found.into_iter();
    core::array::from_fn(|_| DVector::from_vec(found.next().unwrap_or_default()))
}
