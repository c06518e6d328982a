//! Rollouts under a table of torques, and their vector-Jacobian products.

use super::rollout_method;
use crate::arguments::Given;
use crate::array::{Numbers, common_leading, wrong_shape};
use crate::failure::{of_batch, of_model};
use crate::model::PyModel;
use crate::numpy::Fresh;
use crate::results::named;
use crate::threads::Threads;
use mozzi::Vec3;
use mozzi_engine::{BatchGradient, BatchRollout};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// The arguments of a rollout, broadcast to common leading axes.
struct Inputs<'py> {
    /// θ\[0\], θ̇\[0\] and τ, then the cotangents of θ and θ̇ if there are some.
    tables: Vec<Numbers<'py>>,
    leading: Vec<usize>,
    options: BatchRollout,
}

impl<'py> Inputs<'py> {
    fn new(
        robot: &PyModel,
        start: [&Bound<'py, PyAny>; 3],
        bars: Option<[&Bound<'py, PyAny>; 2]>,
        (step, method): (f64, &str),
        gravity: Given<'_, 'py>,
    ) -> PyResult<Self> {
        let [theta, dtheta, tau] = start;
        let mut tables =
            vec![Numbers::new("theta", theta)?, Numbers::new("dtheta", dtheta)?, Numbers::new("tau", tau)?];
        if let Some([theta_bar, dtheta_bar]) = bars {
            tables.push(Numbers::new("theta_bar", theta_bar)?);
            tables.push(Numbers::new("dtheta_bar", dtheta_bar)?);
        }
        let n = robot.robot().model.n();
        for table in &tables {
            robot.robot().check_shape(table)?;
        }
        let [_, _, tau, ..] = &tables[..] else { unreachable!() };
        let &[.., steps, _] = &tau.shape[..] else {
            return Err(wrong_shape("tau", &tau.shape, format!("(..., N, {n}): a row for each step")));
        };
        for bar in &tables[3..] {
            if !matches!(bar.shape[..], [.., rows, _] if rows == steps + 1) {
                let expected = format!("(..., {}, {n}): a row for each state", steps + 1);
                return Err(wrong_shape(bar.name, &bar.shape, expected));
            }
        }
        let tails = [1, 1, 2, 2, 2];
        let leading = common_leading(tables.iter().zip(tails).map(|(table, tail)| (table.name, table.leading(tail))))?;
        tables.iter_mut().zip(tails).try_for_each(|(table, tail)| table.spread::<f64>(&leading, tail))?;
        let mut options = BatchRollout { method: rollout_method(method)?, ..BatchRollout::new(step, steps) };
        if let Some(gravity) = gravity {
            options.gravity = Some(Vec3(Numbers::fixed("gravity", gravity, "(3,): m/s²")?));
        }
        Ok(Inputs { tables, leading, options })
    }

    fn slice(&self, table: usize) -> PyResult<&[f64]> {
        self.tables[table].slice()
    }

    /// An array with the leading axes and these.
    fn fresh(&self, py: Python<'py>, axes: &[usize]) -> PyResult<Fresh<'py, f64>> {
        Fresh::new(py, &[&self.leading, axes].concat())
    }
}

#[pymethods]
impl PyModel {
    /// Compute the states of N steps under torques that are constant over each step.
    ///
    /// x[k + 1] = Φ(x[k], τ[k]) with x = (θ, θ̇), from one start, or from several at once on all cores. Joint limits
    /// are ignored. A robot with constraints is projected onto them after each step, and requires an explicit method.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (..., nq)
    ///     Positions at the start: rad or m.
    /// dtheta : array_like, shape (..., n)
    ///     Velocities at the start: rad/s or m/s.
    /// tau : array_like, shape (..., N, n)
    ///     The torques of each step: N m or N.
    /// step : float
    ///     The length of a step, s.
    /// method : {'rk4', 'semi-implicit-euler', 'euler', 'midpoint'}
    ///     Integration method, as in `simulate`.
    /// gravity : array_like, shape (3,), optional
    ///     Gravity in the axes of {s}, m/s². Default: the model's.
    /// threads : int, optional
    ///     Maximum number of threads; several starts only. Default: all cores.
    ///
    /// Returns
    /// -------
    /// Rollout
    ///     `theta`, shape (..., N + 1, nq), and `dtheta`, shape (..., N + 1, n), float64: the start and the state after
    ///     each step.
    ///
    /// Raises
    /// ------
    /// DivergedError
    ///     If a state becomes infinite or NaN; the message contains the start's index.
    ///
    /// Examples
    /// --------
    /// >>> import mozzi
    /// >>> import numpy as np
    /// >>> pendulum = mozzi.models.double_pendulum()
    /// >>> theta, dtheta = pendulum.rollout([1.0, 0.0], [0.0, 0.0], np.zeros((100, 2)), 0.01)
    /// >>> theta.shape, dtheta.shape
    /// ((101, 2), (101, 2))
    #[pyo3(signature = (theta, dtheta, tau, step, method="rk4", *, gravity=None, threads=None))]
    #[allow(clippy::too_many_arguments)] // Python's
    fn rollout<'py>(
        slf: &Bound<'py, Self>,
        theta: &Bound<'py, PyAny>,
        dtheta: &Bound<'py, PyAny>,
        tau: &Bound<'py, PyAny>,
        step: f64,
        method: &str,
        gravity: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (py, robot) = (slf.py(), slf.get().robot());
        let (model, given) =
            (&robot.model, Inputs::new(slf.get(), [theta, dtheta, tau], None, (step, method), gravity)?);
        let (options, rows) = (&given.options, given.options.steps + 1);
        let mut theta_table = given.fresh(py, &[rows, model.nq()])?;
        let mut dtheta_table = given.fresh(py, &[rows, model.n()])?;
        let start = [given.slice(0)?, given.slice(1)?, given.slice(2)?];
        let states = [theta_table.numbers(), dtheta_table.numbers()];
        if given.leading.is_empty() {
            let ([theta, dtheta, tau], [theta_table, dtheta_table]) = (start, states);
            py.detach(|| options.of_one(model)?.write_states(theta, dtheta, tau, theta_table, dtheta_table))
                .map_err(of_model)?;
        } else {
            let batch = robot.batch::<f64>(threads)?;
            py.detach(|| batch.rollout(start, options, states)).map_err(|error| of_batch(error, &given.leading))?;
        }
        named(py, "Rollout", vec![theta_table.into_array(), dtheta_table.into_array()])
    }

    /// Compute the vector-Jacobian product of `rollout`, the gradient of a loss L of its states.
    ///
    /// Maps ∂L/∂x[k] of each state to the gradients with respect to the start, the torques of each step and the
    /// parameters. It is the adjoint of the discrete steps, exact to rounding for any step size, and takes about four
    /// times the rollout's time.
    ///
    /// Gradients with respect to θ have n entries, along the velocities: for joints of one axis they are ∂L/∂θ; for a
    /// floating base, a ball or a free joint they are along the body twist (ω, v) in its own coordinates, not along the
    /// entries of the quaternion.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (..., nq)
    ///     Positions at the start: rad or m.
    /// dtheta : array_like, shape (..., n)
    ///     Velocities at the start: rad/s or m/s.
    /// tau : array_like, shape (..., N, n)
    ///     The torques of each step: N m or N.
    /// step : float
    ///     The length of a step, s.
    /// theta_bar : array_like, shape (..., N + 1, n)
    ///     ∂L/∂θ[k], along the velocities.
    /// dtheta_bar : array_like, shape (..., N + 1, n)
    ///     ∂L/∂θ̇[k].
    /// method : {'rk4', 'semi-implicit-euler', 'euler', 'midpoint'}
    ///     Integration method, as in `simulate`.
    /// parameters : bool
    ///     True to return the gradient with respect to the parameters as well.
    /// gravity : array_like, shape (3,), optional
    ///     Gravity in the axes of {s}, m/s². Default: the model's.
    /// threads : int, optional
    ///     Maximum number of threads; several starts only. Default: all cores.
    ///
    /// Returns
    /// -------
    /// tuple of ndarray, float64
    ///     ∂L/∂θ[0], shape (..., n), along the velocities; ∂L/∂θ̇[0], shape (..., n); ∂L/∂τ, shape (..., N, n); and
    ///     with `parameters=True` ∂L/∂π, shape (..., p), with respect to `model.parameters` for each start.
    ///
    /// Raises
    /// ------
    /// DivergedError
    ///     If a state becomes infinite or NaN; the message contains the start's index.
    ///
    /// Examples
    /// --------
    /// >>> import mozzi
    /// >>> import numpy as np
    /// >>> pendulum, tau = mozzi.models.double_pendulum(), np.zeros((100, 2))
    /// >>> theta, dtheta = pendulum.rollout([1.0, 0.0], [0.0, 0.0], tau, 0.01)
    /// >>> theta_bar, dtheta_bar = np.zeros_like(theta), np.zeros_like(dtheta)
    /// >>> theta_bar[-1] = theta[-1]  # of the loss ½‖θ[N]‖²
    /// >>> by_theta, by_dtheta, by_tau = pendulum.rollout_vjp([1.0, 0.0], [0.0, 0.0], tau, 0.01, theta_bar, dtheta_bar)
    /// >>> by_tau.shape
    /// (100, 2)
    #[pyo3(signature = (theta, dtheta, tau, step, theta_bar, dtheta_bar, method="rk4", parameters=false, *, gravity=None, threads=None))]
    #[allow(clippy::too_many_arguments)] // Python's
    fn rollout_vjp<'py>(
        slf: &Bound<'py, Self>,
        theta: &Bound<'py, PyAny>,
        dtheta: &Bound<'py, PyAny>,
        tau: &Bound<'py, PyAny>,
        step: f64,
        theta_bar: &Bound<'py, PyAny>,
        dtheta_bar: &Bound<'py, PyAny>,
        method: &str,
        parameters: bool,
        gravity: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyTuple>> {
        let (py, robot, bars) = (slf.py(), slf.get().robot(), Some([theta_bar, dtheta_bar]));
        let given = Inputs::new(slf.get(), [theta, dtheta, tau], bars, (step, method), gravity)?;
        let (model, options) = (&robot.model, &given.options);
        let (n, p) = (model.n(), if parameters { model.parameter_count() } else { 0 });
        let mut found = [given.fresh(py, &[n])?, given.fresh(py, &[n])?, given.fresh(py, &[options.steps, n])?];
        let mut of_parameters = given.fresh(py, &[p])?;
        let start = [given.slice(0)?, given.slice(1)?, given.slice(2)?];
        let bars = [given.slice(3)?, given.slice(4)?];
        let [theta, dtheta, tau] = found.each_mut().map(Fresh::numbers);
        let gradient = BatchGradient { theta, dtheta, tau, parameters: of_parameters.numbers() };
        if given.leading.is_empty() {
            py.detach(|| {
                let rollout = options.of_one(model)?;
                let mut rollout = if parameters { rollout.with_parameter_gradient() } else { rollout };
                gradient.of_one(&mut rollout, start, bars)
            })
            .map_err(of_model)?;
        } else {
            let batch = robot.batch::<f64>(threads)?;
            py.detach(|| batch.rollout_vjp(start, options, bars, gradient))
                .map_err(|error| of_batch(error, &given.leading))?;
        }
        let mut results: Vec<_> = found.into_iter().map(Fresh::into_array).collect();
        results.extend(parameters.then(|| of_parameters.into_array()));
        PyTuple::new(py, results)
    }
}
