//! Gradients of xᵀτ and xᵀθ̈, of the energies, of a frame's motion and of the momentum.

use crate::model::{Environment, Error, Model};
use crate::quantities::{self as q, vectors};
use alloc::vec::Vec;
use nalgebra::{DVector, Matrix6xX, Vector3};

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

/// The gradient of xᵀτ or xᵀθ̈ with respect to the robot's constants: see
/// [`inverse_dynamics_parameter_vjp`](crate::dynamics::inverse_dynamics_parameter_vjp()).
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterVjp {
    /// With respect to the [`parameters`](Model::parameters) π, in their order.
    pub d_parameters: DVector<f64>,
    /// With respect to the placement of each moving link's joint, a column (angular, linear) each, in the link's frame
    /// at θ = 0.
    pub d_placements: Matrix6xX<f64>,
    /// With respect to each joint's screw axis, with all links fixed at θ = 0.
    pub d_axes: Matrix6xX<f64>,
    /// With respect to gravity, in {s}.
    pub d_gravity: Vector3<f64>,
}

/// The gradients of the energies: see [`energy_gradients`](crate::dynamics::energy_gradients()).
#[derive(Clone, Debug, PartialEq)]
pub struct EnergyGradients {
    /// ∂𝒦/∂θ.
    pub kinetic_d_theta: DVector<f64>,
    /// ∂𝒦/∂θ̇.
    pub kinetic_d_dtheta: DVector<f64>,
    /// ∂𝒫/∂θ.
    pub potential_d_theta: DVector<f64>,
}

impl Model<f64> {
    /// xᵀ∂τ/∂θ, xᵀ∂τ/∂θ̇ and xᵀ∂τ/∂θ̈ in O(n): see [`inverse_dynamics_vjp`](crate::dynamics::inverse_dynamics_vjp()).
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

    /// xᵀ∂θ̈/∂θ, xᵀ∂θ̈/∂θ̇ and xᵀ∂θ̈/∂τ in O(n): see [`forward_dynamics_vjp`](crate::dynamics::forward_dynamics_vjp()).
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

    /// The gradient of xᵀτ by the robot in O(n): see
    /// [`inverse_dynamics_parameter_vjp`](crate::dynamics::inverse_dynamics_parameter_vjp()).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn inverse_dynamics_parameter_vjp(
        &self,
        theta: &[f64],
        dtheta: &[f64],
        ddtheta: &[f64],
        x: &[f64],
        environment: &Environment,
    ) -> Result<ParameterVjp, Error> {
        self.compute(q::InverseDynamicsParameterVjp, &[theta, dtheta, ddtheta, x], environment).map(by_robot)
    }

    /// The gradient of xᵀθ̈ by the robot in O(n): see
    /// [`forward_dynamics_parameter_vjp`](crate::dynamics::forward_dynamics_parameter_vjp()).
    ///
    /// # Errors
    /// [`Error::WrongLength`], and [`Error::SingularMassMatrix`] naming the joint.
    pub fn forward_dynamics_parameter_vjp(
        &self,
        theta: &[f64],
        dtheta: &[f64],
        tau: &[f64],
        x: &[f64],
        environment: &Environment,
    ) -> Result<ParameterVjp, Error> {
        self.compute(q::ForwardDynamicsParameterVjp, &[theta, dtheta, tau, x], environment).map(by_robot)
    }

    /// ∂𝒦/∂θ, ∂𝒦/∂θ̇ and ∂𝒫/∂θ: see [`energy_gradients`](crate::dynamics::energy_gradients()).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn energy_gradients(
        &self,
        theta: &[f64],
        dtheta: &[f64],
        environment: &Environment,
    ) -> Result<EnergyGradients, Error> {
        let found = self.compute(q::EnergyGradients, &[theta, dtheta], environment)?;
        let [kinetic_d_theta, kinetic_d_dtheta, potential_d_theta] = vectors(found);
        Ok(EnergyGradients { kinetic_d_theta, kinetic_d_dtheta, potential_d_theta })
    }
}

fn by_robot(found: Vec<Vec<f64>>) -> ParameterVjp {
    let [d_parameters, placements, axes, gravity] = vectors(found);
    let six = |list: DVector<f64>| Matrix6xX::from_column_slice(list.as_slice());
    let d_gravity = Vector3::from_column_slice(gravity.as_slice());
    ParameterVjp { d_parameters, d_placements: six(placements), d_axes: six(axes), d_gravity }
}
