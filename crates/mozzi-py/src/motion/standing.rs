//! `mozzi.controllers.Standing`.

use super::controller::{ControlLaw, PyController, gains};
use super::reference::PyReference;
use crate::model::PyModel;
use crate::simulate::contacts::{Fixed, listed};
use pyo3::prelude::*;

/// Standing on feet, with contact forces within their friction cones (Kuindersma et al. 2016).
///
/// In each state a small quadratic program finds accelerations near θ̈_d + K_d ė + K_p e and forces of the feet, which
/// rest on the plane z = 0 and press with ‖f_t‖ ≤ μ f_n; τ has no part for a floating base.
///
/// Parameters
/// ----------
/// model : Model
///     The controller's model of the robot.
/// reference : Reference
///     The desired motion, most often `Hold`.
/// feet : list of str or dict
///     The points that stay on the ground, as `contacts` of `Model.simulate`; `friction` is μ.
/// p, d : array_like, shape (n,) or ()
///     K_p, 1/s², and K_d, 1/s, of each velocity, or one for all: not negative.
///
/// Examples
/// --------
/// >>> import mozzi
/// >>> from mozzi.controllers import Standing
/// >>> from mozzi.trajectories import Hold
/// >>> anymal, pose = mozzi.models.anymal(), mozzi.models.anymal().neutral_configuration
/// >>> pose[7:] = [0.0, 0.7, -1.0] * 2 + [0.0, -0.7, 1.0] * 2
/// >>> feet = ["LF_FOOT", "RF_FOOT", "LH_FOOT", "RH_FOOT"]
/// >>> pose[6] -= min(anymal.forward_kinematics(pose, frame=foot)[2, 3] for foot in feet)
/// >>> control = Standing(anymal, Hold(anymal, pose), feet, p=144.0, d=24.0)
/// >>> held = anymal.simulate(pose, None, 0.1, 50, torque=control, contacts=feet)
/// >>> bool(abs(held.theta[-1] - pose).max() < 1e-3)
/// True
#[pyclass(frozen, extends = PyController, name = "Standing", module = "mozzi.controllers")]
pub struct PyStanding;

#[pymethods]
impl PyStanding {
    #[new]
    #[pyo3(signature = (model, reference, feet, *, p, d))]
    fn new(
        model: Py<PyModel>,
        reference: Py<PyReference>,
        feet: &Bound<'_, PyAny>,
        p: &Bound<'_, PyAny>,
        d: &Bound<'_, PyAny>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let points = listed("feet", feet)?;
        let feet = Fixed::new(&model.get().robot().model, Some(&points), None)?.contacts().points;
        let law = ControlLaw::Standing { gains: gains(&model, [("p", p), ("d", d)])?, feet };
        Ok(PyClassInitializer::from(PyController::checked(model, reference, law)?).add_subclass(PyStanding))
    }
}
