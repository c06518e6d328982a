//! Constraints: what closes loops, assembly, rank, reduction, and dynamics with them, at one state.

use super::closed_form::{environment, matrix, vector};
use crate::arguments::Given;
use crate::array::list;
use crate::failure::of_model;
use crate::model::{PyModel, array};
use crate::results::named;
use mozzi::Wrench;
use mozzi_urdf::constraints::{self, ConstraintsError};
use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};
use std::path::PathBuf;

impl PyModel {
    /// Positions, and rates of n numbers each.
    fn state_of<const K: usize>(
        &self,
        theta: &Bound<'_, PyAny>,
        rates: [(&'static str, &Bound<'_, PyAny>); K],
    ) -> PyResult<(Vec<f64>, [Vec<f64>; K])> {
        let model = &self.robot().model;
        let mut found = [const { Vec::new() }; K];
        for (place, (name, given)) in found.iter_mut().zip(rates) {
            *place = list(name, given, &[model.n()])?;
        }
        Ok((list("theta", theta, &[model.nq()])?, found))
    }

    fn constrained(&self, name: &str, text: &str) -> PyResult<Self> {
        let robot = self.robot().model.description().clone();
        Self::built(constraints::parse(name, text, robot).map_err(of_constraints)?.build())
    }
}

fn of_constraints(error: ConstraintsError) -> PyErr {
    match error {
        ConstraintsError::File { path, source } if source.raw_os_error().is_some() => {
            let words = source.to_string();
            let words = words.split(" (os error").next().unwrap_or_default().to_string();
            PyOSError::new_err((source.raw_os_error(), words, path.to_string_lossy().into_owned()))
        }
        error => crate::describe::refused(error),
    }
}

fn names(list: &[String]) -> Vec<&str> {
    list.iter().map(String::as_str).collect()
}

fn wrenches<'py>(py: Python<'py>, list: &[(String, Wrench)]) -> PyResult<Bound<'py, PyAny>> {
    let found = PyDict::new(py);
    for (name, wrench) in list {
        found.set_item(name, array(py, &[6], wrench.to_array())?)?;
    }
    Ok(found.into_any())
}

#[pymethods]
impl PyModel {
    /// With further constraints, which close loops, pin frames or couple joints; forward dynamics and simulation that
    /// keep them are `constrained_forward_dynamics` and `simulate`.
    ///
    /// Parameters
    /// ----------
    /// constraints : path-like, or list of dict
    ///     A file of constraints in mozzi's JSON or YAML, or a robot.yaml with `closed_loop`; or its entries, such as
    ///     `{"name": "foot", "kind": "point", "a": {"frame": None, "xyz": [0.3, 0, 0]}, "b": {"frame": "foot"}}`.
    /// motors : list of str, optional
    ///     The joints that have motors. Default: those of the file, else as before; at first all joints.
    ///
    /// Returns
    /// -------
    /// Model
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     For an entry that is wrong, with its place.
    ///
    /// Examples
    /// --------
    /// >>> import mozzi
    /// >>> arm = mozzi.models.two_link_planar()
    /// >>> tip = arm.end_effector
    /// >>> rail = {"name": "rod", "kind": "distance", "length": 1.5, "a": {"frame": None}, "b": {"frame": tip}}
    /// >>> held = arm.with_constraints([rail])
    /// >>> held.constraints[0]["kind"], held.constraint_rank([0.3, 0.5]).freedom
    /// ('distance', 1)
    #[pyo3(signature = (constraints, *, motors=None))]
    fn with_constraints(&self, constraints: &Bound<'_, PyAny>, motors: Option<Vec<String>>) -> PyResult<Self> {
        let py = constraints.py();
        let changed = match constraints.extract::<PathBuf>() {
            Ok(path) => {
                let robot = self.robot().model.description().clone();
                Self::built(constraints::read(path, robot).map_err(of_constraints)?.build())?
            }
            Err(_) => {
                let file = PyDict::new(py);
                let entries: Vec<Bound<'_, PyAny>> = constraints.try_iter()?.collect::<PyResult<_>>()?;
                file.set_item("constraints", entries)?;
                let options = PyDict::new(py);
                options.set_item("default", py.import("numpy")?.getattr("ndarray")?.getattr("tolist")?)?;
                let text = py.import("json")?.getattr("dumps")?.call((file,), Some(&options))?;
                self.constrained("constraints", text.cast::<PyString>()?.to_cow()?.as_ref())?
            }
        };
        let Some(motors) = motors else { return Ok(changed) };
        let mut robot = changed.robot().model.description().clone();
        robot.motors = Some(motors);
        Self::built(robot.build())
    }

    /// The tree alone: without constraints, every joint with a motor.
    ///
    /// Returns
    /// -------
    /// Model
    fn without_constraints(&self) -> PyResult<Self> {
        let mut robot = self.robot().model.description().clone();
        robot.constraints.clear();
        robot.motors = None;
        Self::built(robot.build())
    }

    /// The constraints, in the form that `with_constraints` takes; anchors have a matrix `T` (4, 4) in their frame.
    #[getter]
    fn constraints<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let text = constraints::write(self.robot().model.description());
        py.import("json")?.getattr("loads")?.call1((text,))?.get_item("constraints")
    }

    /// The joints that have motors, for `constrained_inverse_dynamics`; None means all.
    #[getter]
    fn motors(&self) -> Option<Vec<&str>> {
        self.robot().model.description().motors.as_deref().map(names)
    }

    /// The names of the constraints' rows: of A, of the multipliers.
    #[getter]
    fn constraint_row_names(&self) -> Vec<String> {
        self.robot().model.constraint_row_names().collect()
    }

    /// Positions near a guess that satisfy the constraints.
    ///
    /// Parameters
    /// ----------
    /// guess : array_like, shape (nq,)
    ///     rad or m.
    /// hold : list of str, optional
    ///     Joints that keep their positions.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (nq,)
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If there are none: the constraint that stays open furthest, and by how much.
    #[pyo3(signature = (guess, *, hold=None))]
    fn assemble<'py>(
        &self,
        py: Python<'py>,
        guess: &Bound<'py, PyAny>,
        hold: Option<Vec<String>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let model = &self.robot().model;
        let guess = list("guess", guess, &[model.nq()])?;
        let found = py.detach(|| model.assemble(&guess, &names(&hold.unwrap_or_default()))).map_err(of_model)?;
        array(py, &[found.len()], found)
    }

    /// Velocities nearest to a guess that satisfy the constraints, A(θ)θ̇ = 0.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (nq,)
    ///     Positions: rad or m.
    /// guess : array_like, shape (n,)
    ///     rad/s or m/s.
    /// hold : list of str, optional
    ///     Joints that keep their velocities.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (n,)
    #[pyo3(signature = (theta, guess, *, hold=None))]
    fn assemble_velocities<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        guess: &Bound<'py, PyAny>,
        hold: Option<Vec<String>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (theta, [guess]) = self.state_of(theta, [("guess", guess)])?;
        let found = self
            .robot()
            .model
            .assemble_velocities(&theta, &guess, &names(&hold.unwrap_or_default()))
            .map_err(of_model)?;
        array(py, &[found.len()], found)
    }

    /// Accelerations nearest to a guess that satisfy the constraints, A(θ)θ̈ + Ȧ(θ, θ̇)θ̇ = 0.
    ///
    /// Parameters
    /// ----------
    /// theta, dtheta : array_like, shapes (nq,) and (n,)
    ///     Positions, rad or m; velocities, rad/s or m/s.
    /// guess : array_like, shape (n,)
    ///     rad/s² or m/s².
    /// hold : list of str, optional
    ///     Joints that keep their accelerations.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (n,)
    #[pyo3(signature = (theta, dtheta, guess, *, hold=None))]
    fn assemble_accelerations<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        dtheta: &Bound<'py, PyAny>,
        guess: &Bound<'py, PyAny>,
        hold: Option<Vec<String>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (theta, [dtheta, guess]) = self.state_of(theta, [("dtheta", dtheta), ("guess", guess)])?;
        let model = &self.robot().model;
        let found = model
            .assemble_accelerations(&theta, &dtheta, &guess, &names(&hold.unwrap_or_default()))
            .map_err(of_model)?;
        array(py, &[found.len()], found)
    }

    /// The rank of the constraints at θ.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (nq,)
    ///     Positions: rad or m.
    ///
    /// Returns
    /// -------
    /// ConstraintRank
    ///     `rows` m; `rank`; `freedom` n − rank; `redundant`, the names of rows that depend on the others.
    fn constraint_rank<'py>(&self, py: Python<'py>, theta: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let model = &self.robot().model;
        let found = model.constraint_rank(&list("theta", theta, &[model.nq()])?).map_err(of_model)?;
        let fields = vec![
            found.rows.into_pyobject(py)?.into_any(),
            found.rank.into_pyobject(py)?.into_any(),
            found.freedom.into_pyobject(py)?.into_any(),
            found.redundant.into_pyobject(py)?.into_any(),
        ];
        named(py, "ConstraintRank", fields)
    }

    /// The wrenches of the constraints between frames.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (nq,)
    ///     Positions: rad or m.
    /// multipliers : array_like, shape (m,)
    ///     λ, such as that of `constrained_forward_dynamics`.
    ///
    /// Returns
    /// -------
    /// dict of str to numpy.ndarray of shape (6,)
    ///     By the constraint's name, the wrench (m, f) that {b} applies to {a}, in the axes of {a} and about the origin
    ///     of {b}: N m, N.
    fn constraint_wrenches<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        multipliers: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let model = &self.robot().model;
        let theta = list("theta", theta, &[model.nq()])?;
        let lambda = list("multipliers", multipliers, &[model.constraint_row_names().count()])?;
        wrenches(py, &model.constraint_wrenches(&theta, &lambda).map_err(of_model)?)
    }

    /// The dynamics of the mechanism in the velocities u of these joints, from which the constraints determine all
    /// others: θ̇ = N u, θ̈ = N u̇ + bias, Nᵀτ = M u̇ + h.
    ///
    /// Parameters
    /// ----------
    /// theta, dtheta : array_like, shapes (nq,) and (n,)
    ///     Positions, rad or m; velocities, rad/s or m/s.
    /// independent : list of str
    ///     Names of joints, one for each degree of freedom.
    /// tip_wrench, gravity, applied_wrenches, base_twist, base_acceleration : optional
    ///     As of `closed_form`.
    ///
    /// Returns
    /// -------
    /// Reduction
    ///     `independent`, the places of u among the velocities; `N` (n, d); `bias` (n,); `M` (d, d); `h` and `g` (d,),
    ///     without friction and springs.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If a joint is not determined by them, or they depend on each other.
    #[pyo3(signature = (theta, dtheta, independent, tip_wrench=None, *, gravity=None, applied_wrenches=None, base_twist=None, base_acceleration=None))]
    #[allow(clippy::too_many_arguments)] // Python's
    fn reduce<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        dtheta: &Bound<'py, PyAny>,
        independent: Vec<String>,
        tip_wrench: Given<'_, 'py>,
        gravity: Given<'_, 'py>,
        applied_wrenches: Given<'_, 'py>,
        base_twist: Given<'_, 'py>,
        base_acceleration: Given<'_, 'py>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let model = &self.robot().model;
        let (theta, [dtheta]) = self.state_of(theta, [("dtheta", dtheta)])?;
        let given = environment(model, [tip_wrench, gravity, applied_wrenches, base_twist, base_acceleration])?;
        let found = model.reduce(&theta, &dtheta, &names(&independent), &given.environment()).map_err(of_model)?;
        let fields = vec![
            found.independent.into_pyobject(py)?.into_any(),
            matrix(py, &found.N)?,
            vector(py, &found.bias)?,
            matrix(py, &found.M)?,
            vector(py, &found.h)?,
            vector(py, &found.g)?,
        ];
        named(py, "Reduction", fields)
    }

    /// The torques of the motors, and λ, of a motion that satisfies the constraints: τ = Mθ̈ + h + f + Aᵀλ, with τ_j =
    /// 0 where no motor is.
    ///
    /// Parameters
    /// ----------
    /// theta, dtheta, ddtheta : array_like, shapes (nq,), (n,) and (n,)
    ///     Positions, rad or m; velocities, rad/s or m/s; accelerations, rad/s² or m/s².
    /// weights : array_like, shape (n,), optional
    ///     If there are more motors than degrees of freedom, τ has the least Σ w_j τ_j². Default: 1.
    /// tip_wrench, gravity, applied_wrenches, base_twist, base_acceleration : optional
    ///     As of `closed_form`.
    ///
    /// Returns
    /// -------
    /// ConstrainedDynamics
    ///     `ddtheta` and `tau` (n,); `multipliers` λ (m,), of least norm; `wrenches`, as of `constraint_wrenches`.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If θ̈ violates a constraint, or a motor is missing, with its joint.
    #[pyo3(signature = (theta, dtheta, ddtheta, tip_wrench=None, *, weights=None, gravity=None, applied_wrenches=None, base_twist=None, base_acceleration=None))]
    #[allow(clippy::too_many_arguments)] // Python's
    fn constrained_inverse_dynamics<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        dtheta: &Bound<'py, PyAny>,
        ddtheta: &Bound<'py, PyAny>,
        tip_wrench: Given<'_, 'py>,
        weights: Given<'_, 'py>,
        gravity: Given<'_, 'py>,
        applied_wrenches: Given<'_, 'py>,
        base_twist: Given<'_, 'py>,
        base_acceleration: Given<'_, 'py>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let model = &self.robot().model;
        let (theta, [dtheta, ddtheta]) = self.state_of(theta, [("dtheta", dtheta), ("ddtheta", ddtheta)])?;
        let weights = weights.map(|given| list("weights", given, &[model.n()])).transpose()?;
        let given = environment(model, [tip_wrench, gravity, applied_wrenches, base_twist, base_acceleration])?;
        let found = model
            .constrained_inverse_dynamics(&theta, &dtheta, &ddtheta, &given.environment(), weights.as_deref())
            .map_err(of_model)?;
        let fields = vec![
            vector(py, &found.ddtheta)?,
            vector(py, &found.tau)?,
            vector(py, &found.lambda)?,
            wrenches(py, &found.wrenches)?,
        ];
        named(py, "ConstrainedDynamics", fields)
    }

    /// The derivatives of θ̈ and λ of `constrained_forward_dynamics` at one state.
    ///
    /// Parameters
    /// ----------
    /// theta, dtheta, tau : array_like, shapes (nq,), (n,) and (n,)
    ///     Positions, rad or m; velocities, rad/s or m/s; torques, N m or N.
    /// tip_wrench, gravity, applied_wrenches, base_twist, base_acceleration : optional
    ///     As of `closed_form`.
    ///
    /// Returns
    /// -------
    /// ConstrainedForwardDynamicsDerivatives
    ///     `d_theta`, `d_dtheta`, `d_tau` (n, n) of θ̈; `multipliers_d_theta`, `multipliers_d_dtheta`,
    ///     `multipliers_d_tau` (m, n) of λ.
    #[pyo3(signature = (theta, dtheta, tau, tip_wrench=None, *, gravity=None, applied_wrenches=None, base_twist=None, base_acceleration=None))]
    #[allow(clippy::too_many_arguments)] // Python's
    fn constrained_forward_dynamics_derivatives<'py>(
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
    ) -> PyResult<Bound<'py, PyAny>> {
        let model = &self.robot().model;
        let (theta, [dtheta, tau]) = self.state_of(theta, [("dtheta", dtheta), ("tau", tau)])?;
        let given = environment(model, [tip_wrench, gravity, applied_wrenches, base_twist, base_acceleration])?;
        let found = model
            .constrained_forward_dynamics_derivatives(&theta, &dtheta, &tau, &given.environment())
            .map_err(of_model)?;
        let all = [
            &found.d_theta,
            &found.d_dtheta,
            &found.d_tau,
            &found.lambda_d_theta,
            &found.lambda_d_dtheta,
            &found.lambda_d_tau,
        ];
        let fields = all.into_iter().map(|M| matrix(py, M)).collect::<PyResult<Vec<_>>>()?;
        named(py, "ConstrainedForwardDynamicsDerivatives", fields)
    }
}
