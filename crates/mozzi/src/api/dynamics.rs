//! Inverse dynamics, its parts, and energies as methods.

use crate::dynamics::set_armature;
use crate::model::{Environment, Error, FrameId, Model};
use crate::quantities::{self as q, Query};
use crate::spatial::Wrench;
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector};

impl Model<f64> {
    /// τ = M(θ)θ̈ + c + g + JᵀF + f(θ, θ̇): see [`inverse_dynamics`](crate::dynamics::inverse_dynamics()).
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
        self.vector(q::InverseDynamics, &[theta, dtheta, ddtheta], environment)
    }

    /// h = c + g (+ JᵀF + the base's terms, if given): see [`bias_forces`](crate::dynamics::bias_forces()).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn bias_forces(&self, theta: &[f64], dtheta: &[f64], environment: &Environment) -> Result<DVector<f64>, Error> {
        self.vector(q::BiasForces, &[theta, dtheta], environment)
    }

    /// c(θ, θ̇): see [`velocity_product`](crate::dynamics::velocity_product).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn velocity_product(&self, theta: &[f64], dtheta: &[f64]) -> Result<DVector<f64>, Error> {
        self.vector(q::VelocityProduct, &[theta, dtheta], &self.environment())
    }

    /// g(θ) under the model's gravity: see [`gravity_forces`](crate::dynamics::gravity_forces).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn gravity_forces(&self, theta: &[f64]) -> Result<DVector<f64>, Error> {
        self.vector(q::GravityForces, &[theta], &self.environment())
    }

    /// JᵀF for wrenches that frames apply to the environment: see [`tip_forces`](crate::dynamics::tip_forces).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn tip_forces(&self, theta: &[f64], applied: &[(FrameId, Wrench)]) -> Result<DVector<f64>, Error> {
        self.vector(q::TipForces, &[theta], &Environment { applied, ..self.environment() })
    }

    /// f(θ̇) = d θ̇ + μ sgn θ̇ of each joint, with sgn 0 = 0.
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn joint_friction(&self, dtheta: &[f64]) -> Result<DVector<f64>, Error> {
        self.vector(q::JointFriction, &[dtheta], &self.environment())
    }

    /// The rotors' part of M, n × n and constant: on the diagonal Σ ratio² armature of each joint and its mimic joints
    /// (0 for a floating base), and a JᵀJ for each rotor that several joints turn, with the row J of its gear ratios.
    /// kg m² or kg.
    pub fn armature_matrix(&self) -> DMatrix<f64> {
        let mut M = DMatrix::zeros(self.n(), self.n());
        set_armature(self, M.as_mut_slice());
        M
    }

    /// f_s(θ) = k(θ − θ₀): see [`spring_forces`](crate::dynamics::spring_forces()).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn spring_forces(&self, theta: &[f64]) -> Result<DVector<f64>, Error> {
        self.vector(q::SpringForces, &[theta], &self.environment())
    }

    /// M(θ): see [`mass_matrix`](crate::dynamics::mass_matrix()).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn mass_matrix(&self, theta: &[f64]) -> Result<DMatrix<f64>, Error> {
        self.matrix(q::MassMatrix, &[theta], &self.environment())
    }

    /// Ṁ(θ, θ̇): see [`mass_matrix_rate`](crate::dynamics::mass_matrix_rate).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn mass_matrix_rate(&self, theta: &[f64], dtheta: &[f64]) -> Result<DMatrix<f64>, Error> {
        self.matrix(q::MassMatrixRate, &[theta, dtheta], &self.environment())
    }

    /// C(θ, θ̇) of the Christoffel symbols: see [`coriolis_matrix`](crate::dynamics::coriolis_matrix()).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn coriolis_matrix(&self, theta: &[f64], dtheta: &[f64]) -> Result<DMatrix<f64>, Error> {
        self.matrix(q::CoriolisMatrix, &[theta, dtheta], &self.environment())
    }

    /// ½ θ̇ᵀMθ̇, base at rest: see [`kinetic_energy`](crate::dynamics::kinetic_energy).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn kinetic_energy(&self, theta: &[f64], dtheta: &[f64]) -> Result<f64, Error> {
        Ok(self.first(q::KineticEnergy, &[theta, dtheta], &self.environment())?[0])
    }

    /// −Σ m gᵀp under the model's gravity: see [`potential_energy`](crate::dynamics::potential_energy).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn potential_energy(&self, theta: &[f64]) -> Result<f64, Error> {
        Ok(self.first(q::PotentialEnergy, &[theta], &self.environment())?[0])
    }

    /// The first output of a quantity.
    pub(super) fn first<'q>(
        &self,
        query: impl Into<Query<'q>>,
        inputs: &[&[f64]],
        environment: &Environment,
    ) -> Result<Vec<f64>, Error> {
        Ok(self.compute(query, inputs, environment)?.swap_remove(0))
    }

    pub(super) fn vector<'q>(
        &self,
        query: impl Into<Query<'q>>,
        inputs: &[&[f64]],
        environment: &Environment,
    ) -> Result<DVector<f64>, Error> {
        Ok(DVector::from_vec(self.first(query, inputs, environment)?))
    }

    /// The first output, with n columns.
    pub(super) fn matrix<'q>(
        &self,
        query: impl Into<Query<'q>>,
        inputs: &[&[f64]],
        environment: &Environment,
    ) -> Result<DMatrix<f64>, Error> {
        Ok(self.rows(&self.first(query, inputs, environment)?))
    }

    /// A matrix of n columns from its rows.
    pub(super) fn rows(&self, entries: &[f64]) -> DMatrix<f64> {
        let columns = self.n();
        DMatrix::from_row_slice(entries.len().checked_div(columns).unwrap_or(0), columns, entries)
    }
}
