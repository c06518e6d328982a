//! States at one time or many, as arrays broadcast along common leading axes: the arguments of controllers.

use crate::array::{Numbers, common_leading};
use crate::model::PyModel;
use pyo3::prelude::*;

/// t, θ and θ̇.
pub struct States<'py> {
    pub leading: Vec<usize>,
    t: Numbers<'py>,
    theta: Numbers<'py>,
    dtheta: Numbers<'py>,
}

impl<'py> States<'py> {
    /// # Errors
    /// `TypeError`, `ValueError` for shapes that do not match the robot or each other.
    pub fn new(
        model: &PyModel,
        t: &Bound<'py, PyAny>,
        theta: &Bound<'py, PyAny>,
        dtheta: &Bound<'py, PyAny>,
    ) -> PyResult<Self> {
        let (mut t, mut theta, mut dtheta) =
            (Numbers::new("t", t)?, Numbers::new("theta", theta)?, Numbers::new("dtheta", dtheta)?);
        model.robot().check_shape(&theta)?;
        model.robot().check_shape(&dtheta)?;
        let tables = [(&t, 0), (&theta, 1), (&dtheta, 1)];
        let leading = common_leading(tables.map(|(table, axes)| (table.name, table.leading(axes))))?;
        t.spread::<f64>(&leading, 0)?;
        theta.spread::<f64>(&leading, 1)?;
        dtheta.spread::<f64>(&leading, 1)?;
        Ok(States { leading, t, theta, dtheta })
    }

    /// The states, one after the other.
    ///
    /// # Errors
    /// Only NumPy's.
    pub fn rows(&self) -> PyResult<impl Iterator<Item = (f64, &[f64], &[f64])>> {
        let (nq, n) = (self.theta.shape[self.leading.len()], self.dtheta.shape[self.leading.len()]);
        let (t, theta, dtheta) = (self.t.slice::<f64>()?, self.theta.slice::<f64>()?, self.dtheta.slice::<f64>()?);
        Ok(t.iter().enumerate().map(move |(k, &t)| (t, &theta[k * nq..(k + 1) * nq], &dtheta[k * n..(k + 1) * n])))
    }
}
