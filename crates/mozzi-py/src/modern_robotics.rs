//! The functions behind `mozzi.modern_robotics`: they take the book's lists at every call, as the Modern Robotics
//! package does.

use crate::array::{Numbers, shown, wrong_shape};
use crate::describe::{pose, refused};
use crate::failure::{of_model, of_motion};
use crate::model::{PyModel, array};
use crate::motion::Instants;
use crate::numpy::{self, Fresh};
use mozzi::quantities::{ForwardDynamics, InverseDynamics, MassMatrix};
use mozzi::{
    Environment, HomeFrames, Mat3, Model, SE3, SO3, ScrewAxis, Screws, SpatialInertia, Twist, Vec3, Wrench, fast,
};
use mozzi_motion::trajectories::Profile;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyList, PyTuple};

type Given<'a, 'py> = &'a Bound<'py, PyAny>;
type Found<'py> = PyResult<Bound<'py, PyAny>>;

/// log T. At half a turn, which has two solutions, the package's: the last component of ω that is not 0 is positive.
fn logarithm(T: SE3) -> Twist {
    let V @ Twist { w, v } = T.log();
    let R = T.R.matrix().rows();
    let is_half_turn = (R[0][0] + R[1][1] + R[2][2] - 1.0) / 2.0 <= -1.0;
    let theta = w.norm();
    let is_near_zero = |x: f64| 2.0 * (x / theta).powi(2) < 1e-6; // the package's, of the diagonal of 1 + R
    if !is_half_turn || w.0.into_iter().rfind(|&x| !is_near_zero(x)).is_none_or(|last| last > 0.0) {
        return V;
    }
    // 2π − θ the other way about the same axis, along which it moves as far
    let (other, along) = ((theta - core::f64::consts::TAU) / theta, w * (w.dot(v) / (theta * theta)));
    Twist { w: w * other, v: (v - along) * other + along }
}

fn hat(V: Twist) -> [[f64; 4]; 4] {
    let [a, b, c, x, y, z] = V.to_array();
    [[0.0, -c, b, x], [c, 0.0, -a, y], [-b, a, 0.0, z], [0.0; 4]]
}

fn matrix<'py, const R: usize, const C: usize>(py: Python<'py>, M: [[f64; C]; R]) -> Found<'py> {
    array(py, &[R, C], M.into_iter().flatten())
}

/// Digits may be truncated to this, as those of rotations.
const TRUNCATED: f64 = 1e-3;

/// Refuses a matrix with an upper left part other than [ω], such as a rotation.
fn check_antisymmetric<const N: usize>(name: &str, W: &[[f64; N]; N]) -> PyResult<()> {
    for i in 0..3 {
        for j in i..3 {
            let (x, y) = (W[i][j], W[j][i]);
            if (x + y).abs() > TRUNCATED * x.abs().max(y.abs()).max(1.0) {
                let expected = if i == j { "expected 0" } else { "expected opposite numbers" };
                let found = match i == j {
                    true => format!("entry ({i}, {i}) is {x}"),
                    false => format!("entries ({i}, {j}) and ({j}, {i}) are {x} and {y}"),
                };
                return Err(PyValueError::new_err(format!("{name}: {found}, {expected}: [ω] is antisymmetric")));
            }
        }
    }
    Ok(())
}

#[pyfunction]
fn exp3<'py>(py: Python<'py>, so3mat: Given<'_, 'py>) -> Found<'py> {
    let W = Numbers::matrix::<3, 3>("so3mat", so3mat, "(3, 3)")?;
    check_antisymmetric("so3mat", &W)?;
    matrix(py, SO3::exp(Vec3([W[2][1], W[0][2], W[1][0]])).matrix().rows())
}

#[pyfunction]
fn log3<'py>(py: Python<'py>, R: Given<'_, 'py>) -> Found<'py> {
    let R = SO3::from_rounded_matrix(Mat3::from_rows(Numbers::matrix("R", R, "(3, 3)")?)).map_err(refused)?;
    let [x, y, z, _] = hat(logarithm(SE3::new(R, Vec3::zero())));
    matrix(py, [x, y, z].map(|[a, b, c, _]| [a, b, c]))
}

#[pyfunction]
fn exp6<'py>(py: Python<'py>, se3mat: Given<'_, 'py>) -> Found<'py> {
    let V = Numbers::matrix::<4, 4>("se3mat", se3mat, "(4, 4)")?;
    check_antisymmetric("se3mat", &V)?;
    if let Some(x) = V[3].iter().find(|x| x.abs() > TRUNCATED) {
        return Err(PyValueError::new_err(format!("se3mat: the last row has {x}, expected zeros, as in [V]")));
    }
    let twist = Twist { w: Vec3([V[2][1], V[0][2], V[1][0]]), v: Vec3([V[0][3], V[1][3], V[2][3]]) };
    matrix(py, SE3::exp(twist).to_matrix())
}

#[pyfunction]
fn log6<'py>(py: Python<'py>, T: Given<'_, 'py>) -> Found<'py> {
    matrix(py, hat(logarithm(pose(Numbers::matrix("T", T, "(4, 4)")?)?)))
}

#[pyfunction]
fn adjoint<'py>(py: Python<'py>, T: Given<'_, 'py>) -> Found<'py> {
    matrix(py, pose(Numbers::matrix("T", T, "(4, 4)")?)?.Ad().to_matrix())
}

#[pyfunction]
fn bracket<'py>(py: Python<'py>, V: Given<'_, 'py>) -> Found<'py> {
    matrix(py, Twist::from_array(Numbers::fixed("V", V, "(6,)")?).ad().to_matrix())
}

/// One number for each joint.
fn per_joint(name: &'static str, given: Given) -> PyResult<Vec<f64>> {
    let mut numbers = Numbers::new(name, given)?;
    if numbers.shape.len() != 1 {
        return Err(wrong_shape(name, &numbers.shape, "(n,)"));
    }
    numbers.spread::<f64>(&[], 1)?;
    Ok(numbers.slice::<f64>()?.to_vec())
}

/// The first n columns.
fn columns(name: &'static str, given: Given, n: usize) -> PyResult<Vec<Twist>> {
    let mut numbers = Numbers::new(name, given)?;
    let width = match numbers.shape[..] {
        [6, width] if width >= n => width,
        _ => return Err(wrong_shape(name, &numbers.shape, format!("(6, {n}): a screw axis in each column"))),
    };
    numbers.spread::<f64>(&[], 2)?;
    let S = numbers.slice::<f64>()?;
    Ok((0..n).map(|j| Twist::from_array(std::array::from_fn(|row| S[row * width + j]))).collect())
}

/// The first matrices of a list, or of an array.
fn first<const K: usize>(name: &'static str, given: Given, count: usize) -> PyResult<Vec<[[f64; K]; K]>> {
    let one = |(place, item): (usize, Bound<'_, PyAny>)| -> PyResult<[[f64; K]; K]> {
        if let Some((&[k, l], numbers)) = numpy::view::<f64>(&item)
            && (k, l) == (K, K)
        {
            return Ok(square(numbers));
        }
        let mut numbers = Numbers::new(name, &item)?;
        if numbers.shape != [K, K] {
            return Err(wrong_shape(&format!("{name}[{place}]"), &numbers.shape, shown(&[K, K])));
        }
        numbers.spread::<f64>(&[], 2)?;
        Ok(square(numbers.slice::<f64>()?))
    };
    let short = |length: usize| {
        Err(PyValueError::new_err(format!("{name} has {length} matrices, expected {count} for this many joints")))
    };
    if let Ok(list) = given.cast::<PyList>() {
        return if list.len() < count {
            short(list.len())
        } else {
            list.iter().take(count).enumerate().map(one).collect()
        };
    }
    if let Ok(tuple) = given.cast::<PyTuple>() {
        return if tuple.len() < count {
            short(tuple.len())
        } else {
            tuple.iter().take(count).enumerate().map(one).collect()
        };
    }
    let mut numbers = Numbers::new(name, given)?;
    match numbers.shape[..] {
        [length, k, l] if (k, l) == (K, K) && length < count => return short(length),
        [_, k, l] if (k, l) == (K, K) => {}
        _ => return Err(wrong_shape(name, &numbers.shape, format!("({count}, {K}, {K})"))),
    }
    numbers.spread::<f64>(&[], 3)?;
    Ok(numbers.slice::<f64>()?.chunks(K * K).take(count).map(square).collect())
}

fn square<const K: usize>(numbers: &[f64]) -> [[f64; K]; K] {
    std::array::from_fn(|row| std::array::from_fn(|column| numbers[row * K + column]))
}

#[pyfunction]
fn forward_kinematics<'py>(
    py: Python<'py>,
    M: Given<'_, 'py>,
    screws: Given<'_, 'py>,
    thetalist: Given<'_, 'py>,
    in_body: bool,
) -> Found<'py> {
    let theta = per_joint("thetalist", thetalist)?;
    let (M, screws) = (pose(Numbers::matrix("M", M, "(4, 4)")?)?, columns("the screw axes", screws, theta.len())?);
    let product = if in_body {
        mozzi::kinematics::body_product_of_exponentials
    } else {
        mozzi::kinematics::product_of_exponentials
    };
    matrix(py, product(M, &screws, &theta).to_matrix())
}

#[pyfunction]
fn jacobian<'py>(py: Python<'py>, screws: Given<'_, 'py>, thetalist: Given<'_, 'py>, in_body: bool) -> Found<'py> {
    let theta = per_joint("thetalist", thetalist)?;
    let mut screws = columns("the screw axes", screws, theta.len())?;
    let turn =
        if in_body { mozzi::kinematics::body_jacobian_of_screws } else { mozzi::kinematics::space_jacobian_of_screws };
    turn(&mut screws, &theta);
    let (n, columns) = (screws.len(), screws.into_iter().map(Twist::to_array).collect::<Vec<_>>());
    array(py, &[6, n], (0..6).flat_map(|row| columns.iter().map(move |column| column[row])))
}

/// The model of the lists, and the magnitude k of each axis: the model's θ is k times the package's, and the package's
/// τ is k times the model's.
fn chain(n: usize, Mlist: Given, Glist: Given, Slist: Given) -> PyResult<(Model, Vec<f64>)> {
    let home = first::<4>("Mlist", Mlist, n + 1)?;
    let numbered = |(k, T): (usize, [[f64; 4]; 4])| {
        pose(T).map_err(|error| PyValueError::new_err(format!("Mlist[{k}]: {}", error.value(Mlist.py()))))
    };
    let home = home.into_iter().enumerate().map(numbered).collect::<PyResult<Vec<_>>>()?;
    let inertias = first::<6>("Glist", Glist, n)?;
    let inertias = inertias.into_iter().enumerate().map(|(k, G)| {
        SpatialInertia::from_matrix(G).map_err(|error| PyValueError::new_err(format!("Glist[{k}]: {error}")))
    });
    let inertias = inertias.collect::<PyResult<Vec<_>>>()?;
    let (mut axes, mut sizes) = (Vec::with_capacity(n), Vec::with_capacity(n));
    for (j, screw) in columns("Slist", Slist, n)?.into_iter().enumerate() {
        let (axis, size) = match ScrewAxis::normalize(screw) {
            Ok(found) => found,
            // a joint that does not move anything: any axis is valid
            Err(_) if screw == Twist::zero() => (ScrewAxis::new([0.0, 0.0, 1.0], [0.0; 3]).map_err(refused)?, 0.0),
            Err(error) => return Err(PyValueError::new_err(format!("Slist, column {j}: {error}"))),
        };
        axes.push(axis);
        sizes.push(size);
    }
    let model = Model::from_screws("robot", HomeFrames::Relative(&home), &inertias, Screws::Space(&axes));
    Ok((model.map_err(of_model)?, sizes))
}

fn scaled(mut x: Vec<f64>, sizes: &[f64]) -> Vec<f64> {
    x.iter_mut().zip(sizes).for_each(|(x, k)| *x *= k);
    x
}

/// The model of the lists for many states, with the size of each axis.
#[pyfunction]
fn model_of_lists<'py>(
    py: Python<'py>,
    n: usize,
    Mlist: Given<'_, 'py>,
    Glist: Given<'_, 'py>,
    Slist: Given<'_, 'py>,
) -> PyResult<(PyModel, Bound<'py, PyAny>)> {
    let (model, sizes) = chain(n, Mlist, Glist, Slist)?;
    Ok((PyModel::of(model), array(py, &[n], sizes)?))
}

/// τ; without θ̇ and θ̈, g or F their part is 0.
#[pyfunction]
#[allow(clippy::too_many_arguments)] // the package's
fn inverse_dynamics<'py>(
    py: Python<'py>,
    thetalist: Given<'_, 'py>,
    dthetalist: Option<Given<'_, 'py>>,
    ddthetalist: Option<Given<'_, 'py>>,
    g: Option<Given<'_, 'py>>,
    Ftip: Option<Given<'_, 'py>>,
    Mlist: Given<'_, 'py>,
    Glist: Given<'_, 'py>,
    Slist: Given<'_, 'py>,
) -> Found<'py> {
    let theta = per_joint("thetalist", thetalist)?;
    let n = theta.len();
    let (model, sizes) = chain(n, Mlist, Glist, Slist)?;
    let rates = |name, given: Option<_>| of_length(name, given.map_or(Ok(vec![0.0; n]), |x| per_joint(name, x))?, n);
    let (dtheta, ddtheta) = (rates("dthetalist", dthetalist)?, rates("ddthetalist", ddthetalist)?);
    let applied = wrench(&model, Ftip)?;
    let environment = Environment { gravity: gravity(g)?, applied: &applied, ..model.environment() };
    let (theta, dtheta) = (scaled(theta, &sizes), scaled(dtheta, &sizes));
    let mut tau = Fresh::<f64>::new(py, &[n])?;
    let mut workspace = fast::Workspace::new(&model);
    let ddtheta = scaled(ddtheta, &sizes);
    let inputs: [&[f64]; 3] = [&theta, &dtheta, &ddtheta];
    fast::evaluate(&InverseDynamics.into(), &model, &inputs, &environment, &mut workspace, &mut [tau.numbers()]);
    tau.numbers().iter_mut().zip(&sizes).for_each(|(tau, k)| *tau *= k);
    Ok(tau.into_array())
}

#[pyfunction]
fn mass_matrix<'py>(
    py: Python<'py>,
    thetalist: Given<'_, 'py>,
    Mlist: Given<'_, 'py>,
    Glist: Given<'_, 'py>,
    Slist: Given<'_, 'py>,
) -> Found<'py> {
    let theta = per_joint("thetalist", thetalist)?;
    let n = theta.len();
    let (model, sizes) = chain(n, Mlist, Glist, Slist)?;
    let mut M = Fresh::<f64>::new(py, &[n, n])?;
    let (theta, mut workspace) = (scaled(theta, &sizes), fast::Workspace::new(&model));
    fast::evaluate(&MassMatrix.into(), &model, &[&theta], &model.environment(), &mut workspace, &mut [M.numbers()]);
    for (place, x) in M.numbers().iter_mut().enumerate() {
        *x *= sizes[place / n] * sizes[place % n];
    }
    Ok(M.into_array())
}

#[pyfunction]
#[allow(clippy::too_many_arguments)] // the package's
fn forward_dynamics<'py>(
    py: Python<'py>,
    thetalist: Given<'_, 'py>,
    dthetalist: Given<'_, 'py>,
    taulist: Given<'_, 'py>,
    g: Given<'_, 'py>,
    Ftip: Given<'_, 'py>,
    Mlist: Given<'_, 'py>,
    Glist: Given<'_, 'py>,
    Slist: Given<'_, 'py>,
) -> Found<'py> {
    let theta = per_joint("thetalist", thetalist)?;
    let n = theta.len();
    let (model, sizes) = chain(n, Mlist, Glist, Slist)?;
    let dtheta = scaled(of_length("dthetalist", per_joint("dthetalist", dthetalist)?, n)?, &sizes);
    let mut tau = of_length("taulist", per_joint("taulist", taulist)?, n)?;
    tau.iter_mut().zip(&sizes).for_each(|(tau, k)| *tau /= k);
    let applied = wrench(&model, Some(Ftip))?;
    let environment = Environment { gravity: gravity(Some(g))?, applied: &applied, ..model.environment() };
    let mut workspace = fast::Workspace::new(&model);
    let mut ddtheta = Fresh::<f64>::new(py, &[n])?;
    let theta = scaled(theta, &sizes);
    let (query, inputs): (_, [&[f64]; 3]) = (&ForwardDynamics.into(), [&theta, &dtheta, &tau]);
    let found = fast::compute(query, &model, &inputs, &environment, &mut workspace, &mut [ddtheta.numbers()]);
    let why = match found {
        Err(error) => Some(error.to_string()),
        Ok(()) if sizes.contains(&0.0) => {
            Some("Slist has a column of zeros: nothing says how fast such a joint speeds up".into())
        }
        Ok(()) => None,
    };
    if let Some(why) = why {
        // raises the same error as the package's inverse of the mass matrix
        let error = py.import("numpy.linalg")?.getattr("LinAlgError")?.call1((why,))?;
        return Err(PyErr::from_value(error));
    }
    ddtheta.numbers().iter_mut().zip(&sizes).for_each(|(x, k)| *x /= k);
    Ok(ddtheta.into_array())
}

fn of_length(name: &'static str, x: Vec<f64>, n: usize) -> PyResult<Vec<f64>> {
    if x.len() == n { Ok(x) } else { Err(wrong_shape(name, &[x.len()], format!("({n},), as thetalist"))) }
}

fn gravity(g: Option<Given>) -> PyResult<Vec3> {
    g.map_or(Ok(Vec3::zero()), |g| Numbers::fixed("g", g, "(3,)").map(Vec3))
}

fn wrench(model: &Model, Ftip: Option<Given>) -> PyResult<Vec<(mozzi::FrameId, Wrench)>> {
    let Some(Ftip) = Ftip else { return Ok(Vec::new()) };
    let wrench = Wrench::from_array(Numbers::fixed("Ftip", Ftip, "(6,): (m, f)")?);
    Ok(vec![(model.end_effector().map_err(of_model)?, wrench)])
}

/// s of t/T: cubic for 3, else quintic; its polynomial goes on outside of 0 to 1.
#[pyfunction]
fn time_scaling<'py>(py: Python<'py>, x: Given<'_, 'py>, method: i64) -> Found<'py> {
    let profile = if method == 3 { Profile::cubic(1.0) } else { Profile::quintic(1.0) }.map_err(of_motion)?;
    Ok(Instants::any("t/T", x)?.numbers(py, |x| [profile.continued(x).s])?.swap_remove(0))
}

/// The functions, as a module of the compiled part.
pub fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let functions = PyModule::new(module.py(), "_modern_robotics")?;
    functions.add_function(wrap_pyfunction!(exp3, &functions)?)?;
    functions.add_function(wrap_pyfunction!(log3, &functions)?)?;
    functions.add_function(wrap_pyfunction!(exp6, &functions)?)?;
    functions.add_function(wrap_pyfunction!(log6, &functions)?)?;
    functions.add_function(wrap_pyfunction!(adjoint, &functions)?)?;
    functions.add_function(wrap_pyfunction!(bracket, &functions)?)?;
    functions.add_function(wrap_pyfunction!(forward_kinematics, &functions)?)?;
    functions.add_function(wrap_pyfunction!(jacobian, &functions)?)?;
    functions.add_function(wrap_pyfunction!(model_of_lists, &functions)?)?;
    functions.add_function(wrap_pyfunction!(inverse_dynamics, &functions)?)?;
    functions.add_function(wrap_pyfunction!(mass_matrix, &functions)?)?;
    functions.add_function(wrap_pyfunction!(forward_dynamics, &functions)?)?;
    functions.add_function(wrap_pyfunction!(time_scaling, &functions)?)?;
    module.add("_modern_robotics", functions)
}
