//! Inverse and forward dynamics, their parts, and energies, of a model in Python.

use crate::call::Options;
use crate::model::PyModel;
use crate::quantity::Quantity;
use crate::surroundings::{Arguments, Given};
use crate::threads::Threads;
use pyo3::prelude::*;

#[pymethods]
impl PyModel {
    /// τ = M(θ)θ̈ + c(θ, θ̇) + g(θ) + JᵀF + f(θ̇), the torques of a motion.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (..., nq)
    ///     Positions: rad (revolute, helical) or m (prismatic); of a free base first its quaternion (w, x, y, z) and origin.
    /// dtheta : array_like, shape (..., n)
    ///     Velocities: rad/s or m/s; of a free base first its body twist (ω, v).
    /// ddtheta : array_like, shape (..., n)
    ///     Accelerations: rad/s² or m/s².
    /// tip_wrench : array_like, shape (..., 6), optional
    ///     (m, f) that the end effector applies to the environment, in its own coordinates: N m, N.
    /// gravity : array_like, shape (3,), optional
    ///     In place of the model's own, in the axes of {s}: m/s².
    /// applied_wrenches : dict of str to array_like of shape (..., 6), optional
    ///     (m, f) that each frame applies to the environment, in its own coordinates.
    /// base_twist, base_acceleration : array_like, shape (6,), optional
    ///     The motion of {s} itself, (ω, v) and (ω̇, v̇).
    /// out : numpy.ndarray, optional
    ///     Where the result is written.
    /// threads : int, optional
    ///     As many at most; by default all cores. Many states only.
    ///
    /// Returns
    /// -------
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
    #[pyo3(signature = (theta, dtheta, ddtheta, tip_wrench=None, *, gravity=None, applied_wrenches=None, base_twist=None, base_acceleration=None, out=None, threads=None))]
    #[allow(clippy::too_many_arguments)] // Python's
    fn inverse_dynamics<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        dtheta: &Bound<'py, PyAny>,
        ddtheta: &Bound<'py, PyAny>,
        tip_wrench: Given<'_, 'py>,
        gravity: Given<'_, 'py>,
        applied_wrenches: Given<'_, 'py>,
        base_twist: Given<'_, 'py>,
        base_acceleration: Given<'_, 'py>,
        out: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.robot().ask(
            py,
            Quantity::InverseDynamics,
            [("theta", theta), ("dtheta", dtheta), ("ddtheta", ddtheta)],
            Arguments { tip_wrench, gravity, applied_wrenches, base_twist, base_acceleration },
            Options { out, threads },
        )
    }

    /// θ̈ of the joint torques τ.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (..., nq)
    ///     Positions: rad (revolute, helical) or m (prismatic); of a free base first its quaternion (w, x, y, z) and origin.
    /// dtheta : array_like, shape (..., n)
    ///     Velocities: rad/s or m/s; of a free base first its body twist (ω, v).
    /// tau : array_like, shape (..., n)
    ///     Joint torques and forces: N m or N.
    /// tip_wrench : array_like, shape (..., 6), optional
    ///     (m, f) that the end effector applies to the environment, in its own coordinates: N m, N.
    /// gravity : array_like, shape (3,), optional
    ///     In place of the model's own, in the axes of {s}: m/s².
    /// applied_wrenches : dict of str to array_like of shape (..., 6), optional
    ///     (m, f) that each frame applies to the environment, in its own coordinates.
    /// base_twist, base_acceleration : array_like, shape (6,), optional
    ///     The motion of {s} itself, (ω, v) and (ω̇, v̇).
    /// out : numpy.ndarray, optional
    ///     Where the result is written.
    /// threads : int, optional
    ///     As many at most; by default all cores. Many states only.
    ///
    /// Returns
    /// -------
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
    #[pyo3(signature = (theta, dtheta, tau, tip_wrench=None, *, gravity=None, applied_wrenches=None, base_twist=None, base_acceleration=None, out=None, threads=None))]
    #[allow(clippy::too_many_arguments)] // Python's
    fn forward_dynamics<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        dtheta: &Bound<'py, PyAny>,
        tau: &Bound<'py, PyAny>,
        tip_wrench: Given<'_, 'py>,
        gravity: Given<'_, 'py>,
        applied_wrenches: Given<'_, 'py>,
        base_twist: Given<'_, 'py>,
        base_acceleration: Given<'_, 'py>,
        out: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.robot().ask(
            py,
            Quantity::ForwardDynamics,
            [("theta", theta), ("dtheta", dtheta), ("tau", tau)],
            Arguments { tip_wrench, gravity, applied_wrenches, base_twist, base_acceleration },
            Options { out, threads },
        )
    }

    /// M(θ), rotors' inertia on its diagonal.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (..., nq)
    ///     Positions: rad (revolute, helical) or m (prismatic); of a free base first its quaternion (w, x, y, z) and origin.
    /// out : numpy.ndarray, optional
    ///     Where the result is written.
    /// threads : int, optional
    ///     As many at most; by default all cores. Many states only.
    ///
    /// Returns
    /// -------
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
    #[pyo3(signature = (theta, *, out=None, threads=None))]
    fn mass_matrix<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        out: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.robot().ask(py, Quantity::MassMatrix, [("theta", theta)], Arguments::default(), Options { out, threads })
    }

    /// Ṁ(θ, θ̇).
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (..., nq)
    ///     Positions: rad (revolute, helical) or m (prismatic); of a free base first its quaternion (w, x, y, z) and origin.
    /// dtheta : array_like, shape (..., n)
    ///     Velocities: rad/s or m/s; of a free base first its body twist (ω, v).
    /// out : numpy.ndarray, optional
    ///     Where the result is written.
    /// threads : int, optional
    ///     As many at most; by default all cores. Many states only.
    ///
    /// Returns
    /// -------
    /// dM : numpy.ndarray, shape (..., n, n)
    #[pyo3(signature = (theta, dtheta, *, out=None, threads=None))]
    fn mass_matrix_rate<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        dtheta: &Bound<'py, PyAny>,
        out: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.robot().ask(
            py,
            Quantity::MassMatrixRate,
            [("theta", theta), ("dtheta", dtheta)],
            Arguments::default(),
            Options { out, threads },
        )
    }

    /// C(θ, θ̇) of the Christoffel symbols: c = Cθ̇, and Ṁ − 2C is skew.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (..., nq)
    ///     Positions: rad (revolute, helical) or m (prismatic); of a free base first its quaternion (w, x, y, z) and origin.
    /// dtheta : array_like, shape (..., n)
    ///     Velocities: rad/s or m/s; of a free base first its body twist (ω, v).
    /// out : numpy.ndarray, optional
    ///     Where the result is written.
    /// threads : int, optional
    ///     As many at most; by default all cores. Many states only.
    ///
    /// Returns
    /// -------
    /// C : numpy.ndarray, shape (..., n, n)
    #[pyo3(signature = (theta, dtheta, *, out=None, threads=None))]
    fn coriolis_matrix<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        dtheta: &Bound<'py, PyAny>,
        out: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.robot().ask(
            py,
            Quantity::CoriolisMatrix,
            [("theta", theta), ("dtheta", dtheta)],
            Arguments::default(),
            Options { out, threads },
        )
    }

    /// c(θ, θ̇): Coriolis and centripetal torques.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (..., nq)
    ///     Positions: rad (revolute, helical) or m (prismatic); of a free base first its quaternion (w, x, y, z) and origin.
    /// dtheta : array_like, shape (..., n)
    ///     Velocities: rad/s or m/s; of a free base first its body twist (ω, v).
    /// out : numpy.ndarray, optional
    ///     Where the result is written.
    /// threads : int, optional
    ///     As many at most; by default all cores. Many states only.
    ///
    /// Returns
    /// -------
    /// c : numpy.ndarray, shape (..., n)
    ///     N m or N.
    #[pyo3(signature = (theta, dtheta, *, out=None, threads=None))]
    fn velocity_product<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        dtheta: &Bound<'py, PyAny>,
        out: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.robot().ask(
            py,
            Quantity::VelocityProduct,
            [("theta", theta), ("dtheta", dtheta)],
            Arguments::default(),
            Options { out, threads },
        )
    }

    /// g(θ): the torques that hold the robot against gravity.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (..., nq)
    ///     Positions: rad (revolute, helical) or m (prismatic); of a free base first its quaternion (w, x, y, z) and origin.
    /// gravity : array_like, shape (3,), optional
    ///     In place of the model's own, in the axes of {s}: m/s².
    /// out : numpy.ndarray, optional
    ///     Where the result is written.
    /// threads : int, optional
    ///     As many at most; by default all cores. Many states only.
    ///
    /// Returns
    /// -------
    /// g : numpy.ndarray, shape (..., n)
    ///     N m or N.
    #[pyo3(signature = (theta, *, gravity=None, out=None, threads=None))]
    fn gravity_forces<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        gravity: Given<'_, 'py>,
        out: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.robot().ask(
            py,
            Quantity::GravityForces,
            [("theta", theta)],
            Arguments { gravity, ..Arguments::default() },
            Options { out, threads },
        )
    }

    /// h(θ, θ̇) = c + g (+ JᵀF and the base's terms, where given), without friction.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (..., nq)
    ///     Positions: rad (revolute, helical) or m (prismatic); of a free base first its quaternion (w, x, y, z) and origin.
    /// dtheta : array_like, shape (..., n)
    ///     Velocities: rad/s or m/s; of a free base first its body twist (ω, v).
    /// tip_wrench : array_like, shape (..., 6), optional
    ///     (m, f) that the end effector applies to the environment, in its own coordinates: N m, N.
    /// gravity : array_like, shape (3,), optional
    ///     In place of the model's own, in the axes of {s}: m/s².
    /// applied_wrenches : dict of str to array_like of shape (..., 6), optional
    ///     (m, f) that each frame applies to the environment, in its own coordinates.
    /// base_twist, base_acceleration : array_like, shape (6,), optional
    ///     The motion of {s} itself, (ω, v) and (ω̇, v̇).
    /// out : numpy.ndarray, optional
    ///     Where the result is written.
    /// threads : int, optional
    ///     As many at most; by default all cores. Many states only.
    ///
    /// Returns
    /// -------
    /// h : numpy.ndarray, shape (..., n)
    ///     N m or N.
    #[pyo3(signature = (theta, dtheta, tip_wrench=None, *, gravity=None, applied_wrenches=None, base_twist=None, base_acceleration=None, out=None, threads=None))]
    #[allow(clippy::too_many_arguments)] // Python's
    fn bias_forces<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        dtheta: &Bound<'py, PyAny>,
        tip_wrench: Given<'_, 'py>,
        gravity: Given<'_, 'py>,
        applied_wrenches: Given<'_, 'py>,
        base_twist: Given<'_, 'py>,
        base_acceleration: Given<'_, 'py>,
        out: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.robot().ask(
            py,
            Quantity::BiasForces,
            [("theta", theta), ("dtheta", dtheta)],
            Arguments { tip_wrench, gravity, applied_wrenches, base_twist, base_acceleration },
            Options { out, threads },
        )
    }

    /// JᵀF of wrenches that frames apply to the environment.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (..., nq)
    ///     Positions: rad (revolute, helical) or m (prismatic); of a free base first its quaternion (w, x, y, z) and origin.
    /// tip_wrench : array_like, shape (..., 6), optional
    ///     (m, f) that the end effector applies to the environment, in its own coordinates: N m, N.
    /// applied_wrenches : dict of str to array_like of shape (..., 6), optional
    ///     (m, f) that each frame applies to the environment, in its own coordinates.
    /// out : numpy.ndarray, optional
    ///     Where the result is written.
    /// threads : int, optional
    ///     As many at most; by default all cores. Many states only.
    ///
    /// Returns
    /// -------
    /// tau : numpy.ndarray, shape (..., n)
    ///     N m or N.
    #[pyo3(signature = (theta, tip_wrench=None, *, applied_wrenches=None, out=None, threads=None))]
    fn tip_forces<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        tip_wrench: Given<'_, 'py>,
        applied_wrenches: Given<'_, 'py>,
        out: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.robot().ask(
            py,
            Quantity::TipForces,
            [("theta", theta)],
            Arguments { tip_wrench, applied_wrenches, ..Arguments::default() },
            Options { out, threads },
        )
    }

    /// f(θ̇) = dθ̇ + μ sgn θ̇ of each joint, with sgn 0 = 0.
    ///
    /// Parameters
    /// ----------
    /// dtheta : array_like, shape (..., n)
    ///     Velocities: rad/s or m/s; of a free base first its body twist (ω, v).
    /// out : numpy.ndarray, optional
    ///     Where the result is written.
    /// threads : int, optional
    ///     As many at most; by default all cores. Many states only.
    ///
    /// Returns
    /// -------
    /// f : numpy.ndarray, shape (..., n)
    ///     N m or N.
    #[pyo3(signature = (dtheta, *, out=None, threads=None))]
    fn joint_friction<'py>(
        &self,
        py: Python<'py>,
        dtheta: &Bound<'py, PyAny>,
        out: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.robot().ask(
            py,
            Quantity::JointFriction,
            [("dtheta", dtheta)],
            Arguments::default(),
            Options { out, threads },
        )
    }

    /// ½θ̇ᵀMθ̇, the moving links' and rotors'.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (..., nq)
    ///     Positions: rad (revolute, helical) or m (prismatic); of a free base first its quaternion (w, x, y, z) and origin.
    /// dtheta : array_like, shape (..., n)
    ///     Velocities: rad/s or m/s; of a free base first its body twist (ω, v).
    /// base_twist : array_like, shape (6,), optional
    ///     The motion of {s} itself, (ω, v).
    /// out : numpy.ndarray, optional
    ///     Where the result is written.
    /// threads : int, optional
    ///     As many at most; by default all cores. Many states only.
    ///
    /// Returns
    /// -------
    /// energy : float, or numpy.ndarray of the leading shape
    ///     J.
    #[pyo3(signature = (theta, dtheta, *, base_twist=None, out=None, threads=None))]
    fn kinetic_energy<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        dtheta: &Bound<'py, PyAny>,
        base_twist: Given<'_, 'py>,
        out: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.robot().ask(
            py,
            Quantity::KineticEnergy,
            [("theta", theta), ("dtheta", dtheta)],
            Arguments { base_twist, ..Arguments::default() },
            Options { out, threads },
        )
    }

    /// −Σ m gᵀp, p seen from the origin of {s}.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (..., nq)
    ///     Positions: rad (revolute, helical) or m (prismatic); of a free base first its quaternion (w, x, y, z) and origin.
    /// gravity : array_like, shape (3,), optional
    ///     In place of the model's own, in the axes of {s}: m/s².
    /// out : numpy.ndarray, optional
    ///     Where the result is written.
    /// threads : int, optional
    ///     As many at most; by default all cores. Many states only.
    ///
    /// Returns
    /// -------
    /// energy : float, or numpy.ndarray of the leading shape
    ///     J.
    #[pyo3(signature = (theta, *, gravity=None, out=None, threads=None))]
    fn potential_energy<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        gravity: Given<'_, 'py>,
        out: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.robot().ask(
            py,
            Quantity::PotentialEnergy,
            [("theta", theta)],
            Arguments { gravity, ..Arguments::default() },
            Options { out, threads },
        )
    }
}
