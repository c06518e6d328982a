//! `mozzi.trajectories.Path` and its kinds.

use super::frame_path::{pose_of, shape_named};
use super::instants::Instants;
use super::limits::limits;
use super::profile::PyProfile;
use super::repr::positions;
use crate::arguments::Given;
use crate::array::{Numbers, list, wrong_shape};
use crate::describe::refused;
use crate::failure::of_motion;
use crate::interrupt::waited;
use crate::model::PyModel;
use crate::results::named;
use mozzi::Model;
use mozzi_motion::trajectories::{Cartesian, Ends, Line, Path, Point, Spline, stretched, time_optimal};
use pyo3::prelude::*;

/// A path of a robot's joint positions, θ(s) for s from 0 to 1: a `Line`, a `Spline` or a `Cartesian`.
///
/// A `Profile` s(t) turns it into a motion.
#[pyclass(frozen, subclass, name = "Path", module = "mozzi.trajectories")]
pub struct PyPath {
    model: Py<PyModel>,
    curve: Curve,
}

enum Curve {
    /// Its ends.
    Line([Vec<f64>; 2]),
    /// The spline, and the number of its via points.
    Spline(Spline, usize),
    Cartesian(Cartesian),
}

/// A path that threads may share.
pub type SharedPath<'a> = Box<dyn Path + Send + Sync + 'a>;

impl PyPath {
    pub fn model(&self) -> &Model {
        &self.model.get().robot().model
    }

    pub fn owner(&self, py: Python<'_>) -> Py<PyModel> {
        self.model.clone_ref(py)
    }

    /// The name of its class.
    pub fn kind(&self) -> &'static str {
        match self.curve {
            Curve::Line(_) => "Line",
            Curve::Spline(..) => "Spline",
            Curve::Cartesian(_) => "Cartesian",
        }
    }

    /// θ(s).
    ///
    /// # Errors
    /// `ValueError` for the ends of a line that are not positions.
    pub fn path(&self) -> PyResult<SharedPath<'_>> {
        Ok(match &self.curve {
            Curve::Line([from, to]) => Box::new(Line::new(self.model(), from, to).map_err(of_motion)?),
            Curve::Spline(spline, _) => Box::new(spline),
            Curve::Cartesian(path) => Box::new(path),
        })
    }
}

/// Rows of positions.
///
/// # Errors
/// `TypeError`, `ValueError` for another shape.
pub fn rows(name: &'static str, given: &Bound<'_, PyAny>, width: usize) -> PyResult<Vec<Vec<f64>>> {
    let mut numbers = Numbers::new(name, given)?;
    match numbers.shape[..] {
        [_, found] if found == width => {}
        _ => return Err(wrong_shape(name, &numbers.shape, format!("(rows, {width})"))),
    }
    numbers.spread::<f64>(&[], 2)?;
    Ok(numbers.slice::<f64>()?.chunks_exact(width.max(1)).map(<[f64]>::to_vec).collect())
}

/// Places on a path.
///
/// # Errors
/// `TypeError`, `ValueError` outside of 0 to 1.
pub fn places(s: &Bound<'_, PyAny>) -> PyResult<Instants> {
    Instants::new("s", s, 0.0..=1.0, "numbers from 0 to 1")
}

#[pymethods]
impl PyPath {
    /// Evaluate θ, θ′ and θ″ at one place of the path or at many.
    ///
    /// Parameters
    /// ----------
    /// s : array_like, shape (...)
    ///     Places on the path: 0 to 1.
    ///
    /// Returns
    /// -------
    /// PathPoint
    ///     A named tuple: `theta`, shape (..., nq), rad or m; `slope` θ′ and `curvature` θ″, shape (..., n), the
    ///     velocity at ṡ = 1 and its rate.
    ///
    /// Examples
    /// --------
    /// >>> import mozzi
    /// >>> from mozzi.trajectories import Line
    /// >>> line = Line(mozzi.models.double_pendulum(), [0.0, 1.0], [1.0, 3.0])
    /// >>> line.at([0.0, 0.5]).theta
    /// array([[0. , 1. ],
    ///        [0.5, 2. ]])
    fn at<'py>(&self, py: Python<'py>, s: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let (path, model) = (self.path()?, self.model());
        let point = |s: f64| {
            let Point { theta, slope, curvature } = path.at(s);
            [theta, slope, curvature]
        };
        named(py, "PathPoint", places(s)?.rows(py, [model.nq(), model.n(), model.n()], point)?)
    }

    /// Find the fastest profile through this path under limits, at rest at both ends (Pham and Pham 2018).
    ///
    /// Limits are |θ̇| ≤ velocity, |θ̈| ≤ acceleration, |τ| ≤ torque, with τ = M(θ)θ̈ + c(θ, θ̇) + g(θ) + f(θ, θ̇) in
    /// the robot's own gravity.
    ///
    /// Parameters
    /// ----------
    /// velocity, acceleration, torque : array_like, shape (n,) or (), optional
    ///     Limits of each velocity, or one for all: rad/s or m/s, rad/s² or m/s², N m or N; `numpy.inf` for none.
    ///     Default: the velocity and effort limits of the robot's description, and no limit of acceleration.
    /// intervals : int
    ///     Number of equal intervals of s at whose ends the limits hold.
    ///
    /// Returns
    /// -------
    /// Profile
    ///     s(t).
    ///
    /// Raises
    /// ------
    /// MotionError
    ///     If a torque limit cannot hold the robot on the path, or nothing limits its speed.
    ///
    /// Examples
    /// --------
    /// >>> import mozzi
    /// >>> from mozzi.trajectories import Line
    /// >>> line = Line(mozzi.models.ur5(), [0.0, -1.5, 1.5, 0.0, 0.0, 0.0], [1.5, -1.0, 0.5, 0.0, 1.0, 0.0])
    /// >>> 0.5 < line.time_optimal(acceleration=10.0).duration < 1.0
    /// True
    #[pyo3(signature = (*, velocity=None, acceleration=None, torque=None, intervals=200))]
    fn time_optimal<'py>(
        slf: &Bound<'py, Self>,
        velocity: Given<'_, 'py>,
        acceleration: Given<'_, 'py>,
        torque: Given<'_, 'py>,
        intervals: usize,
    ) -> PyResult<PyProfile> {
        let limits = limits(slf.get().model(), velocity, acceleration, torque)?;
        let this = slf.clone().unbind();
        let found = waited(slf.py(), move || {
            let this = this.get();
            time_optimal(this.model(), &this.path()?, &limits, intervals).map_err(of_motion)
        })?;
        found.map(PyProfile)
    }

    /// Scale a profile to the shortest duration that keeps the limits of `time_optimal`.
    ///
    /// Parameters
    /// ----------
    /// profile : Profile
    ///     The shape of s(t); its duration does not matter.
    /// velocity, acceleration, torque : array_like, shape (n,) or (), optional
    ///     As in `time_optimal`.
    /// samples : int
    ///     Number of equal intervals of time at whose ends the limits hold.
    ///
    /// Returns
    /// -------
    /// Profile
    ///     s(t).
    ///
    /// Raises
    /// ------
    /// MotionError
    ///     If a torque limit cannot hold the robot on the path, or nothing limits its speed.
    ///
    /// Examples
    /// --------
    /// >>> import mozzi
    /// >>> from mozzi.trajectories import Line, Profile
    /// >>> line = Line(mozzi.models.double_pendulum(), [0.0, 0.0], [1.0, 0.0])
    /// >>> round(line.stretched(Profile.cubic(1.0), velocity=0.5).duration, 9)  # largest speed 1.5/T
    /// 3.0
    #[pyo3(signature = (profile, *, velocity=None, acceleration=None, torque=None, samples=600))]
    fn stretched<'py>(
        slf: &Bound<'py, Self>,
        profile: &Bound<'py, PyProfile>,
        velocity: Given<'_, 'py>,
        acceleration: Given<'_, 'py>,
        torque: Given<'_, 'py>,
        samples: usize,
    ) -> PyResult<PyProfile> {
        let limits = limits(slf.get().model(), velocity, acceleration, torque)?;
        let (this, profile) = (slf.clone().unbind(), profile.clone().unbind());
        let found = waited(slf.py(), move || {
            let (this, profile) = (this.get(), &profile.get().0);
            stretched(this.model(), &this.path()?, profile, &limits, samples).map_err(of_motion)
        })?;
        found.map(PyProfile)
    }

    /// The robot that moves along the path.
    #[getter(model)]
    fn python_model(&self, py: Python<'_>) -> Py<PyModel> {
        self.owner(py)
    }

    fn __repr__(&self) -> String {
        let course = match &self.curve {
            Curve::Line([from, to]) => format!("from {} to {}", positions(from), positions(to)),
            Curve::Spline(_, points) => format!("through {points} points"),
            Curve::Cartesian(path) => format!("through {} solutions of inverse kinematics", path.knots),
        };
        format!("<mozzi.trajectories.{} of '{}' {course}>", self.kind(), self.model().description().name)
    }
}

/// Straight line of the joints from θ₀ to θ₁, θ₀ ⊕ s(θ₁ ⊖ θ₀); a floating base moves along a screw.
///
/// Parameters
/// ----------
/// model : Model
///     The robot.
/// start, goal : array_like, shape (nq,)
///     θ₀ and θ₁: rad or m.
///
/// Examples
/// --------
/// >>> import mozzi
/// >>> from mozzi.trajectories import Line, Profile, Timed
/// >>> line = Line(mozzi.models.double_pendulum(), [0.0, 0.0], [1.0, -2.0])
/// >>> Timed(line, Profile.quintic(2.0)).at(1.0).theta
/// array([ 0.5, -1. ])
#[pyclass(frozen, extends = PyPath, name = "Line", module = "mozzi.trajectories")]
pub struct PyLine;

#[pymethods]
impl PyLine {
    #[new]
    fn new(
        model: Py<PyModel>,
        start: &Bound<'_, PyAny>,
        goal: &Bound<'_, PyAny>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let nq = model.get().robot().model.nq();
        let ends = [list("start", start, &[nq])?, list("goal", goal, &[nq])?];
        let path = PyPath { model, curve: Curve::Line(ends) };
        path.path()?; // checks the ends
        Ok(PyClassInitializer::from(path).add_subclass(PyLine))
    }
}

/// Cubic spline of the joints through via points.
///
/// Balls, free joints and a floating base pass through theirs without jumps of velocity or acceleration; between two
/// via points they turn by the shorter rotation.
///
/// Parameters
/// ----------
/// model : Model
///     The robot.
/// points : array_like, shape (rows, nq)
///     Via points: rad or m, at least two.
/// s : array_like, shape (rows,), optional
///     Increasing places of the points, which are scaled to 0 … 1. Default: in proportion to the distances
///     ‖θ[k + 1] ⊖ θ[k]‖ between the points.
/// ends : {'natural', 'at rest'}
///     θ″ = 0 at both ends, for a path that a `Profile` runs through; or θ′ = 0, for one with s in proportion to time.
///
/// Examples
/// --------
/// >>> import mozzi
/// >>> from mozzi.trajectories import Spline
/// >>> spline = Spline(mozzi.models.double_pendulum(), [[0, 0], [1, 0], [1, 1]])
/// >>> spline.at(0.5).theta
/// array([1., 0.])
#[pyclass(frozen, extends = PyPath, name = "Spline", module = "mozzi.trajectories")]
pub struct PySpline;

#[pymethods]
impl PySpline {
    #[new]
    #[pyo3(signature = (model, points, s=None, *, ends="natural"))]
    fn new(
        model: Py<PyModel>,
        points: &Bound<'_, PyAny>,
        s: Given<'_, '_>,
        ends: &str,
    ) -> PyResult<PyClassInitializer<Self>> {
        let robot = &model.get().robot().model;
        let ends = match ends {
            "natural" => Ends::Natural,
            "at rest" => Ends::AtRest,
            other => return Err(refused(format!("ends is '{other}', expected 'natural' or 'at rest'"))),
        };
        let points = rows("points", points, robot.nq())?;
        let spline = match s {
            Some(s) => Spline::new(robot, &list("s", s, &[points.len()])?, &points, ends),
            None => Spline::through(robot, &points, ends),
        };
        let path = PyPath { curve: Curve::Spline(spline.map_err(of_motion)?, points.len()), model };
        Ok(PyClassInitializer::from(path).add_subclass(PySpline))
    }
}

/// Path of the joints along a frame's path to a goal pose: a spline through solutions of inverse kinematics.
///
/// Parameters
/// ----------
/// model : Model
///     The robot.
/// start : array_like, shape (nq,)
///     θ₀: rad or m. The frame's path starts at its pose there.
/// goal : array_like, shape (4, 4)
///     The frame's pose at the end, T_sb.
/// frame : str, optional
///     The frame. Default: the end effector.
/// shape : {'screw', 'straight'}
///     'screw': T₀e^{[ξ]s}, one screw motion. 'straight': the origin on a straight line, the orientation R₀e^{[ω]s}.
/// tolerance : float
///     Tolerance on ‖log(T⁻¹T_d)‖, the deviation of the frame from its path, rad and m.
///
/// Raises
/// ------
/// MotionError
///     If the path leaves the robot's reach, or the solutions along it jump, at a singular position or a joint limit.
///
/// Examples
/// --------
/// >>> import mozzi
/// >>> from mozzi.trajectories import Cartesian
/// >>> ur5, start = mozzi.models.ur5(), [0.0, -1.2, 1.5, 0.3, 1.1, 0.0]
/// >>> goal = ur5.forward_kinematics(start)
/// >>> goal[:3, 3] += [-0.1, 0.3, -0.1]
/// >>> path = Cartesian(ur5, start, goal, shape="straight")
/// >>> bool(abs(ur5.forward_kinematics(path.at(1.0).theta) - goal).max() < 1e-6)
/// True
#[pyclass(frozen, extends = PyPath, name = "Cartesian", module = "mozzi.trajectories")]
pub struct PyCartesian {
    #[pyo3(get)]
    /// Largest deviation of the frame from its path, rad and m, evaluated halfway between the spline's points.
    deviation: f64,
    #[pyo3(get)]
    /// Number of solutions of inverse kinematics that the spline interpolates.
    knots: usize,
}

#[pymethods]
impl PyCartesian {
    #[new]
    #[pyo3(signature = (model, start, goal, frame=None, *, shape="screw", tolerance=1e-6))]
    fn new(
        py: Python<'_>,
        model: Py<PyModel>,
        start: &Bound<'_, PyAny>,
        goal: &Bound<'_, PyAny>,
        frame: Option<&str>,
        shape: &str,
        tolerance: f64,
    ) -> PyResult<PyClassInitializer<Self>> {
        let (robot, frame) = (&model.get().robot().model, model.get().frame(frame)?);
        let (start, goal) = (list("start", start, &[robot.nq()])?, pose_of("goal", goal)?);
        let shape = shape_named(shape)?;
        let path = py.detach(|| Cartesian::new(robot, frame, &start, goal, shape, tolerance)).map_err(of_motion)?;
        let found = PyCartesian { deviation: path.deviation, knots: path.knots };
        let path = PyPath { curve: Curve::Cartesian(path), model };
        Ok(PyClassInitializer::from(path).add_subclass(found))
    }
}
