//! Derivatives, momentum and regressors, of a model in Python.

use crate::array::Numbers;
use crate::call::{Options, named};
use crate::model::PyModel;
use crate::quantity::Quantity;
use crate::surroundings::{Arguments, Given};
use crate::threads::Threads;
use mozzi::Vec3;
use pyo3::prelude::*;

#[pymethods]
impl PyModel {
    /// ∂τ/∂θ, ∂τ/∂θ̇ and ∂τ/∂θ̈ = M, exact.
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
    /// threads : int, optional
    ///     As many at most; by default all cores. Many states only.
    ///
    /// Returns
    /// -------
    /// InverseDynamicsDerivatives
    ///     `by_theta`, `by_dtheta`, `by_ddtheta`, each of shape (..., n, n), row i being τ_i's.
    #[pyo3(signature = (theta, dtheta, ddtheta, tip_wrench=None, *, gravity=None, applied_wrenches=None, base_twist=None, base_acceleration=None, threads=None))]
    #[allow(clippy::too_many_arguments)] // Python's
    fn inverse_dynamics_derivatives<'py>(
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
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let found = self.robot().ask_all(
            py,
            Quantity::InverseDynamicsDerivatives,
            &[("theta", theta), ("dtheta", dtheta), ("ddtheta", ddtheta)],
            &Arguments { tip_wrench, gravity, applied_wrenches, base_twist, base_acceleration },
            Options { out: None, threads },
        )?;
        named(py, "InverseDynamicsDerivatives", found)
    }

    /// θ̈, ∂θ̈/∂θ, ∂θ̈/∂θ̇ and ∂θ̈/∂τ = M⁻¹, exact.
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
    /// threads : int, optional
    ///     As many at most; by default all cores. Many states only.
    ///
    /// Returns
    /// -------
    /// ForwardDynamicsDerivatives
    ///     `ddtheta`, shape (..., n); `by_theta`, `by_dtheta`, `by_tau`, shape (..., n, n).
    #[pyo3(signature = (theta, dtheta, tau, tip_wrench=None, *, gravity=None, applied_wrenches=None, base_twist=None, base_acceleration=None, threads=None))]
    #[allow(clippy::too_many_arguments)] // Python's
    fn forward_dynamics_derivatives<'py>(
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
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let found = self.robot().ask_all(
            py,
            Quantity::ForwardDynamicsDerivatives,
            &[("theta", theta), ("dtheta", dtheta), ("tau", tau)],
            &Arguments { tip_wrench, gravity, applied_wrenches, base_twist, base_acceleration },
            Options { out: None, threads },
        )?;
        named(py, "ForwardDynamicsDerivatives", found)
    }

    /// ∂g/∂θ.
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
    /// dg : numpy.ndarray, shape (..., n, n)
    #[pyo3(signature = (theta, *, gravity=None, out=None, threads=None))]
    fn gravity_forces_derivative<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        gravity: Given<'_, 'py>,
        out: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.robot().ask(
            py,
            Quantity::GravityForcesDerivative,
            [("theta", theta)],
            Arguments { gravity, ..Arguments::default() },
            Options { out, threads },
        )
    }

    /// ∂(JᵀF)/∂θ of wrenches that frames apply to the environment.
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
    /// dtau : numpy.ndarray, shape (..., n, n)
    #[pyo3(signature = (theta, tip_wrench=None, *, applied_wrenches=None, out=None, threads=None))]
    fn tip_forces_derivative<'py>(
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
            Quantity::TipForcesDerivative,
            [("theta", theta)],
            Arguments { tip_wrench, applied_wrenches, ..Arguments::default() },
            Options { out, threads },
        )
    }

    /// ∂(M(θ)x)/∂θ for a constant x.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (..., nq)
    ///     Positions: rad (revolute, helical) or m (prismatic); of a free base first its quaternion (w, x, y, z) and origin.
    /// x : array_like, shape (..., n)
    ///     A constant vector.
    /// out : numpy.ndarray, optional
    ///     Where the result is written.
    /// threads : int, optional
    ///     As many at most; by default all cores. Many states only.
    ///
    /// Returns
    /// -------
    /// dMx : numpy.ndarray, shape (..., n, n)
    #[pyo3(signature = (theta, x, *, out=None, threads=None))]
    fn mass_matrix_product_derivative<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        x: &Bound<'py, PyAny>,
        out: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.robot().ask(
            py,
            Quantity::MassMatrixProductDerivative,
            [("theta", theta), ("x", x)],
            Arguments::default(),
            Options { out, threads },
        )
    }

    /// The centre of mass of all that moves, in {s}.
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
    /// c : numpy.ndarray, shape (..., 3)
    ///     m.
    #[pyo3(signature = (theta, *, out=None, threads=None))]
    fn center_of_mass<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        out: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.robot().ask(py, Quantity::CenterOfMass, [("theta", theta)], Arguments::default(), Options { out, threads })
    }

    /// ċ of the centre of mass, in the axes of {s}.
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
    /// dc : numpy.ndarray, shape (..., 3)
    ///     m/s.
    #[pyo3(signature = (theta, dtheta, *, out=None, threads=None))]
    fn center_of_mass_velocity<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        dtheta: &Bound<'py, PyAny>,
        out: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.robot().ask(
            py,
            Quantity::CenterOfMassVelocity,
            [("theta", theta), ("dtheta", dtheta)],
            Arguments::default(),
            Options { out, threads },
        )
    }

    /// c̈ of the centre of mass, in the axes of {s}.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (..., nq)
    ///     Positions: rad (revolute, helical) or m (prismatic); of a free base first its quaternion (w, x, y, z) and origin.
    /// dtheta : array_like, shape (..., n)
    ///     Velocities: rad/s or m/s; of a free base first its body twist (ω, v).
    /// ddtheta : array_like, shape (..., n)
    ///     Accelerations: rad/s² or m/s².
    /// out : numpy.ndarray, optional
    ///     Where the result is written.
    /// threads : int, optional
    ///     As many at most; by default all cores. Many states only.
    ///
    /// Returns
    /// -------
    /// ddc : numpy.ndarray, shape (..., 3)
    ///     m/s².
    #[pyo3(signature = (theta, dtheta, ddtheta, *, out=None, threads=None))]
    fn center_of_mass_acceleration<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        dtheta: &Bound<'py, PyAny>,
        ddtheta: &Bound<'py, PyAny>,
        out: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.robot().ask(
            py,
            Quantity::CenterOfMassAcceleration,
            [("theta", theta), ("dtheta", dtheta), ("ddtheta", ddtheta)],
            Arguments::default(),
            Options { out, threads },
        )
    }

    /// J of the centre of mass: ċ = Jθ̇.
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
    /// J : numpy.ndarray, shape (..., 3, n)
    #[pyo3(signature = (theta, *, out=None, threads=None))]
    fn center_of_mass_jacobian<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        out: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.robot().ask(
            py,
            Quantity::CenterOfMassJacobian,
            [("theta", theta)],
            Arguments::default(),
            Options { out, threads },
        )
    }

    /// The momentum of all that moves, (angular, linear), in the axes of {s}, about a point.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (..., nq)
    ///     Positions: rad (revolute, helical) or m (prismatic); of a free base first its quaternion (w, x, y, z) and origin.
    /// dtheta : array_like, shape (..., n)
    ///     Velocities: rad/s or m/s; of a free base first its body twist (ω, v).
    /// about : array_like, shape (3,), optional
    ///     A point of {s}; by default its origin.
    /// out : numpy.ndarray, optional
    ///     Where the result is written.
    /// threads : int, optional
    ///     As many at most; by default all cores. Many states only.
    ///
    /// Returns
    /// -------
    /// h : numpy.ndarray, shape (..., 6)
    ///     kg m²/s and kg m/s.
    #[pyo3(signature = (theta, dtheta, *, about=None, out=None, threads=None))]
    fn momentum<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        dtheta: &Bound<'py, PyAny>,
        about: Given<'_, 'py>,
        out: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let about = point(about)?;
        self.robot().ask(
            py,
            Quantity::Momentum(about),
            [("theta", theta), ("dtheta", dtheta)],
            Arguments::default(),
            Options { out, threads },
        )
    }

    /// ḣ of the momentum about a fixed point, along a motion.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (..., nq)
    ///     Positions: rad (revolute, helical) or m (prismatic); of a free base first its quaternion (w, x, y, z) and origin.
    /// dtheta : array_like, shape (..., n)
    ///     Velocities: rad/s or m/s; of a free base first its body twist (ω, v).
    /// ddtheta : array_like, shape (..., n)
    ///     Accelerations: rad/s² or m/s².
    /// about : array_like, shape (3,), optional
    ///     A point of {s}; by default its origin.
    /// out : numpy.ndarray, optional
    ///     Where the result is written.
    /// threads : int, optional
    ///     As many at most; by default all cores. Many states only.
    ///
    /// Returns
    /// -------
    /// dh : numpy.ndarray, shape (..., 6)
    ///     N m and N.
    #[pyo3(signature = (theta, dtheta, ddtheta, *, about=None, out=None, threads=None))]
    #[allow(clippy::too_many_arguments)] // Python's
    fn momentum_rate<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        dtheta: &Bound<'py, PyAny>,
        ddtheta: &Bound<'py, PyAny>,
        about: Given<'_, 'py>,
        out: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let about = point(about)?;
        self.robot().ask(
            py,
            Quantity::MomentumRate(about),
            [("theta", theta), ("dtheta", dtheta), ("ddtheta", ddtheta)],
            Arguments::default(),
            Options { out, threads },
        )
    }

    /// A_G(θ), angular rows first: h_G = A_G θ̇ is the momentum about the centre of mass.
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
    /// A : numpy.ndarray, shape (..., 6, n)
    #[pyo3(signature = (theta, *, out=None, threads=None))]
    fn centroidal_momentum_matrix<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        out: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.robot().ask(
            py,
            Quantity::CentroidalMomentumMatrix,
            [("theta", theta)],
            Arguments::default(),
            Options { out, threads },
        )
    }

    /// Ȧ_G θ̇, of ḣ_G = A_G θ̈ + Ȧ_G θ̇.
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
    /// b : numpy.ndarray, shape (..., 6)
    ///     N m and N.
    #[pyo3(signature = (theta, dtheta, *, out=None, threads=None))]
    fn centroidal_momentum_bias<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        dtheta: &Bound<'py, PyAny>,
        out: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.robot().ask(
            py,
            Quantity::CentroidalMomentumBias,
            [("theta", theta), ("dtheta", dtheta)],
            Arguments::default(),
            Options { out, threads },
        )
    }

    /// Y(θ, θ̇, θ̈): τ = Yπ + JᵀF, with π as `parameters`.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (..., nq)
    ///     Positions: rad (revolute, helical) or m (prismatic); of a free base first its quaternion (w, x, y, z) and origin.
    /// dtheta : array_like, shape (..., n)
    ///     Velocities: rad/s or m/s; of a free base first its body twist (ω, v).
    /// ddtheta : array_like, shape (..., n)
    ///     Accelerations: rad/s² or m/s².
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
    /// Y : numpy.ndarray, shape (..., n, parameters)
    #[pyo3(signature = (theta, dtheta, ddtheta, *, gravity=None, applied_wrenches=None, base_twist=None, base_acceleration=None, out=None, threads=None))]
    #[allow(clippy::too_many_arguments)] // Python's
    fn regressor<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        dtheta: &Bound<'py, PyAny>,
        ddtheta: &Bound<'py, PyAny>,
        gravity: Given<'_, 'py>,
        applied_wrenches: Given<'_, 'py>,
        base_twist: Given<'_, 'py>,
        base_acceleration: Given<'_, 'py>,
        out: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.robot().ask(
            py,
            Quantity::Regressor,
            [("theta", theta), ("dtheta", dtheta), ("ddtheta", ddtheta)],
            Arguments { gravity, applied_wrenches, base_twist, base_acceleration, ..Arguments::default() },
            Options { out, threads },
        )
    }

    /// The rows that give the kinetic and the potential energy of the parameters π.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (..., nq)
    ///     Positions: rad (revolute, helical) or m (prismatic); of a free base first its quaternion (w, x, y, z) and origin.
    /// dtheta : array_like, shape (..., n)
    ///     Velocities: rad/s or m/s; of a free base first its body twist (ω, v).
    /// threads : int, optional
    ///     As many at most; by default all cores. Many states only.
    ///
    /// Returns
    /// -------
    /// EnergyRegressors
    ///     `kinetic` and `potential`, each of shape (..., parameters).
    #[pyo3(signature = (theta, dtheta, *, threads=None))]
    fn energy_regressors<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        dtheta: &Bound<'py, PyAny>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let found = self.robot().ask_all(
            py,
            Quantity::EnergyRegressors,
            &[("theta", theta), ("dtheta", dtheta)],
            &Arguments::default(),
            Options { out: None, threads },
        )?;
        named(py, "EnergyRegressors", found)
    }
}

fn point(about: Given) -> PyResult<Vec3> {
    about.map_or(Ok(Vec3([0.0; 3])), |about| Ok(Vec3(Numbers::fixed("about", about, "(3,): a point of {s}, m")?)))
}
