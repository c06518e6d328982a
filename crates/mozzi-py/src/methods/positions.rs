//! Positions are a manifold: ⊕ and ⊖.

use crate::array::list;
use crate::failure::of_model;
use crate::model::{PyModel, array};
use pyo3::prelude::*;

#[pymethods]
impl PyModel {
    /// Compute θ ⊕ h θ̇, the positions after h seconds at constant velocities.
    ///
    /// For joints of one axis it is θ + h θ̇; a floating base, balls and free joints move on their group, and their
    /// quaternions stay unit.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (nq,)
    ///     Positions: rad or m.
    /// dtheta : array_like, shape (n,)
    ///     Velocities: rad/s or m/s.
    /// h : float
    ///     Time, s.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (nq,)
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
        theta: &Bound<'_, PyAny>,
        dtheta: &Bound<'_, PyAny>,
        h: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let model = &self.robot().model;
        let mut theta = list("theta", theta, &[model.nq()])?;
        let dtheta = list("dtheta", dtheta, &[model.n()])?;
        model.check_configuration(&theta).map_err(of_model)?;
        mozzi::model::integrate(model, &mut theta, &dtheta, h);
        array(py, &[theta.len()], theta)
    }

    /// Compute θ₁ ⊖ θ₀, the constant velocities from θ₀ to θ₁ in one second; the inverse of `integrate`.
    ///
    /// Quaternions turn by the shorter rotation.
    ///
    /// Parameters
    /// ----------
    /// theta0, theta1 : array_like, shape (nq,)
    ///     Positions: rad or m.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (n,)
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
        theta0: &Bound<'_, PyAny>,
        theta1: &Bound<'_, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let model = &self.robot().model;
        let theta0 = list("theta0", theta0, &[model.nq()])?;
        let theta1 = list("theta1", theta1, &[model.nq()])?;
        [&theta0, &theta1].into_iter().try_for_each(|theta| model.check_configuration(theta)).map_err(of_model)?;
        let mut difference = vec![0.0; model.n()];
        mozzi::model::difference(model, &theta0, &theta1, &mut difference);
        array(py, &[difference.len()], difference)
    }
}
