//! Derivatives, momentum and regressors, of a model in Python.

use crate::array::Numbers;
use crate::call::{Options, named};
use crate::environment::{Arguments, Given};
use crate::model::PyModel;
use crate::quantity::Quantity;
use crate::threads::Threads;
use mozzi::Vec3;
use pyo3::prelude::*;

methods! {
    /// ∂τ/∂θ, ∂τ/∂θ̇ and ∂τ/∂θ̈ = M, exact.
    inverse_dynamics_derivatives(theta, dtheta, ddtheta; touching tip_wrench; in gravity, applied_wrenches, base_twist, base_acceleration)
        = Quantity::InverseDynamicsDerivatives, as InverseDynamicsDerivatives => {
        /// InverseDynamicsDerivatives
        ///     `d_theta`, `d_dtheta`, `d_ddtheta`, each of shape (..., n, n), row i being τ_i's.
    }

    /// θ̈, ∂θ̈/∂θ, ∂θ̈/∂θ̇ and ∂θ̈/∂τ = M⁻¹, exact.
    forward_dynamics_derivatives(theta, dtheta, tau; touching tip_wrench; in gravity, applied_wrenches, base_twist, base_acceleration)
        = Quantity::ForwardDynamicsDerivatives, as ForwardDynamicsDerivatives => {
        /// ForwardDynamicsDerivatives
        ///     `ddtheta`, shape (..., n); `d_theta`, `d_dtheta`, `d_tau`, shape (..., n, n).
    }

    /// ∂g/∂θ.
    gravity_forces_derivative(theta; in gravity; to out) = Quantity::GravityForcesDerivative => {
        /// dg : numpy.ndarray, shape (..., n, n)
    }

    /// ∂(JᵀF)/∂θ of wrenches that frames apply to the environment.
    tip_forces_derivative(theta; touching tip_wrench; in applied_wrenches; to out) = Quantity::TipForcesDerivative => {
        /// dtau : numpy.ndarray, shape (..., n, n)
    }

    /// ∂(M(θ)x)/∂θ for a constant x.
    mass_matrix_product_derivative(theta, x; to out) = Quantity::MassMatrixProductDerivative => {
        /// dMx : numpy.ndarray, shape (..., n, n)
    }

    /// The centre of mass of all that moves, in {s}.
    center_of_mass(theta; to out) = Quantity::CenterOfMass => {
        /// c : numpy.ndarray, shape (..., 3)
        ///     m.
    }

    /// ċ of the centre of mass, in the axes of {s}.
    center_of_mass_velocity(theta, dtheta; to out) = Quantity::CenterOfMassVelocity => {
        /// dc : numpy.ndarray, shape (..., 3)
        ///     m/s.
    }

    /// c̈ of the centre of mass, in the axes of {s}.
    center_of_mass_acceleration(theta, dtheta, ddtheta; to out) = Quantity::CenterOfMassAcceleration => {
        /// ddc : numpy.ndarray, shape (..., 3)
        ///     m/s².
    }

    /// J of the centre of mass: ċ = Jθ̇.
    center_of_mass_jacobian(theta; to out) = Quantity::CenterOfMassJacobian => {
        /// J : numpy.ndarray, shape (..., 3, n)
    }

    /// The momentum of all that moves, (angular, linear), in the axes of {s}, about a point.
    momentum(theta, dtheta; with about: Given<'_, 'py> = None; to out) = Quantity::Momentum(point(about)?) => {
        /// h : numpy.ndarray, shape (..., 6)
        ///     kg m²/s and kg m/s.
    }

    /// ḣ of the momentum about a fixed point, along a motion.
    momentum_rate(theta, dtheta, ddtheta; with about: Given<'_, 'py> = None; to out)
        = Quantity::MomentumRate(point(about)?) => {
        /// dh : numpy.ndarray, shape (..., 6)
        ///     N m and N.
    }

    /// A_G(θ), angular rows first: h_G = A_G θ̇ is the momentum about the centre of mass.
    centroidal_momentum_matrix(theta; to out) = Quantity::CentroidalMomentumMatrix => {
        /// A : numpy.ndarray, shape (..., 6, n)
    }

    /// Ȧ_G θ̇, of ḣ_G = A_G θ̈ + Ȧ_G θ̇.
    centroidal_momentum_bias(theta, dtheta; to out) = Quantity::CentroidalMomentumBias => {
        /// b : numpy.ndarray, shape (..., 6)
        ///     N m and N.
    }

    /// Y(θ, θ̇, θ̈): τ = Yπ + JᵀF, with π as `parameters`.
    regressor(theta, dtheta, ddtheta; in gravity, applied_wrenches, base_twist, base_acceleration; to out)
        = Quantity::Regressor => {
        /// Y : numpy.ndarray, shape (..., n, parameters)
    }

    /// The rows that give the kinetic and the potential energy of the parameters π.
    energy_regressors(theta, dtheta) = Quantity::EnergyRegressors, as EnergyRegressors => {
        /// EnergyRegressors
        ///     `kinetic` and `potential`, each of shape (..., parameters).
    }
}

fn point(about: Given) -> PyResult<Vec3> {
    about.map_or(Ok(Vec3([0.0; 3])), |about| Ok(Vec3(Numbers::fixed("about", about, "(3,): a point of {s}, m")?)))
}
