//! Simulation: the arguments, for one start and for many.

mod many;
mod one;

use crate::arguments::Given;
use crate::array::{Numbers, common_leading};
use crate::model::PyModel;
use crate::threads::Threads;
use mozzi::Vec3;
use mozzi::simulation::{Friction, Method, Options};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyString;

/// What the motors do.
enum Torque<'a, 'py> {
    None,
    Constant(Numbers<'py>),
    GravityCompensation,
    Function(&'a Bound<'py, PyAny>),
}

impl<'a, 'py> Torque<'a, 'py> {
    fn new(robot: &PyModel, given: Given<'a, 'py>) -> PyResult<Self> {
        let Some(given) = given else { return Ok(Torque::None) };
        if given.is_callable() {
            return Ok(Torque::Function(given));
        }
        if given.is_instance_of::<PyString>() {
            return match given.extract::<String>()?.as_str() {
                "gravity_compensation" => Ok(Torque::GravityCompensation),
                other => {
                    let expected = "a function, an array or 'gravity_compensation'";
                    Err(PyTypeError::new_err(format!("torque is '{other}', expected {expected}")))
                }
            };
        }
        let tau = Numbers::new("tau", given)?;
        robot.robot().check_shape(&tau)?;
        Ok(Torque::Constant(tau))
    }
}

fn method(name: &str) -> PyResult<Method> {
    match name {
        "rk4" => Ok(Method::RungeKutta4),
        "semi-implicit-euler" => Ok(Method::SemiImplicitEuler),
        "euler" => Ok(Method::Euler),
        _ => {
            let expected = "'rk4', 'semi-implicit-euler' or 'euler'";
            Err(PyValueError::new_err(format!("method is '{name}', expected {expected}")))
        }
    }
}

#[pymethods]
impl PyModel {
    /// The motion from (θ(0), θ̇(0)) over `duration` seconds, in `steps` equal steps; from many starts, many motions at once, on all cores.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (..., nq)
    ///     Positions at the start: rad or m.
    /// dtheta : array_like, shape (..., n)
    ///     Velocities at the start: rad/s or m/s.
    /// duration : float
    ///     s.
    /// steps : int
    ///     At least 1.
    /// torque : callable, array_like, 'gravity_compensation' or None
    ///     The motors' τ: `torque(t, theta, dtheta)`, asked at each stage of each step; constant, shape (..., n); τ = g(θ) + k(θ − θ₀), what holds
    ///     gravity and springs; or none. Of many
    ///     starts the function is asked once for all of them, with arrays of shapes (..., nq) and (..., n), and answers (..., n).
    /// method : {'rk4', 'semi-implicit-euler', 'euler'}
    ///     How a step is taken.
    /// record_every : int
    ///     Record the start, every k-th step and the last.
    /// gravity : array_like, shape (3,), optional
    ///     In place of the model's own: m/s².
    /// slip_speed : float, optional
    ///     Coulomb friction μ tanh(θ̇ / slip_speed) in place of μ sgn θ̇. One start only.
    /// threads : int, optional
    ///     As many at most; by default all cores. Many starts only.
    ///
    /// Returns
    /// -------
    /// Trajectory, or Trajectories where there are leading axes
    ///     `t`, shape (rows,); `theta`, shape (..., rows, nq); `dtheta`, `ddtheta`, `tau`, shape (..., rows, n); and the energies, shape
    ///     (..., rows). Works, such as `motor_work`, of one start alone.
    ///
    /// Raises
    /// ------
    /// DivergedError
    ///     Where a state leaves the numbers, with the start's place among many.
    ///
    /// Examples
    /// --------
    /// >>> import mozzi
    /// >>> pendulum = mozzi.models.double_pendulum()
    /// >>> fall = pendulum.simulate([1.0, 0.0], [0.0, 0.0], 1.0, 1000)
    /// >>> fall.theta.shape
    /// (1001, 2)
    /// >>> bool(abs(fall.energy - fall.energy[0]).max() < 1e-6)
    /// True
    /// >>> import numpy as np
    /// >>> starts = np.random.default_rng(1).uniform(-1, 1, (50, 2))
    /// >>> falls = pendulum.simulate(starts, [0.0, 0.0], 1.0, 100, record_every=10)
    /// >>> falls.t.shape, falls.theta.shape
    /// ((11,), (50, 11, 2))
    #[pyo3(signature = (theta, dtheta, duration, steps, *, torque=None, method="rk4", record_every=1, gravity=None, slip_speed=None, threads=None))]
    #[allow(clippy::too_many_arguments)] // Python's
    fn simulate<'py>(
        slf: &Bound<'py, Self>,
        theta: &Bound<'py, PyAny>,
        dtheta: &Bound<'py, PyAny>,
        duration: f64,
        steps: usize,
        torque: Given<'_, 'py>,
        method: &str,
        record_every: usize,
        gravity: Given<'_, 'py>,
        slip_speed: Option<f64>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let this = slf.get();
        let numbers = |name, given| -> PyResult<Numbers<'py>> {
            let numbers = Numbers::new(name, given)?;
            this.robot().check_shape(&numbers)?;
            Ok(numbers)
        };
        let (mut theta, mut dtheta) = (numbers("theta", theta)?, numbers("dtheta", dtheta)?);
        let mut options = Options { method: self::method(method)?, record_every, ..Options::new(duration, steps) };
        if let Some(gravity) = gravity {
            options.gravity = Some(Vec3(Numbers::fixed("gravity", gravity, "(3,): m/s²")?));
        }
        if let Some(slip_speed) = slip_speed {
            options.friction = Friction::Smooth { slip_speed };
        }
        let mut torque = Torque::new(this, torque)?;
        let mut tables = vec![&mut theta, &mut dtheta];
        if let Torque::Constant(tau) = &mut torque {
            tables.push(tau);
        }
        let leading = common_leading(tables.iter().map(|table| (table.name, table.leading(1))))?;
        tables.into_iter().try_for_each(|table| table.spread::<f64>(&leading, 1))?;
        let start = [theta.slice()?, dtheta.slice()?];
        match slip_speed {
            _ if leading.is_empty() => one::simulate(slf, start, torque, &options),
            None => many::simulate(slf, &leading, start, torque, &options, gravity, threads),
            Some(speed) => {
                let expected = "None of many starts: their joints' friction is μ sgn θ̇";
                Err(PyValueError::new_err(format!("slip_speed is {speed}, expected {expected}")))
            }
        }
    }
}
