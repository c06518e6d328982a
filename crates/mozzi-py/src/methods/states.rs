//! Named states: those in the robot's file, and the initial state.

use crate::array::list;
use crate::failure::of_model;
use crate::model::{PyModel, array};
use crate::results::named;
use mozzi::model::State;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Python's named tuple of a state.
fn tuple(py: Python<'_>, State { time, theta, dtheta }: State) -> PyResult<Bound<'_, PyAny>> {
    let list = |numbers: Vec<f64>| array(py, &[numbers.len()], numbers);
    named(py, "State", vec![list(theta)?, list(dtheta)?, time.into_pyobject(py)?.into_any()])
}

#[pymethods]
impl PyModel {
    /// The states that the robot's file names, such as MuJoCo's keyframes: `{name: State}`, in its order.
    #[getter]
    fn states<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (model, states) = (&self.robot().model, PyDict::new(py));
        for name in model.state_names() {
            states.set_item(name, tuple(py, model.state(name).map_err(of_model)?)?)?;
        }
        Ok(states)
    }

    /// The initial state, a `State`: the one that the file names, such as MuJoCo's `qpos0`, else rest at 0.
    ///
    /// Rest at 0 has all joints at 0 and a floating base at {s}.
    #[getter]
    fn start<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        tuple(py, self.robot().model.start())
    }

    /// Return the state of this name.
    ///
    /// Parameters
    /// ----------
    /// name : str
    ///     One of `states`.
    ///
    /// Returns
    /// -------
    /// State
    ///     A named tuple: `theta`, shape (nq,), rad or m; `dtheta`, shape (n,), rad/s or m/s; `time`, s.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     For an unknown name; the message lists the known ones.
    ///
    /// Examples
    /// --------
    /// >>> import mozzi
    /// >>> ur5 = mozzi.models.ur5().with_state("home", [0, -1.2, 1.5, 0.3, 1.1, 0])
    /// >>> ur5.state("home").theta[1]
    /// np.float64(-1.2)
    fn state<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        tuple(py, self.robot().model.state(name).map_err(of_model)?)
    }

    /// Return a copy with a named state; it replaces a state of this name.
    ///
    /// Parameters
    /// ----------
    /// name : str
    ///     Name of the state.
    /// theta : array_like, shape (nq,)
    ///     Positions: rad or m.
    /// dtheta : array_like, shape (n,), optional
    ///     Velocities: rad/s or m/s. Default: 0.
    /// time : float
    ///     Time, s.
    ///
    /// Returns
    /// -------
    /// Model
    #[pyo3(signature = (name, theta, dtheta=None, *, time=0.0))]
    fn with_state(
        &self,
        name: &str,
        theta: &Bound<'_, PyAny>,
        dtheta: Option<&Bound<'_, PyAny>>,
        time: f64,
    ) -> PyResult<Self> {
        let model = &self.robot().model;
        let theta = list("theta", theta, &[model.nq()])?;
        let rates = |given| list("dtheta", given, &[model.n()]);
        let dtheta = dtheta.map_or_else(|| Ok(vec![0.0; model.n()]), rates)?;
        Self::built(model.with_state(name, &State { time, theta, dtheta }))
    }

    /// Return a copy whose initial state is this one of its states.
    ///
    /// Parameters
    /// ----------
    /// name : str
    ///     One of `states`.
    ///
    /// Returns
    /// -------
    /// Model
    fn with_start(&self, name: &str) -> PyResult<Self> {
        Self::built(self.robot().model.with_start(name))
    }
}
