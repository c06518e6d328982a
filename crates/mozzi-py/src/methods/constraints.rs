//! Constraints: closing loops, assembly, rank, and constraint wrenches, at one state.

use crate::array::list;
use crate::failure::{of_file, of_model};
use crate::model::{PyModel, array};
use crate::results::named;
use mozzi::Wrench;
use mozzi_urdf::constraints::{self, ConstraintsError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};
use std::path::PathBuf;

impl PyModel {
    /// Positions, and rates with n numbers each.
    pub(super) fn state_of<const K: usize>(
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
        ConstraintsError::File { path, source } if source.raw_os_error().is_some() => of_file(&path, &source),
        error => crate::describe::refused(error),
    }
}

pub(super) fn names(list: &[String]) -> Vec<&str> {
    list.iter().map(String::as_str).collect()
}

pub(super) fn wrenches<'py>(py: Python<'py>, list: &[(String, Wrench)]) -> PyResult<Bound<'py, PyAny>> {
    let found = PyDict::new(py);
    for (name, wrench) in list {
        found.set_item(name, array(py, &[6], wrench.to_array())?)?;
    }
    Ok(found.into_any())
}

#[pymethods]
impl PyModel {
    /// Return a copy with further constraints, which close loops, pin frames or couple joints.
    ///
    /// `simulate`, `rollout` and `constrained_forward_dynamics` satisfy them; `forward_dynamics` is that of the tree.
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
    ///     For an invalid entry; the message contains its place.
    ///
    /// Examples
    /// --------
    /// >>> import mozzi
    /// >>> arm = mozzi.models.two_link_planar()
    /// >>> tip = arm.end_effector
    /// >>> rod = {"name": "rod", "kind": "distance", "length": 0.8, "a": {"frame": None}, "b": {"frame": tip}}
    /// >>> held = arm.with_constraints([rod])
    /// >>> held.constraints[0]["kind"], held.constraint_rank(held.assemble([0.3, 0.5])).freedom
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

    /// Return the tree alone: without constraints, every joint with a motor.
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

    /// Constraints in the form of `with_constraints`; anchors have a matrix `T` (4, 4) in their frame.
    #[getter]
    fn constraints<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let text = constraints::write(self.robot().model.description());
        py.import("json")?.getattr("loads")?.call1((text,))?.get_item("constraints")
    }

    /// Names of the joints that have motors, for `constrained_inverse_dynamics`; None for all.
    #[getter]
    fn motors(&self) -> Option<Vec<&str>> {
        self.robot().model.description().motors.as_deref().map(names)
    }

    /// Names of the constraints' rows: those of A and of the multipliers.
    #[getter]
    fn constraint_row_names(&self) -> Vec<String> {
        self.robot().model.constraint_row_names().collect()
    }

    /// Find positions near a guess that satisfy the constraints.
    ///
    /// Parameters
    /// ----------
    /// guess : array_like, shape (nq,)
    ///     Positions: rad or m.
    /// hold : list of str, optional
    ///     Joints that keep their positions.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (nq,)
    ///     Positions: rad or m.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If none are found; the message contains the constraint with the largest residual.
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

    /// Find the velocities nearest to a guess that satisfy the constraints, A(θ)θ̇ = 0.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (nq,)
    ///     Positions: rad or m.
    /// guess : array_like, shape (n,)
    ///     Velocities: rad/s or m/s.
    /// hold : list of str, optional
    ///     Joints that keep their velocities.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (n,)
    ///     Velocities: rad/s or m/s.
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

    /// Find the accelerations nearest to a guess that satisfy the constraints, A(θ)θ̈ + Ȧ(θ, θ̇)θ̇ = 0.
    ///
    /// Parameters
    /// ----------
    /// theta, dtheta : array_like, shapes (nq,) and (n,)
    ///     Positions, rad or m; velocities, rad/s or m/s.
    /// guess : array_like, shape (n,)
    ///     Accelerations: rad/s² or m/s².
    /// hold : list of str, optional
    ///     Joints that keep their accelerations.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (n,)
    ///     Accelerations: rad/s² or m/s².
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

    /// Compute the rank of the constraints at θ.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (nq,)
    ///     Positions: rad or m.
    ///
    /// Returns
    /// -------
    /// ConstraintRank
    ///     A named tuple: `rows` m; `rank`; `freedom` n − rank; `redundant`, the names of rows that depend on the
    ///     others.
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

    /// Compute the wrenches of the constraints between frames, from the multipliers.
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
}
