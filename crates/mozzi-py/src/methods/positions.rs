//! Positions are a manifold: ⊕ and ⊖.

use crate::array::{Numbers, common_leading, wrong_shape};
use crate::failure::of_model;
use crate::model::{PyModel, array};
use pyo3::prelude::*;

/// Lists of these lengths, by their common leading axes.
struct Pairs<'py> {
    lists: [Numbers<'py>; 2],
    lengths: [usize; 2],
    leading: Vec<usize>,
}

impl<'py> Pairs<'py> {
    fn new(given: [(&'static str, &Bound<'py, PyAny>, usize); 2]) -> PyResult<Self> {
        let [a, b] = given.map(|(name, given, _)| Numbers::new(name, given));
        let (mut lists, lengths) = ([a?, b?], given.map(|(.., length)| length));
        for (list, length) in lists.iter().zip(lengths) {
            if list.shape.last() != Some(&length) {
                return Err(wrong_shape(list.name, &list.shape, format!("(..., {length})")));
            }
        }
        let leading = common_leading(lists.iter().map(|list| (list.name, list.leading(1))))?;
        lists.iter_mut().try_for_each(|list| list.spread::<f64>(&leading, 1))?;
        Ok(Pairs { lists, lengths, leading })
    }

    /// A list for each pair, of `length` numbers.
    fn each(
        &self,
        py: Python<'py>,
        length: usize,
        of_one: impl Fn([&[f64]; 2]) -> PyResult<Vec<f64>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let [a, b] = [self.lists[0].slice::<f64>()?, self.lists[1].slice::<f64>()?];
        let row = |list: usize, k: usize| k * self.lengths[list]..(k + 1) * self.lengths[list];
        let all = (0..self.leading.iter().product()).map(|k| of_one([&a[row(0, k)], &b[row(1, k)]]));
        let all = all.collect::<PyResult<Vec<_>>>()?;
        array(py, &[&self.leading[..], &[length]].concat(), all.into_iter().flatten())
    }
}

#[pymethods]
impl PyModel {
    /// Compute θ ⊕ h θ̇, the positions after h seconds at constant velocities.
    ///
    /// For joints of one axis it is θ + h θ̇; a floating base, balls and free joints move on their group, and their
    /// quaternions stay unit.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (..., nq)
    ///     Positions: rad or m.
    /// dtheta : array_like, shape (..., n)
    ///     Velocities: rad/s or m/s.
    /// h : float
    ///     Time, s.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (..., nq)
    ///     Positions: rad or m.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     For another length, or a quaternion that is not unit.
    ///
    /// Examples
    /// --------
    /// >>> import mozzi
    /// >>> mozzi.models.double_pendulum().integrate([0.5, 0], [1, 2], 0.1).tolist()
    /// [0.6, 0.2]
    #[pyo3(signature = (theta, dtheta, h=1.0))]
    fn integrate<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        dtheta: &Bound<'py, PyAny>,
        h: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let model = &self.robot().model;
        let pairs = Pairs::new([("theta", theta, model.nq()), ("dtheta", dtheta, model.n())])?;
        pairs.each(py, model.nq(), |[theta, dtheta]| {
            model.check_configuration(theta).map_err(of_model)?;
            let mut theta = theta.to_vec();
            mozzi::model::integrate(model, &mut theta, dtheta, h);
            Ok(theta)
        })
    }

    /// Compute θ₁ ⊖ θ₀, the constant velocities from θ₀ to θ₁ in one second; the inverse of `integrate`.
    ///
    /// Quaternions turn by the shorter rotation.
    ///
    /// Parameters
    /// ----------
    /// theta0, theta1 : array_like, shape (..., nq)
    ///     Positions: rad or m.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (..., n)
    ///     Velocities: rad/s or m/s.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     For another length, or a quaternion that is not unit.
    ///
    /// Examples
    /// --------
    /// >>> import mozzi
    /// >>> mozzi.models.double_pendulum().difference([0.5, 0], [1, 2]).tolist()
    /// [0.5, 2.0]
    fn difference<'py>(
        &self,
        py: Python<'py>,
        theta0: &Bound<'py, PyAny>,
        theta1: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let model = &self.robot().model;
        let pairs = Pairs::new([("theta0", theta0, model.nq()), ("theta1", theta1, model.nq())])?;
        pairs.each(py, model.n(), |both| {
            both.into_iter().try_for_each(|theta| model.check_configuration(theta)).map_err(of_model)?;
            let mut difference = vec![0.0; model.n()];
            mozzi::model::difference(model, both[0], both[1], &mut difference);
            Ok(difference)
        })
    }
}
