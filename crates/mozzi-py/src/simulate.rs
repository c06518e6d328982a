//! Simulation: what drives the robot, from Python's arguments, and the motion as arrays.

use crate::array::Numbers;
use crate::call::named;
use crate::failure::of_model;
use crate::model::{PyModel, array};
use crate::surroundings::Given;
use mozzi::simulation::{Energy, Friction, GravityCompensation, Input, Method, Options, Trajectory, Zero};
use mozzi::{Error, Model, Vec3};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use std::cell::RefCell;
use std::ops::ControlFlow;

/// Motors: constant torques.
struct Constant(Vec<f64>);
impl Input for Constant {
    fn torque(&mut self, _: f64, _: &[f64], _: &[f64], tau: &mut [f64]) -> Result<(), Error> {
        tau.iter_mut().zip(&self.0).for_each(|(tau, x)| *tau += x);
        Ok(())
    }
}

/// Motors: a function of Python. What it raises is kept, and ends the simulation.
struct Function<'a, 'py> {
    model: &'a PyModel,
    function: &'a Bound<'py, PyAny>,
    raised: &'a RefCell<Option<PyErr>>,
}

impl Function<'_, '_> {
    fn call(&self, t: f64, theta: &[f64], dtheta: &[f64], tau: &mut [f64]) -> PyResult<()> {
        let py = self.function.py();
        let list = |x: &[f64]| array(py, &[x.len()], x.iter().copied());
        let answer = self.function.call1((t, list(theta)?, list(dtheta)?))?;
        let mut answer = Numbers::new("tau", &answer)?;
        self.model.robot().check_shape(&answer)?;
        answer.spread::<f64>(&[], 1)?;
        tau.iter_mut().zip(answer.slice::<f64>()?).for_each(|(tau, x)| *tau += x);
        Ok(())
    }
}

impl Input for Function<'_, '_> {
    fn torque(&mut self, t: f64, theta: &[f64], dtheta: &[f64], tau: &mut [f64]) -> Result<(), Error> {
        self.call(t, theta, dtheta, tau).map_err(|error| {
            *self.raised.borrow_mut() = Some(error);
            Error::BadArgument { what: "the torque's function", found: "an exception".into(), expected: "torques" }
        })
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

/// Simulates, and looks now and then whether Python was interrupted.
fn run(
    py: Python<'_>,
    model: &Model,
    start: [&[f64]; 2],
    input: impl Input,
    options: &Options,
    raised: &RefCell<Option<PyErr>>,
) -> PyResult<Trajectory> {
    let progress = |_, _| match py.check_signals() {
        Ok(()) => ControlFlow::Continue(()),
        Err(error) => {
            *raised.borrow_mut() = Some(error);
            ControlFlow::Break(())
        }
    };
    let found = model.simulate_with_progress(start[0], start[1], input, options, progress);
    match raised.borrow_mut().take() {
        Some(error) => Err(error),
        None => found.map_err(of_model),
    }
}

#[pymethods]
impl PyModel {
    /// The motion from (θ(0), θ̇(0)) over `duration` seconds, in `steps` equal steps.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (nq,)
    ///     Positions at the start: rad or m.
    /// dtheta : array_like, shape (n,)
    ///     Velocities at the start: rad/s or m/s.
    /// duration : float
    ///     s.
    /// steps : int
    ///     At least 1.
    /// torque : callable, array_like, 'gravity_compensation' or None
    ///     The motors' τ: `torque(t, theta, dtheta)`, asked at each stage of each step; constant, shape (n,); τ = g(θ); or none.
    /// method : {'rk4', 'semi-implicit-euler', 'euler'}
    ///     How a step is taken.
    /// record_every : int
    ///     Record the start, every k-th step and the last.
    /// gravity : array_like, shape (3,), optional
    ///     In place of the model's own: m/s².
    /// slip_speed : float, optional
    ///     Coulomb friction μ tanh(θ̇ / slip_speed) in place of μ sgn θ̇.
    ///
    /// Returns
    /// -------
    /// Trajectory
    ///     `t`, `theta`, `dtheta`, `ddtheta`, `tau`, and the energies.
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
    #[pyo3(signature = (theta, dtheta, duration, steps, *, torque=None, method="rk4", record_every=1, gravity=None, slip_speed=None))]
    #[allow(clippy::too_many_arguments)] // Python's
    fn simulate<'py>(
        slf: &Bound<'py, Self>,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        dtheta: &Bound<'py, PyAny>,
        duration: f64,
        steps: usize,
        torque: Given<'_, 'py>,
        method: &str,
        record_every: usize,
        gravity: Given<'_, 'py>,
        slip_speed: Option<f64>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let this = slf.get();
        let model = &this.robot().model;
        let vector = |name, given| -> PyResult<Vec<f64>> {
            let mut numbers = Numbers::new(name, given)?;
            this.robot().check_shape(&numbers)?;
            if numbers.shape.len() != 1 {
                let expected = format!("({},): one start", numbers.shape[numbers.shape.len() - 1]);
                return Err(crate::array::wrong_shape(name, &numbers.shape, expected));
            }
            numbers.spread::<f64>(&[], 1)?;
            Ok(numbers.slice::<f64>()?.to_vec())
        };
        let (theta, dtheta) = (vector("theta", theta)?, vector("dtheta", dtheta)?);
        let mut options = Options { method: self::method(method)?, record_every, ..Options::new(duration, steps) };
        if let Some(gravity) = gravity {
            options.gravity = Some(Vec3(Numbers::fixed("gravity", gravity, "(3,): m/s²")?));
        }
        if let Some(slip_speed) = slip_speed {
            options.friction = Friction::Smooth { slip_speed };
        }
        let (start, raised) = ([&theta[..], &dtheta[..]], RefCell::new(None));
        let compensation = || GravityCompensation::against(model, options.gravity.unwrap_or(model.gravity()));
        let found = match torque {
            None => run(py, model, start, Zero, &options, &raised)?,
            Some(function) if function.is_callable() => {
                run(py, model, start, Function { model: this, function, raised: &raised }, &options, &raised)?
            }
            Some(word) if word.is_instance_of::<pyo3::types::PyString>() => match word.extract::<String>()?.as_str() {
                "gravity_compensation" => run(py, model, start, compensation(), &options, &raised)?,
                other => {
                    let expected = "a function, an array or 'gravity_compensation'";
                    return Err(PyTypeError::new_err(format!("torque is '{other}', expected {expected}")));
                }
            },
            Some(tau) => run(py, model, start, Constant(vector("tau", tau)?), &options, &raised)?,
        };
        trajectory(py, slf, found)
    }
}

fn trajectory<'py>(py: Python<'py>, robot: &Bound<'py, PyModel>, found: Trajectory) -> PyResult<Bound<'py, PyAny>> {
    let rows = found.len();
    let names = |names: Vec<&str>| names.into_pyobject(py);
    let energies = |part: fn(&Energy) -> f64| array(py, &[rows], found.energy.iter().map(part));
    let model = &robot.get().robot().model;
    let fields = vec![
        array(py, &[rows], found.t.iter().copied())?,
        array(py, &[rows, found.nq], found.theta.iter().copied())?,
        array(py, &[rows, found.n], found.dtheta.iter().copied())?,
        array(py, &[rows, found.n], found.ddtheta.iter().copied())?,
        array(py, &[rows, found.n], found.tau.iter().copied())?,
        energies(|energy| energy.kinetic)?,
        energies(|energy| energy.potential)?,
        energies(|energy| energy.motor_work)?,
        energies(|energy| energy.friction_loss)?,
        energies(|energy| energy.applied_work)?,
        names(model.position_names().collect())?,
        names(model.velocity_names().collect())?,
        robot.clone().into_any(),
    ];
    named(py, "Trajectory", fields)
}
