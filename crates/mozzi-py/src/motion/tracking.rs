//! `mozzi.controllers.tracking_error`.

use super::reference::PyReference;
use crate::array::{Numbers, wrong_shape};
use crate::failure::of_model;
use crate::model::{PyModel, array};
use crate::results::named;
use mozzi_motion::controllers::tracking_error_of_rows;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

/// Compute the tracking error e = θ_d ⊖ θ of each joint over a simulated motion, or over many.
///
/// A floating base has no desired motion and is left out.
///
/// Parameters
/// ----------
/// motion : Trajectory or Trajectories
///     A result of `Model.simulate`.
/// reference : Reference
///     The desired motion.
///
/// Returns
/// -------
/// TrackingError
///     A named tuple: `rms`, √(mean of e²), and `largest`, max |e|, shape (..., n) without a floating base: rad or m.
///     Its `worst` and `worst_rms` are the largest of all joints.
///
/// Examples
/// --------
/// >>> import mozzi
/// >>> from mozzi.controllers import tracking_error
/// >>> from mozzi.trajectories import Hold
/// >>> arm = mozzi.models.two_link_planar()
/// >>> held = arm.simulate([0.5, 0.0], [0.0, 0.0], 1.0, 10, torque="gravity_compensation")
/// >>> tracking_error(held, Hold(arm, [0.0, 0.0])).largest.round(12)
/// array([0.5, 0. ])
#[pyfunction]
pub fn tracking_error<'py>(
    py: Python<'py>,
    motion: &Bound<'py, PyAny>,
    reference: &PyReference,
) -> PyResult<Bound<'py, PyAny>> {
    let model = motion.getattr("model").ok().and_then(|model| model.cast_into::<PyModel>().ok());
    let Some(model) = model else {
        let kind = motion.get_type().name()?;
        let why = format!("motion is a {kind}, expected the Trajectory or Trajectories of a simulation");
        return Err(PyTypeError::new_err(why));
    };
    let model = &model.get().robot().model;
    model.check_same_joints("the reference's robot", reference.model()).map_err(of_model)?;
    let numbers = |name| Numbers::new(name, &motion.getattr(name)?);
    let (mut t, mut theta) = (numbers("t")?, numbers("theta")?);
    let [rows] = t.shape[..] else { return Err(wrong_shape("t", &t.shape, "(rows,)")) };
    match theta.shape[..] {
        [.., found, width] if (found, width) == (rows, model.nq()) => {}
        _ => return Err(wrong_shape("theta", &theta.shape, format!("(..., {rows}, {})", model.nq()))),
    }
    let leading = theta.leading(2).to_vec();
    t.spread::<f64>(&[], 1)?;
    theta.spread::<f64>(&leading, 2)?;
    let (t, theta, reference) = (t.slice::<f64>()?, theta.slice::<f64>()?, reference.reference()?);
    let one = |k: usize| {
        let motion = &theta[k * rows * model.nq()..(k + 1) * rows * model.nq()];
        tracking_error_of_rows(model, t.iter().copied().zip(motion.chunks_exact(model.nq().max(1))), &reference)
    };
    let all: Vec<_> = (0..leading.iter().product()).map(one).collect();
    let shape = [&leading[..], &[model.n() - model.base().velocities()]].concat();
    let fields = vec![
        array(py, &shape, all.iter().flat_map(|error| error.rms.iter().copied()))?,
        array(py, &shape, all.iter().flat_map(|error| error.largest.iter().copied()))?,
    ];
    named(py, "TrackingError", fields)
}
