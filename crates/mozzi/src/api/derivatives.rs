//! The derivatives of inverse and forward dynamics, and of the parts of τ, as methods.

use crate::model::{Environment, Error, FrameId, Model};
use crate::quantities as q;
use crate::spatial::Wrench;
use nalgebra::{DMatrix, DVector};

/// The derivatives of τ, each n × n with row i for τ_i. Derivatives with respect to θ are along the velocities: for a
/// floating base, along its body twist.
#[derive(Clone, Debug, PartialEq)]
pub struct InverseDynamicsDerivatives {
    /// ∂τ/∂θ.
    pub d_theta: DMatrix<f64>,
    /// ∂τ/∂θ̇.
    pub d_dtheta: DMatrix<f64>,
    /// ∂τ/∂θ̈ = M(θ).
    pub d_ddtheta: DMatrix<f64>,
}

/// θ̈ and its derivatives, each n × n with row i for θ̈_i. Derivatives with respect to θ are along the velocities: for
/// a floating base, along its body twist.
#[derive(Clone, Debug, PartialEq)]
pub struct ForwardDynamicsDerivatives {
    /// θ̈ itself.
    pub ddtheta: DVector<f64>,
    /// ∂θ̈/∂θ.
    pub d_theta: DMatrix<f64>,
    /// ∂θ̈/∂θ̇.
    pub d_dtheta: DMatrix<f64>,
    /// ∂θ̈/∂τ = M(θ)⁻¹.
    pub d_tau: DMatrix<f64>,
}

impl Model<f64> {
    /// ∂τ/∂θ, ∂τ/∂θ̇ and ∂τ/∂θ̈ = M: see
    /// [`inverse_dynamics_derivatives`](crate::dynamics::inverse_dynamics_derivatives()).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn inverse_dynamics_derivatives(
        &self,
        theta: &[f64],
        dtheta: &[f64],
        ddtheta: &[f64],
        environment: &Environment,
    ) -> Result<InverseDynamicsDerivatives, Error> {
        let found = self.compute(q::InverseDynamicsDerivatives, &[theta, dtheta, ddtheta], environment)?;
        let mut found = found.iter().map(|entries| self.rows(entries));
        let mut next = || found.next().expect("three matrices");
        Ok(InverseDynamicsDerivatives { d_theta: next(), d_dtheta: next(), d_ddtheta: next() })
    }

    /// θ̈, ∂θ̈/∂θ, ∂θ̈/∂θ̇ and ∂θ̈/∂τ = M⁻¹: see
    /// [`forward_dynamics_derivatives`](crate::dynamics::forward_dynamics_derivatives()).
    ///
    /// # Errors
    /// [`Error::WrongLength`], and [`Error::SingularMassMatrix`] naming the joint.
    pub fn forward_dynamics_derivatives(
        &self,
        theta: &[f64],
        dtheta: &[f64],
        tau: &[f64],
        environment: &Environment,
    ) -> Result<ForwardDynamicsDerivatives, Error> {
        let mut found = self.compute(q::ForwardDynamicsDerivatives, &[theta, dtheta, tau], environment)?;
        let ddtheta = DVector::from_vec(found.remove(0));
        let mut found = found.iter().map(|entries| self.rows(entries));
        let mut next = || found.next().expect("three matrices");
        Ok(ForwardDynamicsDerivatives { ddtheta, d_theta: next(), d_dtheta: next(), d_tau: next() })
    }

    /// ∂g/∂θ under the model's gravity: see [`gravity_forces_derivative`](crate::dynamics::gravity_forces_derivative).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn gravity_forces_derivative(&self, theta: &[f64]) -> Result<DMatrix<f64>, Error> {
        self.matrix(q::GravityForcesDerivative, &[theta], &self.environment())
    }

    /// ∂(JᵀF)/∂θ for wrenches that frames apply to the environment: see
    /// [`tip_forces_derivative`](crate::dynamics::tip_forces_derivative).
    ///
    /// # Errors
    /// [`Error::WrongLength`]; [`Error::BadArgument`] for a frame of another model.
    pub fn tip_forces_derivative(&self, theta: &[f64], applied: &[(FrameId, Wrench)]) -> Result<DMatrix<f64>, Error> {
        self.matrix(q::TipForcesDerivative, &[theta], &Environment { applied, ..self.environment() })
    }

    /// ∂(M(θ)x)/∂θ for a constant x: see
    /// [`mass_matrix_product_derivative`](crate::dynamics::mass_matrix_product_derivative).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn mass_matrix_product_derivative(&self, theta: &[f64], x: &[f64]) -> Result<DMatrix<f64>, Error> {
        self.matrix(q::MassMatrixProductDerivative, &[theta, x], &self.environment())
    }
}
