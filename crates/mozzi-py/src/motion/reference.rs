//! `mozzi.trajectories.Reference` and its kinds.

use super::instants::Instants;
use super::path::{PyPath, rows};
use super::profile::PyProfile;
use super::repr::positions;
use crate::arguments::Given;
use crate::array::{list, wrong_shape};
use crate::describe::refused;
use crate::failure::{of_model, of_motion};
use crate::model::PyModel;
use crate::results::named;
use mozzi::Model;
use mozzi_motion::trajectories::{Desired, Hold, OfJoints, Profile, Recorded, Reference, Timed};
use mozzi_report::text::scalar;
use pyo3::prelude::*;

/// A desired motion of a robot, θ_d, θ̇_d and θ̈_d over time, which a controller follows.
///
/// It is a `Timed` path, a `Recorded` table, a `Hold` or an `OfJoints`. `at(t)` returns (theta, dtheta, ddtheta), so
/// that `model.inverse_dynamics(*reference.at(t))` are the torques that the motion demands.
#[pyclass(frozen, subclass, name = "Reference", module = "mozzi.trajectories")]
pub struct PyReference {
    model: Py<PyModel>,
    source: Source,
}

enum Source {
    Timed(Py<PyPath>, Profile),
    Recorded(Recorded),
    Hold(Hold),
    OfJoints(Py<PyReference>, [f64; 7]),
}

/// A reference that threads may share.
pub type SharedReference<'a> = Box<dyn Reference + Send + Sync + 'a>;

impl PyReference {
    pub fn model(&self) -> &Model {
        &self.model.get().robot().model
    }

    /// θ_d(t), θ̇_d(t) and θ̈_d(t).
    ///
    /// # Errors
    /// `ValueError` for a path without positions.
    pub fn reference(&self) -> PyResult<SharedReference<'_>> {
        Ok(match &self.source {
            Source::Timed(path, profile) => Box::new(Timed::new(path.get().path()?, profile.clone())),
            Source::Recorded(table) => Box::new(table),
            Source::Hold(hold) => Box::new(hold),
            Source::OfJoints(joints, pose) => Box::new(OfJoints { joints: joints.get().reference()?, pose: *pose }),
        })
    }
}

#[pymethods]
impl PyReference {
    /// Evaluate θ_d, θ̇_d and θ̈_d at one time or at many.
    ///
    /// Before the motion and after it, the robot rests at its first and its last positions.
    ///
    /// Parameters
    /// ----------
    /// t : array_like, shape (...)
    ///     Times, s.
    ///
    /// Returns
    /// -------
    /// Desired
    ///     A named tuple: `theta`, shape (..., nq), rad or m; `dtheta`, shape (..., n), rad/s or m/s; `ddtheta`, shape
    ///     (..., n), rad/s² or m/s².
    ///
    /// Examples
    /// --------
    /// >>> import mozzi
    /// >>> import numpy as np
    /// >>> from mozzi.trajectories import Line, Profile, Timed
    /// >>> arm = mozzi.models.two_link_planar()
    /// >>> motion = Timed(Line(arm, [0.0, 0.0], [1.0, -2.0]), Profile.cubic(2.0))
    /// >>> t = np.linspace(0.0, motion.duration, 101)
    /// >>> arm.inverse_dynamics(*motion.at(t)).shape  # the torques that the motion demands
    /// (101, 2)
    fn at<'py>(&self, py: Python<'py>, t: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let (reference, model) = (self.reference()?, self.model());
        let desired = |t: f64| {
            let Desired { theta, dtheta, ddtheta } = reference.at(t);
            [theta, dtheta, ddtheta]
        };
        named(py, "Desired", Instants::seconds(t)?.rows(py, [model.nq(), model.n(), model.n()], desired)?)
    }

    /// Duration, s; the motion begins at 0.
    #[getter]
    fn duration(&self) -> PyResult<f64> {
        Ok(self.reference()?.duration())
    }

    /// The robot that moves.
    #[getter(model)]
    fn python_model(&self, py: Python<'_>) -> Py<PyModel> {
        self.model.clone_ref(py)
    }

    fn __repr__(&self) -> PyResult<String> {
        let (robot, seconds) = (&self.model().description().name, scalar(self.duration()?));
        Ok(match &self.source {
            Source::Timed(path, _) => {
                format!("<mozzi.trajectories.Timed of '{robot}': a {} in {seconds} s>", path.get().kind())
            }
            Source::Recorded(_) => format!("<mozzi.trajectories.Recorded of '{robot}': {seconds} s>"),
            Source::Hold(hold) => {
                format!("<mozzi.trajectories.Hold of '{robot}' at {}>", positions(&hold.at(0.0).theta))
            }
            Source::OfJoints(..) => format!("<mozzi.trajectories.OfJoints of '{robot}': {seconds} s>"),
        })
    }
}

/// A path with a profile: θ̇ = θ′ṡ, θ̈ = θ″ṡ² + θ′s̈.
///
/// Parameters
/// ----------
/// path : Path
///     θ(s).
/// profile : Profile
///     s(t).
///
/// Examples
/// --------
/// >>> import mozzi
/// >>> from mozzi.trajectories import Line, Profile, Timed
/// >>> motion = Timed(Line(mozzi.models.double_pendulum(), [0.0, 0.0], [1.0, 2.0]), Profile.cubic(2.0))
/// >>> motion.at(1.0).dtheta
/// array([0.75, 1.5 ])
#[pyclass(frozen, extends = PyReference, name = "Timed", module = "mozzi.trajectories")]
pub struct PyTimed {
    /// The path, θ(s).
    #[pyo3(get)]
    path: Py<PyPath>,
}

#[pymethods]
impl PyTimed {
    #[new]
    fn new(py: Python<'_>, path: Py<PyPath>, profile: &PyProfile) -> PyClassInitializer<Self> {
        let (model, profile) = (path.get().owner(py), profile.0.clone());
        let reference = PyReference { model, source: Source::Timed(path.clone_ref(py), profile) };
        PyClassInitializer::from(reference).add_subclass(PyTimed { path })
    }

    /// The profile, s(t).
    #[getter]
    fn profile(slf: PyRef<'_, Self>) -> PyResult<PyProfile> {
        match &slf.as_super().source {
            Source::Timed(_, profile) => Ok(PyProfile(profile.clone())),
            _ => Err(refused("this reference has no profile")),
        }
    }
}

/// A motion from a table of times, of any robot.
///
/// Between two rows it is the quintic that meets θ, θ̇ and θ̈ of both; without θ̈, the cubic that meets θ and θ̇;
/// without both, the cubic spline of all rows, at rest at both ends.
///
/// Parameters
/// ----------
/// model : Model
///     The robot.
/// t : array_like, shape (rows,)
///     Increasing times, s, the first not below 0.
/// theta : array_like, shape (rows, nq)
///     Positions: rad or m.
/// dtheta, ddtheta : array_like, shape (rows, n), optional
///     Velocities, rad/s or m/s, and accelerations, rad/s² or m/s².
///
/// Examples
/// --------
/// >>> import mozzi
/// >>> from mozzi.trajectories import Recorded
/// >>> pendulum = mozzi.models.double_pendulum()
/// >>> fall = pendulum.simulate([1.0, 0.0], [0.0, 0.0], 1.0, 100)
/// >>> again = Recorded(pendulum, fall.t, fall.theta, fall.dtheta)
/// >>> bool(abs(again.at(fall.t).theta - fall.theta).max() < 1e-12)
/// True
#[pyclass(frozen, extends = PyReference, name = "Recorded", module = "mozzi.trajectories")]
pub struct PyRecorded;

#[pymethods]
impl PyRecorded {
    #[new]
    #[pyo3(signature = (model, t, theta, dtheta=None, ddtheta=None))]
    fn new(
        model: Py<PyModel>,
        t: &Bound<'_, PyAny>,
        theta: &Bound<'_, PyAny>,
        dtheta: Given<'_, '_>,
        ddtheta: Given<'_, '_>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let robot = &model.get().robot().model;
        let theta = rows("theta", theta, robot.nq())?;
        let t = list("t", t, &[theta.len()])?;
        let rates = |name, given: Given<'_, '_>| given.map(|given| rows(name, given, robot.n())).transpose();
        let (dtheta, ddtheta) = (rates("dtheta", dtheta)?, rates("ddtheta", ddtheta)?);
        let table = Recorded::new(robot, &t, &theta, dtheta.as_deref(), ddtheta.as_deref()).map_err(of_motion)?;
        let reference = PyReference { source: Source::Recorded(table), model };
        Ok(PyClassInitializer::from(reference).add_subclass(PyRecorded))
    }
}

/// Constant positions, at rest.
///
/// Parameters
/// ----------
/// model : Model
///     The robot.
/// theta : array_like, shape (nq,)
///     Positions: rad or m.
///
/// Examples
/// --------
/// >>> import mozzi
/// >>> from mozzi.trajectories import Hold
/// >>> Hold(mozzi.models.double_pendulum(), [0.5, 1.0]).at(3.0).theta
/// array([0.5, 1. ])
#[pyclass(frozen, extends = PyReference, name = "Hold", module = "mozzi.trajectories")]
pub struct PyHold;

#[pymethods]
impl PyHold {
    #[new]
    fn new(model: Py<PyModel>, theta: &Bound<'_, PyAny>) -> PyResult<PyClassInitializer<Self>> {
        let robot = &model.get().robot().model;
        let theta = list("theta", theta, &[robot.nq()])?;
        robot.check_configuration(&theta).map_err(of_model)?;
        if let Some(k) = theta.iter().position(|x| !x.is_finite()) {
            return Err(refused(format!("theta[{k}] is {}, expected a finite number", theta[k])));
        }
        let reference = PyReference { source: Source::Hold(Hold::new(&theta, robot.n())), model };
        Ok(PyClassInitializer::from(reference).add_subclass(PyHold))
    }
}

/// A motion of the joints of a robot with a floating base.
///
/// The base rests at one pose; no motor drives it, and no controller uses its part.
///
/// Parameters
/// ----------
/// model : Model
///     The robot, with a floating base.
/// joints : Reference
///     A motion of the same robot with a fixed base.
/// pose : array_like, shape (7,), optional
///     The base's part of θ: unit quaternion (w, x, y, z), origin, m. Default: at {s}.
///
/// Examples
/// --------
/// >>> import mozzi
/// >>> from mozzi.trajectories import Hold, OfJoints
/// >>> ur5 = mozzi.models.ur5()
/// >>> motion = OfJoints(ur5.with_floating_base(), Hold(ur5, [0.1] * 6))
/// >>> motion.at(0.0).theta.shape
/// (13,)
#[pyclass(frozen, extends = PyReference, name = "OfJoints", module = "mozzi.trajectories")]
pub struct PyOfJoints;

#[pymethods]
impl PyOfJoints {
    #[new]
    #[pyo3(signature = (model, joints, pose=None))]
    fn new(model: Py<PyModel>, joints: Py<PyReference>, pose: Given<'_, '_>) -> PyResult<PyClassInitializer<Self>> {
        let robot = &model.get().robot().model;
        let (found, of) = (joints.get().model().nq(), robot.nq().wrapping_sub(7));
        if !robot.is_floating() {
            return Err(refused(format!("'{}' has a fixed base, expected a floating one", robot.description().name)));
        }
        if found != of {
            return Err(wrong_shape("the motion of the joints", &[found], format!("({of},): the joints of the robot")));
        }
        let mut theta: Vec<f64> = robot.neutral_configuration();
        if let Some(pose) = pose {
            theta[..7].copy_from_slice(&list("pose", pose, &[7])?);
        }
        robot.check_configuration(&theta).map_err(of_model)?;
        let mut pose = [0.0; 7];
        pose.copy_from_slice(&theta[..7]);
        let reference = PyReference { source: Source::OfJoints(joints, pose), model };
        Ok(PyClassInitializer::from(reference).add_subclass(PyOfJoints))
    }
}
