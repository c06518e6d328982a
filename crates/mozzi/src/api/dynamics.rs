//! Inverse dynamics, its parts, and energies as methods.

use crate::dynamics as kernel;
use crate::model::{Environment, Error, FrameId, Model, Workspace};
use crate::spatial::{Twist, Wrench};
use alloc::vec;
use nalgebra::{DMatrix, DVector};

impl Model<f64> {
    /// τ = M(θ)θ̈ + c + g + JᵀF + f(θ̇): see [`inverse_dynamics`](kernel::inverse_dynamics()).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn inverse_dynamics(
        &self,
        theta: &[f64],
        dtheta: &[f64],
        ddtheta: &[f64],
        environment: &Environment,
    ) -> Result<DVector<f64>, Error> {
        self.check_lengths(theta, [("dtheta", dtheta), ("ddtheta", ddtheta)])?;
        self.check_environment(environment)?;
        Ok(self.vector(|w, tau| kernel::inverse_dynamics(self, theta, dtheta, ddtheta, environment, w, tau)))
    }

    /// h = c + g (+ JᵀF + the base's terms, where given): see [`bias_forces`](kernel::bias_forces()).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn bias_forces(&self, theta: &[f64], dtheta: &[f64], environment: &Environment) -> Result<DVector<f64>, Error> {
        self.check_lengths(theta, [("dtheta", dtheta)])?;
        self.check_environment(environment)?;
        Ok(self.vector(|w, h| kernel::bias_forces(self, theta, dtheta, environment, w, h)))
    }

    /// c(θ, θ̇): see [`velocity_product`](kernel::velocity_product).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn velocity_product(&self, theta: &[f64], dtheta: &[f64]) -> Result<DVector<f64>, Error> {
        self.check_lengths(theta, [("dtheta", dtheta)])?;
        Ok(self.vector(|w, c| kernel::velocity_product(self, theta, dtheta, w, c)))
    }

    /// g(θ) under the model's gravity: see [`gravity_forces`](kernel::gravity_forces).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn gravity_forces(&self, theta: &[f64]) -> Result<DVector<f64>, Error> {
        self.check_lengths(theta, [])?;
        Ok(self.vector(|w, g| kernel::gravity_forces(self, theta, self.gravity(), w, g)))
    }

    /// JᵀF of wrenches that frames apply to the environment: see [`tip_forces`](kernel::tip_forces).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn tip_forces(&self, theta: &[f64], applied: &[(FrameId, Wrench)]) -> Result<DVector<f64>, Error> {
        self.check_lengths(theta, [])?;
        applied.iter().try_for_each(|&(frame, _)| self.check_frame(frame))?;
        Ok(self.vector(|w, tau| kernel::tip_forces(self, theta, applied, w, tau)))
    }

    /// f(θ̇) = d θ̇ + μ sgn θ̇ of each joint, with sgn 0 = 0.
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn joint_friction(&self, dtheta: &[f64]) -> Result<DVector<f64>, Error> {
        self.check_velocities([("dtheta", dtheta)])?;
        Ok(DVector::from_fn(self.n(), |j, _| kernel::joint_friction(self, j, dtheta[j])))
    }

    /// M(θ): see [`mass_matrix`](kernel::mass_matrix()).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn mass_matrix(&self, theta: &[f64]) -> Result<DMatrix<f64>, Error> {
        self.check_lengths(theta, [])?;
        Ok(self.matrix(|w, M| kernel::mass_matrix(self, theta, w, M)))
    }

    /// Ṁ(θ, θ̇): see [`mass_matrix_rate`](kernel::mass_matrix_rate).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn mass_matrix_rate(&self, theta: &[f64], dtheta: &[f64]) -> Result<DMatrix<f64>, Error> {
        self.check_lengths(theta, [("dtheta", dtheta)])?;
        Ok(self.matrix(|w, dM| kernel::mass_matrix_rate(self, theta, dtheta, w, dM)))
    }

    /// C(θ, θ̇) of the Christoffel symbols: see [`coriolis_matrix`](kernel::coriolis_matrix()).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn coriolis_matrix(&self, theta: &[f64], dtheta: &[f64]) -> Result<DMatrix<f64>, Error> {
        self.check_lengths(theta, [("dtheta", dtheta)])?;
        Ok(self.matrix(|w, C| kernel::coriolis_matrix(self, theta, dtheta, w, C)))
    }

    /// ½ θ̇ᵀMθ̇, base at rest: see [`kinetic_energy`](kernel::kinetic_energy).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn kinetic_energy(&self, theta: &[f64], dtheta: &[f64]) -> Result<f64, Error> {
        self.check_lengths(theta, [("dtheta", dtheta)])?;
        Ok(kernel::kinetic_energy(self, theta, dtheta, Twist::zero(), &mut Workspace::new(self)))
    }

    /// −Σ m gᵀp under the model's gravity: see [`potential_energy`](kernel::potential_energy).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn potential_energy(&self, theta: &[f64]) -> Result<f64, Error> {
        self.check_lengths(theta, [])?;
        Ok(kernel::potential_energy(self, theta, self.gravity(), &mut Workspace::new(self)))
    }

    pub(super) fn vector(&self, fill: impl FnOnce(&mut Workspace, &mut [f64])) -> DVector<f64> {
        let mut entries = vec![0.0; self.n()];
        fill(&mut Workspace::new(self), &mut entries);
        DVector::from_vec(entries)
    }

    pub(super) fn matrix(&self, fill: impl FnOnce(&mut Workspace, &mut [f64])) -> DMatrix<f64> {
        let n = self.n();
        let mut entries = vec![0.0; n * n];
        fill(&mut Workspace::new(self), &mut entries);
        DMatrix::from_row_slice(n, n, &entries)
    }
}
