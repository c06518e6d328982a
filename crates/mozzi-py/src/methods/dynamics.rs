//! Inverse and forward dynamics, their parts, and energies, of a model in Python.

use crate::call::Options;
use crate::environment::{Arguments, Given};
use crate::model::PyModel;
use crate::quantity::Quantity;
use crate::threads::Threads;
use pyo3::prelude::*;

methods! {
    /// τ = M(θ)θ̈ + c(θ, θ̇) + g(θ) + JᵀF + f(θ̇), the torques of a motion.
    inverse_dynamics(theta, dtheta, ddtheta; touching tip_wrench; in gravity, applied_wrenches, base_twist, base_acceleration; to out)
        = Quantity::InverseDynamics => {
        /// tau : numpy.ndarray, shape (..., n)
        ///     N m or N.
        ///
        /// Examples
        /// --------
        /// >>> import mozzi
        /// >>> ur5 = mozzi.models.ur5()
        /// >>> tau = ur5.inverse_dynamics([0, -1.2, 1.5, 0.3, 1.1, 0], [0.1] * 6, [0.5] * 6)
        /// >>> tau.shape
        /// (6,)
        /// >>> import numpy as np
        /// >>> ur5.inverse_dynamics(np.zeros((5, 3, 6)), np.zeros(6), np.zeros(6)).shape # leading axes: many states
        /// (5, 3, 6)
    }

    /// θ̈ of the joint torques τ.
    forward_dynamics(theta, dtheta, tau; touching tip_wrench; in gravity, applied_wrenches, base_twist, base_acceleration; to out)
        = Quantity::ForwardDynamics => {
        /// ddtheta : numpy.ndarray, shape (..., n)
        ///     rad/s² or m/s².
        ///
        /// Raises
        /// ------
        /// SingularError
        ///     Where the mass matrix is singular, with the joint.
        ///
        /// Examples
        /// --------
        /// >>> import mozzi
        /// >>> ur5 = mozzi.models.ur5()
        /// >>> ddtheta = ur5.forward_dynamics([0, -1.2, 1.5, 0.3, 1.1, 0], [0.1] * 6, [0.0] * 6)
        /// >>> tau = ur5.inverse_dynamics([0, -1.2, 1.5, 0.3, 1.1, 0], [0.1] * 6, ddtheta)
        /// >>> bool(abs(tau).max() < 1e-12)
        /// True
    }

    /// M(θ), rotors' inertia on its diagonal.
    mass_matrix(theta; to out) = Quantity::MassMatrix => {
        /// M : numpy.ndarray, shape (..., n, n)
        ///     kg m², kg m or kg.
        ///
        /// Examples
        /// --------
        /// >>> import mozzi
        /// >>> ur5 = mozzi.models.ur5()
        /// >>> M = ur5.mass_matrix([0, -1.2, 1.5, 0.3, 1.1, 0])
        /// >>> bool(abs(M - M.T).max() < 1e-15)
        /// True
    }

    /// Ṁ(θ, θ̇).
    mass_matrix_rate(theta, dtheta; to out) = Quantity::MassMatrixRate => {
        /// dM : numpy.ndarray, shape (..., n, n)
    }

    /// C(θ, θ̇) of the Christoffel symbols: c = Cθ̇, and Ṁ − 2C is skew.
    coriolis_matrix(theta, dtheta; to out) = Quantity::CoriolisMatrix => {
        /// C : numpy.ndarray, shape (..., n, n)
    }

    /// c(θ, θ̇): Coriolis and centripetal torques.
    velocity_product(theta, dtheta; to out) = Quantity::VelocityProduct => {
        /// c : numpy.ndarray, shape (..., n)
        ///     N m or N.
    }

    /// g(θ): the torques that hold the robot against gravity.
    gravity_forces(theta; in gravity; to out) = Quantity::GravityForces => {
        /// g : numpy.ndarray, shape (..., n)
        ///     N m or N.
    }

    /// h(θ, θ̇) = c + g (+ JᵀF and the base's terms, where given), without friction.
    bias_forces(theta, dtheta; touching tip_wrench; in gravity, applied_wrenches, base_twist, base_acceleration; to out)
        = Quantity::BiasForces => {
        /// h : numpy.ndarray, shape (..., n)
        ///     N m or N.
    }

    /// JᵀF of wrenches that frames apply to the environment.
    tip_forces(theta; touching tip_wrench; in applied_wrenches; to out) = Quantity::TipForces => {
        /// tau : numpy.ndarray, shape (..., n)
        ///     N m or N.
    }

    /// f(θ̇) = dθ̇ + μ sgn θ̇ of each joint, with sgn 0 = 0.
    joint_friction(dtheta; to out) = Quantity::JointFriction => {
        /// f : numpy.ndarray, shape (..., n)
        ///     N m or N.
    }

    /// ½θ̇ᵀMθ̇, the moving links' and rotors'.
    kinetic_energy(theta, dtheta; in base_twist; to out) = Quantity::KineticEnergy => {
        /// energy : float, or numpy.ndarray of the leading shape
        ///     J.
    }

    /// −Σ m gᵀp, p seen from the origin of {s}.
    potential_energy(theta; in gravity; to out) = Quantity::PotentialEnergy => {
        /// energy : float, or numpy.ndarray of the leading shape
        ///     J.
    }
}
