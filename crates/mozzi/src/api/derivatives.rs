//! The derivatives of inverse and forward dynamics, and of the parts of τ, as methods.

use crate::dynamics as kernel;
use crate::model::{Environment, Error, FrameId, Model, Workspace};
use crate::spatial::Wrench;
use alloc::vec;
use nalgebra::{DMatrix, DVector};

/// The derivatives of τ, each n × n, row i being τ_i's; by θ along the velocities: of a floating base along its body twist.
#[derive(Clone, Debug, PartialEq)]
pub struct InverseDynamicsDerivatives {
    /// ∂τ/∂θ.
    pub d_theta: DMatrix<f64>,
    /// ∂τ/∂θ̇.
    pub d_dtheta: DMatrix<f64>,
    /// ∂τ/∂θ̈ = M(θ).
    pub d_ddtheta: DMatrix<f64>,
}

/// θ̈ and its derivatives, each n × n, row i being θ̈_i's; by θ along the velocities: of a floating base along its body twist.
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
    /// ∂τ/∂θ, ∂τ/∂θ̇ and ∂τ/∂θ̈ = M: see [`inverse_dynamics_derivatives`](kernel::inverse_dynamics_derivatives()).
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
        self.check_lengths(theta, [("dtheta", dtheta), ("ddtheta", ddtheta)])?;
        self.check_environment(environment)?;
        let [d_theta, d_dtheta, d_ddtheta] = self.three_matrices(|w, derivatives| {
            kernel::inverse_dynamics_derivatives(self, theta, dtheta, ddtheta, environment, w, derivatives);
            Ok(())
        })?;
        Ok(InverseDynamicsDerivatives { d_theta, d_dtheta, d_ddtheta })
    }

    /// θ̈, ∂θ̈/∂θ, ∂θ̈/∂θ̇ and ∂θ̈/∂τ = M⁻¹: see [`forward_dynamics_derivatives`](kernel::forward_dynamics_derivatives()).
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
        self.check_lengths(theta, [("dtheta", dtheta), ("tau", tau)])?;
        self.check_environment(environment)?;
        let mut ddtheta = DVector::zeros(self.n());
        let x = ddtheta.as_mut_slice();
        let [d_theta, d_dtheta, d_tau] = self.three_matrices(|w, derivatives| {
            kernel::forward_dynamics_derivatives(self, theta, dtheta, tau, environment, w, x, derivatives);
            self.check_pivots(theta, w)
        })?;
        Ok(ForwardDynamicsDerivatives { ddtheta, d_theta, d_dtheta, d_tau })
    }

    /// ∂g/∂θ under the model's gravity: see [`gravity_forces_derivative`](kernel::gravity_forces_derivative).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn gravity_forces_derivative(&self, theta: &[f64]) -> Result<DMatrix<f64>, Error> {
        self.check_lengths(theta, [])?;
        Ok(self.matrix(|w, dg| kernel::gravity_forces_derivative(self, theta, self.gravity(), w, dg)))
    }

    /// ∂(JᵀF)/∂θ of wrenches that frames apply to the environment: see [`tip_forces_derivative`](kernel::tip_forces_derivative).
    ///
    /// # Errors
    /// [`Error::WrongLength`]; [`Error::BadArgument`] for a frame of another model.
    pub fn tip_forces_derivative(&self, theta: &[f64], applied: &[(FrameId, Wrench)]) -> Result<DMatrix<f64>, Error> {
        self.check_lengths(theta, [])?;
        applied.iter().try_for_each(|&(frame, _)| self.check_frame(frame))?;
        Ok(self.matrix(|w, dtau| kernel::tip_forces_derivative(self, theta, applied, w, dtau)))
    }

    /// ∂(M(θ)x)/∂θ for a constant x: see [`mass_matrix_product_derivative`](kernel::mass_matrix_product_derivative).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn mass_matrix_product_derivative(&self, theta: &[f64], x: &[f64]) -> Result<DMatrix<f64>, Error> {
        self.check_lengths(theta, [("x", x)])?;
        Ok(self.matrix(|w, dMx| kernel::mass_matrix_product_derivative(self, theta, x, w, dMx)))
    }

    fn three_matrices(
        &self,
        fill: impl FnOnce(&mut Workspace, [&mut [f64]; 3]) -> Result<(), Error>,
    ) -> Result<[DMatrix<f64>; 3], Error> {
        let n = self.n();
        let mut rows = [vec![0.0; n * n], vec![0.0; n * n], vec![0.0; n * n]];
        fill(&mut Workspace::new(self), rows.each_mut().map(|matrix| &mut matrix[..]))?;
        Ok(rows.map(|entries| DMatrix::from_row_slice(n, n, &entries)))
    }
}
