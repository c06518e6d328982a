//! `mozzi.conventions`: converts states, forces and matrices to and from the order, frames and signs of Pinocchio and
//! MuJoCo.
#![allow(clippy::wrong_self_convention)] // `from_`: converts from another library's convention, for the robot self

use crate::array::{Numbers, by_rows, common_leading, wrong_shape};
use crate::failure::{of_model, of_state};
use crate::model::PyModel;
use crate::numpy::Fresh;
use mozzi::conventions;
use mozzi::nalgebra::{DMatrix, DVector};
use mozzi::{Error, Jacobian, Twist};
use pyo3::prelude::*;

type Given<'a, 'py> = (&'static str, &'a Bound<'py, PyAny>);
type Found<'py> = PyResult<Bound<'py, PyAny>>;

/// Applies f to each state's vectors and, as an optional last argument, a matrix; the result is a matrix or a column.
fn each<'py, const K: usize>(
    py: Python<'py>,
    vectors: [Given<'_, 'py>; K],
    table: Option<Given<'_, 'py>>,
    is_matrix: bool,
    f: impl Fn([&[f64]; K], Option<DMatrix<f64>>) -> Result<DMatrix<f64>, Error>,
) -> Found<'py> {
    let mut given =
        vectors.into_iter().chain(table).map(|(name, x)| Numbers::new(name, x)).collect::<PyResult<Vec<_>>>()?;
    let axes = |k: usize| if k < K { 1 } else { 2 };
    for (k, numbers) in given.iter().enumerate() {
        if numbers.shape.len() < axes(k) {
            return Err(wrong_shape(numbers.name, &numbers.shape, ["(..., n)", "(..., rows, columns)"][axes(k) - 1]));
        }
    }
    let leading = common_leading(given.iter().enumerate().map(|(k, x)| (x.name, x.leading(axes(k)))))?;
    for (k, numbers) in given.iter_mut().enumerate() {
        numbers.spread::<f64>(&leading, axes(k))?;
    }
    let slices = given.iter().map(Numbers::slice::<f64>).collect::<PyResult<Vec<_>>>()?;
    let tail = |k: usize| &given[k].shape[leading.len()..];
    let states: usize = leading.iter().product();
    // without states one of halves, whose quaternions are units, shows the lengths that are wrong and the shape
    let halves: Vec<Vec<f64>> = (0..given.len()).map(|k| vec![0.5; tail(k).iter().product()]).collect();
    let converted = |index: usize| {
        let part =
            |k: usize| if states == 0 { &halves[k] } else { &slices[k][index * halves[k].len()..][..halves[k].len()] };
        let matrix = table.map(|_| DMatrix::from_row_slice(tail(K)[0], tail(K)[1], part(K)));
        f(std::array::from_fn(part), matrix).map_err(|error| of_state(error, index, &leading))
    };
    let first = converted(0)?;
    let shape = if is_matrix { vec![first.nrows(), first.ncols()] } else { vec![first.nrows()] };
    let mut out = Fresh::<f64>::new(py, &[&leading[..], &shape].concat())?;
    for (index, row) in out.numbers().chunks_exact_mut(first.len().max(1)).enumerate() {
        by_rows(&converted(index)?, row);
    }
    Ok(out.into_array())
}

fn column(x: Result<DVector<f64>, Error>) -> Result<DMatrix<f64>, Error> {
    x.map(|x| DMatrix::from_column_slice(x.len(), 1, x.as_slice()))
}

fn wanted(matrix: Option<DMatrix<f64>>) -> DMatrix<f64> {
    matrix.unwrap_or_else(|| DMatrix::zeros(0, 0))
}

/// Conversions to and from Pinocchio, made by `conventions.Pinocchio`.
#[pyclass(frozen, module = "mozzi._mozzi")]
pub struct Pinocchio(conventions::Pinocchio);

macro_rules! vectors {
    ($of:ty: $($name:ident($($argument:ident),*) $about:literal;)*) => { #[pymethods] impl $of { $(
        #[doc = $about]
        fn $name<'py>(&self, py: Python<'py>, $($argument: &Bound<'py, PyAny>),*) -> Found<'py> {
            each(py, [$((stringify!($argument), $argument)),*], None, false, |[$($argument),*], _| column(self.0.$name($($argument),*)))
        }
    )* } };
}

macro_rules! matrices {
    ($of:ty: $($name:ident($($argument:ident),*) $about:literal;)*) => { #[pymethods] impl $of { $(
        #[doc = $about]
        #[allow(non_snake_case)]
        fn $name<'py>(&self, py: Python<'py>, $($argument: &Bound<'py, PyAny>,)* M: &Bound<'py, PyAny>) -> Found<'py> {
            each(py, [$((stringify!($argument), $argument)),*], Some(("M", M)), true, |[$($argument),*], M| self.0.$name($($argument,)* &wanted(M)))
        }
    )* } };
}

vectors! { Pinocchio:
    configuration(theta) "Convert positions θ, shape (..., nq), to Pinocchio's q.";
    from_configuration(q) "Convert Pinocchio's q to positions θ, shape (..., nq).";
    velocity(dtheta) "Convert velocities θ̇, shape (..., n), to Pinocchio's v.";
    from_velocity(v) "Convert Pinocchio's v to velocities θ̇, shape (..., n).";
    acceleration(ddtheta) "Convert accelerations θ̈, shape (..., n), to Pinocchio's a.";
    from_acceleration(a) "Convert Pinocchio's a to accelerations θ̈, shape (..., n).";
    force(tau) "Convert forces τ, shape (..., n), to Pinocchio's tau.";
    from_force(tau) "Convert Pinocchio's tau to forces τ, shape (..., n).";
}
matrices! { Pinocchio:
    mass_matrix() "Convert a mass matrix, shape (..., n, n), to Pinocchio's.";
    from_mass_matrix() "Convert Pinocchio's mass matrix to mozzi's, shape (..., n, n).";
}

#[pymethods]
impl Pinocchio {
    #[new]
    fn new(model: &PyModel, joints: Option<(Vec<String>, Vec<usize>)>) -> PyResult<Self> {
        let model = &model.robot().model;
        let made = match joints {
            None => conventions::Pinocchio::new(model),
            Some((names, nqs)) => {
                let names: Vec<&str> = names.iter().map(String::as_str).collect();
                conventions::Pinocchio::with_joints(model, &names, &nqs)
            }
        };
        made.map(Pinocchio).map_err(of_model)
    }

    /// Index of mozzi's joint for each of Pinocchio's joints.
    #[getter]
    fn joints(&self) -> Vec<usize> {
        self.0.joints().to_vec()
    }

    /// Number of entries of Pinocchio's q.
    #[getter]
    fn nq(&self) -> usize {
        self.0.nq()
    }

    fn __repr__(&self) -> String {
        format!("<mozzi.conventions.Pinocchio: {} joints, q has {} entries>", self.0.joints().len(), self.0.nq())
    }

    /// Convert a Jacobian, shape (..., 6, n), angular rows first, to Pinocchio's, linear rows first.
    fn jacobian<'py>(&self, py: Python<'py>, J: &Bound<'py, PyAny>) -> Found<'py> {
        each(py, [], Some(("J", J)), true, |[], J| {
            let J = wanted(J);
            if J.nrows() != 6 {
                return Err(Error::WrongLength { what: "a column of J", found: J.nrows(), expected: 6 });
            }
            let columns = J.column_iter().map(|c| Twist::from_array(std::array::from_fn(|row| c[row])));
            self.0.jacobian(&Jacobian(columns.collect()))
        })
    }
}

/// Conversions to and from MuJoCo, made by `conventions.MuJoCo`.
#[pyclass(frozen, module = "mozzi._mozzi")]
pub struct MuJoCo(conventions::MuJoCo);

vectors! { MuJoCo:
    configuration(theta) "Convert positions θ, shape (..., nq), to MuJoCo's qpos.";
    from_configuration(qpos) "Convert MuJoCo's qpos to positions θ, shape (..., nq).";
    velocity(theta, dtheta) "Convert velocities θ̇, shape (..., n), at θ to MuJoCo's qvel.";
    from_velocity(qpos, qvel) "Convert MuJoCo's qvel to velocities θ̇, shape (..., n).";
    acceleration(theta, dtheta, ddtheta) "Convert accelerations θ̈, shape (..., n), at θ and θ̇ to MuJoCo's qacc.";
    from_acceleration(qpos, qvel, qacc) "Convert MuJoCo's qacc to accelerations θ̈, shape (..., n).";
    force(theta, tau) "Convert forces τ, shape (..., n), at θ to MuJoCo's qfrc; for h see `bias_forces`.";
    from_force(qpos, qfrc) "Convert MuJoCo's qfrc to forces τ, shape (..., n).";
}
matrices! { MuJoCo:
    mass_matrix(theta) "Convert a mass matrix, shape (..., n, n), at θ to MuJoCo's.";
    from_mass_matrix(qpos) "Convert MuJoCo's mass matrix to mozzi's, shape (..., n, n).";
}

#[pymethods]
impl MuJoCo {
    #[new]
    fn new(model: &PyModel, joints: Option<Vec<String>>) -> PyResult<Self> {
        let model = &model.robot().model;
        let names: Vec<&str> = match &joints {
            Some(names) => names.iter().map(String::as_str).collect(),
            None => model.moving_joints().map(|joint| joint.name.as_str()).collect(),
        };
        conventions::MuJoCo::with_joints(model, &names).map(MuJoCo).map_err(of_model)
    }

    /// Index of mozzi's joint for each of MuJoCo's joints, without mimic joints.
    #[getter]
    fn joints(&self) -> Vec<usize> {
        self.0.joints().to_vec()
    }

    fn __repr__(&self) -> String {
        format!("<mozzi.conventions.MuJoCo: {} joints>", self.0.joints().len())
    }

    /// Convert h, shape (..., n), at θ and θ̇ to MuJoCo's qfrc_bias, with mozzi's M.
    #[allow(non_snake_case)]
    fn bias_forces<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        dtheta: &Bound<'py, PyAny>,
        M: &Bound<'py, PyAny>,
        h: &Bound<'py, PyAny>,
    ) -> Found<'py> {
        let vectors = [("theta", theta), ("dtheta", dtheta), ("h", h)];
        each(py, vectors, Some(("M", M)), false, |[theta, dtheta, h], M| {
            column(self.0.bias_forces(theta, dtheta, &wanted(M), h))
        })
    }

    /// Convert MuJoCo's qfrc_bias to h, shape (..., n), with mozzi's M.
    #[allow(non_snake_case)]
    fn from_bias_forces<'py>(
        &self,
        py: Python<'py>,
        qpos: &Bound<'py, PyAny>,
        qvel: &Bound<'py, PyAny>,
        M: &Bound<'py, PyAny>,
        qfrc_bias: &Bound<'py, PyAny>,
    ) -> Found<'py> {
        let vectors = [("qpos", qpos), ("qvel", qvel), ("qfrc_bias", qfrc_bias)];
        each(py, vectors, Some(("M", M)), false, |[qpos, qvel, bias], M| {
            column(self.0.from_bias_forces(qpos, qvel, &wanted(M), bias))
        })
    }
}
