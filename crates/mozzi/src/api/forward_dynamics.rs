//! Forward dynamics as methods: three algorithms, one rule for pivots.

use crate::model::{Environment, Error, Model};
use crate::quantities as q;
use nalgebra::DVector;

impl Model<f64> {
    /// θ̈ from τ: by articulated bodies, or by the mass matrix (see
    /// [`solves_by_mass_matrix`](Self::solves_by_mass_matrix)). See
    /// [`forward_dynamics`](crate::dynamics::forward_dynamics()).
    ///
    /// # Errors
    /// [`Error::WrongLength`], and [`Error::SingularMassMatrix`] naming the joint.
    pub fn forward_dynamics(
        &self,
        theta: &[f64],
        dtheta: &[f64],
        tau: &[f64],
        environment: &Environment,
    ) -> Result<DVector<f64>, Error> {
        self.vector(q::ForwardDynamics, &[theta, dtheta, tau], environment)
    }

    /// θ̈ from τ by composite rigid bodies and the factors of M along the tree: see
    /// [`forward_dynamics_by_mass_matrix`](crate::dynamics::forward_dynamics_by_mass_matrix).
    ///
    /// # Errors
    /// [`Error::WrongLength`], and [`Error::SingularMassMatrix`] naming the joint.
    pub fn forward_dynamics_by_mass_matrix(
        &self,
        theta: &[f64],
        dtheta: &[f64],
        tau: &[f64],
        environment: &Environment,
    ) -> Result<DVector<f64>, Error> {
        self.vector(q::ForwardDynamicsByMassMatrix, &[theta, dtheta, tau], environment)
    }

    /// θ̈ from τ by the book's method (Modern Robotics, section 8.5): h by one call of inverse dynamics, M by n calls
    /// with θ̈ = e_i, and a dense LDLᵀ. O(n³): for teaching and comparison.
    ///
    /// # Errors
    /// [`Error::WrongLength`], and [`Error::SingularMassMatrix`] naming the joint.
    pub fn forward_dynamics_by_inverse_dynamics(
        &self,
        theta: &[f64],
        dtheta: &[f64],
        tau: &[f64],
        environment: &Environment,
    ) -> Result<DVector<f64>, Error> {
        self.vector(q::ForwardDynamicsByInverseDynamics, &[theta, dtheta, tau], environment)
    }
}
