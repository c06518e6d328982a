//! Configurations, Jacobians and the task space, of a model in Python.

use crate::call::{Options, named};
use crate::failure::of_model;
use crate::model::PyModel;
use crate::quantity::Quantity;
use crate::surroundings::{Arguments, Given};
use crate::threads::Threads;
use mozzi::{Task, TaskFrame};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

#[pymethods]
impl PyModel {
    /// T_sb, the configuration of a frame seen from {s}.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (..., nq)
    ///     Positions: rad (revolute, helical) or m (prismatic); of a free base first its quaternion (w, x, y, z) and origin.
    /// frame : str, optional
    ///     A link or frame of the robot; without it, its end effector.
    /// out : numpy.ndarray, optional
    ///     Where the result is written.
    /// threads : int, optional
    ///     As many at most; by default all cores. Many states only.
    ///
    /// Returns
    /// -------
    /// T : numpy.ndarray, shape (..., 4, 4)
    ///     Lengths in m.
    ///
    /// Examples
    /// --------
    /// >>> import mozzi
    /// >>> ur5 = mozzi.models.ur5()
    /// >>> T = ur5.forward_kinematics([0, -1.2, 1.5, 0.3, 1.1, 0])
    /// >>> T.shape
    /// (4, 4)
    /// >>> ur5.forward_kinematics([0, -1.2, 1.5, 0.3, 1.1, 0], "forearm_link")[:3, 3].round(3).tolist()
    /// [0.154, 0.016, 0.485]
    #[pyo3(signature = (theta, frame=None, *, out=None, threads=None))]
    fn forward_kinematics<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        frame: Option<&str>,
        out: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let frame = self.frame(frame)?;
        self.robot().ask(
            py,
            Quantity::ForwardKinematics(frame),
            [("theta", theta)],
            Arguments::default(),
            Options { out, threads },
        )
    }

    /// J_s(θ) of a frame: its twist in {s} is J_s θ̇, (ω, v).
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (..., nq)
    ///     Positions: rad (revolute, helical) or m (prismatic); of a free base first its quaternion (w, x, y, z) and origin.
    /// frame : str, optional
    ///     A link or frame of the robot; without it, its end effector.
    /// out : numpy.ndarray, optional
    ///     Where the result is written.
    /// threads : int, optional
    ///     As many at most; by default all cores. Many states only.
    ///
    /// Returns
    /// -------
    /// J : numpy.ndarray, shape (..., 6, n)
    #[pyo3(signature = (theta, frame=None, *, out=None, threads=None))]
    fn space_jacobian<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        frame: Option<&str>,
        out: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let frame = self.frame(frame)?;
        self.robot().ask(
            py,
            Quantity::SpaceJacobian(frame),
            [("theta", theta)],
            Arguments::default(),
            Options { out, threads },
        )
    }

    /// J_b(θ) of a frame: its twist in its own coordinates is J_b θ̇, (ω, v).
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (..., nq)
    ///     Positions: rad (revolute, helical) or m (prismatic); of a free base first its quaternion (w, x, y, z) and origin.
    /// frame : str, optional
    ///     A link or frame of the robot; without it, its end effector.
    /// out : numpy.ndarray, optional
    ///     Where the result is written.
    /// threads : int, optional
    ///     As many at most; by default all cores. Many states only.
    ///
    /// Returns
    /// -------
    /// J : numpy.ndarray, shape (..., 6, n)
    #[pyo3(signature = (theta, frame=None, *, out=None, threads=None))]
    fn body_jacobian<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        frame: Option<&str>,
        out: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let frame = self.frame(frame)?;
        self.robot().ask(
            py,
            Quantity::BodyJacobian(frame),
            [("theta", theta)],
            Arguments::default(),
            Options { out, threads },
        )
    }

    /// dJ_s/dt of a frame.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (..., nq)
    ///     Positions: rad (revolute, helical) or m (prismatic); of a free base first its quaternion (w, x, y, z) and origin.
    /// dtheta : array_like, shape (..., n)
    ///     Velocities: rad/s or m/s; of a free base first its body twist (ω, v).
    /// frame : str, optional
    ///     A link or frame of the robot; without it, its end effector.
    /// out : numpy.ndarray, optional
    ///     Where the result is written.
    /// threads : int, optional
    ///     As many at most; by default all cores. Many states only.
    ///
    /// Returns
    /// -------
    /// dJ : numpy.ndarray, shape (..., 6, n)
    #[pyo3(signature = (theta, dtheta, frame=None, *, out=None, threads=None))]
    fn space_jacobian_rate<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        dtheta: &Bound<'py, PyAny>,
        frame: Option<&str>,
        out: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let frame = self.frame(frame)?;
        self.robot().ask(
            py,
            Quantity::SpaceJacobianRate(frame),
            [("theta", theta), ("dtheta", dtheta)],
            Arguments::default(),
            Options { out, threads },
        )
    }

    /// dJ_b/dt of a frame.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (..., nq)
    ///     Positions: rad (revolute, helical) or m (prismatic); of a free base first its quaternion (w, x, y, z) and origin.
    /// dtheta : array_like, shape (..., n)
    ///     Velocities: rad/s or m/s; of a free base first its body twist (ω, v).
    /// frame : str, optional
    ///     A link or frame of the robot; without it, its end effector.
    /// out : numpy.ndarray, optional
    ///     Where the result is written.
    /// threads : int, optional
    ///     As many at most; by default all cores. Many states only.
    ///
    /// Returns
    /// -------
    /// dJ : numpy.ndarray, shape (..., 6, n)
    #[pyo3(signature = (theta, dtheta, frame=None, *, out=None, threads=None))]
    fn body_jacobian_rate<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        dtheta: &Bound<'py, PyAny>,
        frame: Option<&str>,
        out: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let frame = self.frame(frame)?;
        self.robot().ask(
            py,
            Quantity::BodyJacobianRate(frame),
            [("theta", theta), ("dtheta", dtheta)],
            Arguments::default(),
            Options { out, threads },
        )
    }

    /// ∂J_s/∂θ_j of a frame for each joint j.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (..., nq)
    ///     Positions: rad (revolute, helical) or m (prismatic); of a free base first its quaternion (w, x, y, z) and origin.
    /// frame : str, optional
    ///     A link or frame of the robot; without it, its end effector.
    /// out : numpy.ndarray, optional
    ///     Where the result is written.
    /// threads : int, optional
    ///     As many at most; by default all cores. Many states only.
    ///
    /// Returns
    /// -------
    /// H : numpy.ndarray, shape (..., n, 6, n)
    ///     H[j] is ∂J_s/∂θ_j.
    #[pyo3(signature = (theta, frame=None, *, out=None, threads=None))]
    fn space_jacobian_derivative<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        frame: Option<&str>,
        out: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let frame = self.frame(frame)?;
        self.robot().ask(
            py,
            Quantity::SpaceJacobianDerivative(frame),
            [("theta", theta)],
            Arguments::default(),
            Options { out, threads },
        )
    }

    /// ∂J_b/∂θ_j of a frame for each joint j.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (..., nq)
    ///     Positions: rad (revolute, helical) or m (prismatic); of a free base first its quaternion (w, x, y, z) and origin.
    /// frame : str, optional
    ///     A link or frame of the robot; without it, its end effector.
    /// out : numpy.ndarray, optional
    ///     Where the result is written.
    /// threads : int, optional
    ///     As many at most; by default all cores. Many states only.
    ///
    /// Returns
    /// -------
    /// H : numpy.ndarray, shape (..., n, 6, n)
    ///     H[j] is ∂J_b/∂θ_j.
    #[pyo3(signature = (theta, frame=None, *, out=None, threads=None))]
    fn body_jacobian_derivative<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        frame: Option<&str>,
        out: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let frame = self.frame(frame)?;
        self.robot().ask(
            py,
            Quantity::BodyJacobianDerivative(frame),
            [("theta", theta)],
            Arguments::default(),
            Options { out, threads },
        )
    }

    /// Λ and η of 𝓕 = Λ(θ)𝒱̇ + η(θ, 𝒱), the dynamics as a frame shows them.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (..., nq)
    ///     Positions: rad (revolute, helical) or m (prismatic); of a free base first its quaternion (w, x, y, z) and origin.
    /// dtheta : array_like, shape (..., n)
    ///     Velocities: rad/s or m/s; of a free base first its body twist (ω, v).
    /// frame : str, optional
    ///     A link or frame of the robot; without it, its end effector.
    /// tip_wrench : array_like, shape (..., 6), optional
    ///     (m, f) that the end effector applies to the environment, in its own coordinates: N m, N.
    /// coordinates : {'body', 'space'}
    ///     Whose coordinates the twist and the wrench are in.
    /// rows : sequence of int, optional
    ///     Which of (ω_x, ω_y, ω_z, v_x, v_y, v_z), each once; all by default.
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
    /// TaskSpaceDynamics
    ///     `Lambda`, shape (..., k, k), and `eta`, shape (..., k).
    ///
    /// Raises
    /// ------
    /// SingularError
    ///     Where the rows cannot be moved independently.
    #[pyo3(signature = (theta, dtheta, frame=None, tip_wrench=None, *, coordinates="body", rows=None, gravity=None, applied_wrenches=None, base_twist=None, base_acceleration=None, threads=None))]
    #[allow(clippy::too_many_arguments)] // Python's
    fn task_space_dynamics<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        dtheta: &Bound<'py, PyAny>,
        frame: Option<&str>,
        tip_wrench: Given<'_, 'py>,
        coordinates: &str,
        rows: Option<Vec<usize>>,
        gravity: Given<'_, 'py>,
        applied_wrenches: Given<'_, 'py>,
        base_twist: Given<'_, 'py>,
        base_acceleration: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let frame = self.frame(frame)?;
        let rows = rows.unwrap_or_else(|| (0..6).collect());
        let task = Task { frame, coordinates: task_frame(coordinates)?, rows: &rows };
        task.check(&self.robot().model).map_err(of_model)?;
        let found = self.robot().ask_all(
            py,
            Quantity::TaskSpaceDynamics(task),
            &[("theta", theta), ("dtheta", dtheta)],
            &Arguments { tip_wrench, gravity, applied_wrenches, base_twist, base_acceleration },
            Options { out: None, threads },
        )?;
        named(py, "TaskSpaceDynamics", found)
    }
}

fn task_frame(coordinates: &str) -> PyResult<TaskFrame> {
    match coordinates {
        "body" => Ok(TaskFrame::Body),
        "space" => Ok(TaskFrame::Space),
        other => Err(PyValueError::new_err(format!("coordinates is '{other}', expected 'body' or 'space'"))),
    }
}
