//! `mozzi.controllers.Saturated`.

use super::controller::PyController;
use super::states::States;
use crate::array::Numbers;
use crate::describe::refused;
use crate::failure::{of_model, of_state};
use crate::model::PyModel;
use crate::numpy::Fresh;
use crate::results::named;
use mozzi::Model;
use mozzi_motion::Policy;
use mozzi_motion::controllers::{Overload, Saturated};
use mozzi_sim::Input;
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::PyList;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Motors with effort limits, which a controller or any function of (t, θ, θ̇) drives.
///
/// Parameters
/// ----------
/// model : Model
///     The robot whose effort limits are used.
/// torque : callable
///     `torque(t, theta, dtheta)` returns τ, shape (..., n); for example a `Controller`.
/// policy : {'respect', 'report', 'ignore'}
///     'respect' clamps τ to the limits and records the demand, 'report' only records it, 'ignore' does neither.
///
/// Examples
/// --------
/// >>> import mozzi
/// >>> from mozzi.controllers import Saturated
/// >>> ur5 = mozzi.models.ur5()
/// >>> motors = Saturated(ur5, lambda t, theta, dtheta: [500.0, 0, 0, 0, 0, -1.0])
/// >>> motors(0.0, [0.0] * 6, [0.0] * 6)
/// array([150.,   0.,   0.,   0.,   0.,  -1.])
/// >>> motors.overloads
/// [Overload(joint='shoulder_pan_joint', largest=500.0, limit=150.0, first=0.0, last=0.0)]
#[pyclass(frozen, name = "Saturated", module = "mozzi.controllers")]
pub struct PySaturated {
    model: Py<PyModel>,
    torque: Py<PyAny>,
    motors: Mutex<Saturated<Asked>>,
}

/// The torques before limiting.
struct Asked(Vec<f64>);

impl Input for Asked {
    fn torque(&mut self, _: f64, _: &[f64], _: &[f64], tau: &mut [f64]) -> Result<(), mozzi_sim::Error> {
        tau.iter_mut().zip(&self.0).for_each(|(tau, x)| *tau += x);
        Ok(())
    }
}

/// Motors of a controller need the robot's joints.
///
/// # Errors
/// `ValueError` for a controller of another robot.
pub fn check_motors(robot: &Model, torque: &Bound<'_, PyAny>) -> PyResult<()> {
    let same = |of: &Model| robot.check_same_joints("the controller's robot", of).map_err(of_model);
    if let Ok(controller) = torque.cast::<PyController>() {
        same(controller.get().robot())
    } else if let Ok(motors) = torque.cast::<PySaturated>() {
        same(&motors.get().model.get().robot().model)
    } else {
        Ok(())
    }
}

impl PySaturated {
    fn motors(&self) -> MutexGuard<'_, Saturated<Asked>> {
        self.motors.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[pymethods]
impl PySaturated {
    #[new]
    #[pyo3(signature = (model, torque, policy="respect"))]
    fn new(model: Py<PyModel>, torque: &Bound<'_, PyAny>, policy: &str) -> PyResult<Self> {
        let policy = match policy {
            "respect" => Policy::Respect,
            "report" => Policy::Report,
            "ignore" => Policy::Ignore,
            other => return Err(refused(format!("policy is '{other}', expected 'respect', 'report' or 'ignore'"))),
        };
        if !torque.is_callable() {
            let kind = torque.get_type().name()?;
            let why = format!("torque is a {kind}, expected a function of (t, theta, dtheta)");
            return Err(pyo3::exceptions::PyTypeError::new_err(why));
        }
        check_motors(&model.get().robot().model, torque)?;
        let motors = Mutex::new(Saturated::new(&model.get().robot().model, Asked(Vec::new()), policy));
        Ok(PySaturated { torque: torque.clone().unbind(), motors, model })
    }

    /// Compute the motors' τ within the limits, at one state or at many.
    ///
    /// Parameters
    /// ----------
    /// t : array_like, shape (...)
    ///     Times, s.
    /// theta : array_like, shape (..., nq)
    ///     Positions: rad or m.
    /// dtheta : array_like, shape (..., n)
    ///     Velocities: rad/s or m/s.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (..., n)
    ///     τ: N m or N.
    fn __call__<'py>(
        &self,
        py: Python<'py>,
        t: &Bound<'py, PyAny>,
        theta: &Bound<'py, PyAny>,
        dtheta: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let model = self.model.get();
        let (states, n) = (States::new(model, t, theta, dtheta)?, model.robot().model.n());
        let answer = self.torque.bind(py).call1((t, theta, dtheta))?;
        let mut asked = Numbers::new("tau", &answer)?;
        model.robot().check_shape(&asked)?;
        asked.spread::<f64>(&states.leading, 1)?;
        let mut tau = Fresh::<f64>::new(py, &[&states.leading[..], &[n]].concat())?;
        let mut motors = self.motors();
        let rows = states.rows()?.zip(asked.slice::<f64>()?.chunks_exact(n.max(1)));
        for (index, (((t, theta, dtheta), asked), tau)) in
            rows.zip(tau.numbers().chunks_exact_mut(n.max(1))).enumerate()
        {
            motors.input.0 = asked.to_vec();
            motors.torque(t, theta, dtheta, tau).map_err(|error| of_state(error, index, &states.leading))?;
        }
        drop(motors);
        Ok(tau.into_array())
    }

    /// Joints whose demanded torque exceeded the limit since construction: a list of `Overload`.
    #[getter]
    fn overloads<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let notes: Vec<Overload> = self.motors().overloads().cloned().collect();
        let tuple = |Overload { joint, largest, limit, first, last }: Overload| {
            let numbers = [largest, limit, first, last].map(|x| x.into_bound_py_any(py));
            let fields = std::iter::once(joint.into_bound_py_any(py)).chain(numbers).collect::<PyResult<Vec<_>>>()?;
            named(py, "Overload", fields)
        };
        PyList::new(py, notes.into_iter().map(tuple).collect::<PyResult<Vec<_>>>()?)
    }

    /// The robot whose effort limits are used.
    #[getter]
    fn model(&self, py: Python<'_>) -> Py<PyModel> {
        self.model.clone_ref(py)
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let robot = &self.model.get().robot().model.description().name;
        Ok(format!("<mozzi.controllers.Saturated of '{robot}': {}>", self.torque.bind(py).repr()?))
    }
}
