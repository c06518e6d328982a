//! `mozzi.trajectories.Profile`.

use super::instants::Instants;
use crate::failure::of_motion;
use crate::results::named;
use mozzi_motion::Error;
use mozzi_motion::trajectories::{Profile, Progress};
use pyo3::prelude::*;

/// A time scaling s(t) of a path, from s = 0 at t = 0 to s = 1 at the end (Modern Robotics, section 9.2.2).
///
/// Made by `linear`, `cubic`, `quintic`, `trapezoidal`, `trapezoidal_in`, and by `Path.time_optimal` and
/// `Path.stretched`.
///
/// Examples
/// --------
/// >>> from mozzi.trajectories import Profile
/// >>> profile = Profile.cubic(2.0)
/// >>> profile.at(1.0)
/// Progress(s=0.5, ds=0.75, dds=0.0)
/// >>> profile.at([0.0, 0.5, 2.0]).s
/// array([0.     , 0.15625, 1.     ])
#[pyclass(frozen, eq, name = "Profile", module = "mozzi.trajectories")]
#[derive(PartialEq)]
pub struct PyProfile(pub Profile);

fn made(profile: Result<Profile, Error>) -> PyResult<PyProfile> {
    profile.map(PyProfile).map_err(of_motion)
}

#[pymethods]
impl PyProfile {
    /// Make s = t/T, which starts and stops at once; for paths with s in proportion to time.
    ///
    /// Parameters
    /// ----------
    /// duration : float
    ///     T, s.
    ///
    /// Returns
    /// -------
    /// Profile
    #[staticmethod]
    fn linear(duration: f64) -> PyResult<Self> {
        made(Profile::linear(duration))
    }

    /// Make s = 3(t/T)² − 2(t/T)³, at rest at both ends.
    ///
    /// Largest ṡ 1.5/T, largest |s̈| 6/T².
    ///
    /// Parameters
    /// ----------
    /// duration : float
    ///     T, s.
    ///
    /// Returns
    /// -------
    /// Profile
    #[staticmethod]
    fn cubic(duration: f64) -> PyResult<Self> {
        made(Profile::cubic(duration))
    }

    /// Make s = 10(t/T)³ − 15(t/T)⁴ + 6(t/T)⁵, at rest and with s̈ = 0 at both ends.
    ///
    /// Largest ṡ 1.875/T, largest |s̈| 10/(√3 T²).
    ///
    /// Parameters
    /// ----------
    /// duration : float
    ///     T, s.
    ///
    /// Returns
    /// -------
    /// Profile
    #[staticmethod]
    fn quintic(duration: f64) -> PyResult<Self> {
        made(Profile::quintic(duration))
    }

    /// Make a profile of constant acceleration, constant speed and constant deceleration.
    ///
    /// It is a triangle if the speed is not reached.
    ///
    /// Parameters
    /// ----------
    /// speed : float
    ///     Largest ṡ, 1/s.
    /// acceleration : float
    ///     |s̈|, 1/s².
    ///
    /// Returns
    /// -------
    /// Profile
    #[staticmethod]
    fn trapezoidal(speed: f64, acceleration: f64) -> PyResult<Self> {
        made(Profile::trapezoidal(speed, acceleration))
    }

    /// Make a trapezoidal profile of this duration.
    ///
    /// Parameters
    /// ----------
    /// duration : float
    ///     T, s.
    /// part : float
    ///     Part of the duration that accelerates, and that decelerates: 0 < part ≤ 0.5.
    ///
    /// Returns
    /// -------
    /// Profile
    #[staticmethod]
    fn trapezoidal_in(duration: f64, part: f64) -> PyResult<Self> {
        made(Profile::trapezoidal_in(duration, part))
    }

    /// Return the profile scaled to another duration: ṡ scales with the ratio of the durations, s̈ with its square.
    ///
    /// Parameters
    /// ----------
    /// duration : float
    ///     T, s.
    ///
    /// Returns
    /// -------
    /// Profile
    fn in_time(&self, duration: f64) -> PyResult<Self> {
        made(self.0.in_time(duration))
    }

    /// Evaluate s, ṡ and s̈ at one time or at many.
    ///
    /// Parameters
    /// ----------
    /// t : array_like, shape (...)
    ///     Times, s. Before 0 and after the end s is 0 and 1, at rest.
    ///
    /// Returns
    /// -------
    /// Progress
    ///     A named tuple: `s`, `ds`, 1/s, and `dds`, 1/s², each a float or an array of shape (...).
    fn at<'py>(&self, py: Python<'py>, t: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let progress = |t: f64| {
            let Progress { s, ds, dds } = self.0.at(t);
            [s, ds, dds]
        };
        named(py, "Progress", Instants::seconds(t)?.numbers(py, progress)?)
    }

    /// Duration T, s.
    #[getter]
    fn duration(&self) -> f64 {
        self.0.duration()
    }

    fn __repr__(&self) -> String {
        format!("<mozzi.trajectories.Profile of {} s>", mozzi_report::text::scalar(self.0.duration()))
    }
}
