//! Quantities for study, at one state: the book's matrices, the recursion's intermediate results, base parameters.

use crate::arguments::{Arguments, Given};
use crate::array::{Numbers, by_rows, wrong_shape};
use crate::describe::refused;
use crate::environment::ArrayEnvironment;
use crate::failure::of_model;
use crate::model::{PyModel, array};
use crate::results::named;
use crate::signature::Slot;
use mozzi::nalgebra::{DMatrix, DVector};
use mozzi::{BodyFrame, Twist, Wrench};
use pyo3::prelude::*;

/// The environment's arguments in numpydoc's form.
macro_rules! environment {
    () => {
        "tip_wrench : array_like, shape (6,), optional
    Wrench (m, f) that the end effector applies to the environment, in its own coordinates: N m, N.
gravity : array_like, shape (3,), optional
    Gravity in the axes of {s}, m/s². Default: the model's.
applied_wrenches : dict of str to array_like of shape (6,), optional
    Wrench (m, f) that each frame applies to the environment, in its own coordinates: N m, N.
base_twist, base_acceleration : array_like, shape (6,), optional
    Twist (ω, v) and acceleration (ω̇, v̇) of {s}. Default: at rest."
    };
}

pub(super) fn matrix<'py>(py: Python<'py>, M: &DMatrix<f64>) -> PyResult<Bound<'py, PyAny>> {
    let mut numbers = vec![0.0; M.len()];
    by_rows(M, &mut numbers);
    array(py, &[M.nrows(), M.ncols()], numbers)
}

pub(super) fn vector<'py>(py: Python<'py>, x: &DVector<f64>) -> PyResult<Bound<'py, PyAny>> {
    array(py, &[x.len()], x.iter().copied())
}

impl PyModel {
    fn one_state<const K: usize>(&self, state: [(&'static str, &Bound<'_, PyAny>); K]) -> PyResult<[Vec<f64>; K]> {
        let mut found = [const { Vec::new() }; K];
        for (place, (name, given)) in found.iter_mut().zip(state) {
            let mut numbers = Numbers::new(name, given)?;
            self.robot().check_shape(&numbers)?;
            if let [_, _, ..] = numbers.shape[..] {
                let last = numbers.shape[numbers.shape.len() - 1];
                return Err(wrong_shape(name, &numbers.shape, format!("({last},): one state")));
            }
            numbers.spread::<f64>(&[], 1)?;
            *place = numbers.slice::<f64>()?.to_vec();
        }
        Ok(found)
    }
}

/// The environment of one state.
pub(super) fn environment<'py>(model: &mozzi::Model, given: [Given<'_, 'py>; 5]) -> PyResult<ArrayEnvironment<'py>> {
    let slots = [Slot::TipWrench, Slot::Gravity, Slot::AppliedWrenches, Slot::BaseTwist, Slot::BaseAcceleration];
    ArrayEnvironment::one_state(model, &Arguments::of(slots.into_iter().zip(given)))
}

#[pymethods]
impl PyModel {
    /// Compute the book's stacked matrices at one state (Modern Robotics, section 8.4).
    ///
    /// They are dense, and computed by another algorithm than all other methods: to read and to compare.
    ///
    /// Parameters
    /// ----------
    /// theta, dtheta : array_like, shapes (nq,) and (n,)
    ///     Positions, rad or m; velocities, rad/s or m/s.
    #[doc = environment!()]
    ///
    /// Returns
    /// -------
    /// ClosedForm
    ///     Matrices over N bodies, the moving links and a floating base: `A` (6N, n), `G`, `W`, `L`, `ad_V`,
    ///     `ad_Adtheta` (6N, 6N); `V`, `V_base`, `dV_base`, `F_tip` (6N,); `M`, `armature` (n, n); `c`, `g`,
    ///     `tip_forces`, `friction`, `springs` (n,).
    ///
    /// Examples
    /// --------
    /// >>> import mozzi
    /// >>> arm = mozzi.models.two_link_planar()
    /// >>> form = arm.closed_form([0.3, 0.5], [1.0, 2.0])
    /// >>> bool(abs(form.M - arm.mass_matrix([0.3, 0.5])).max() < 1e-12)
    /// True
    #[pyo3(signature = (theta, dtheta, tip_wrench=None, *, gravity=None, applied_wrenches=None, base_twist=None, base_acceleration=None))]
    #[allow(clippy::too_many_arguments)] // Python's
    fn closed_form<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        dtheta: &Bound<'py, PyAny>,
        tip_wrench: Given<'_, 'py>,
        gravity: Given<'_, 'py>,
        applied_wrenches: Given<'_, 'py>,
        base_twist: Given<'_, 'py>,
        base_acceleration: Given<'_, 'py>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let model = &self.robot().model;
        let [theta, dtheta] = self.one_state([("theta", theta), ("dtheta", dtheta)])?;
        let given = [tip_wrench, gravity, applied_wrenches, base_twist, base_acceleration];
        let environment = environment(model, given)?;
        let form = model.closed_form(&theta, &dtheta, &environment.environment()).map_err(of_model)?;
        let fields = vec![
            matrix(py, &form.A)?,
            matrix(py, &form.G)?,
            matrix(py, &form.W)?,
            matrix(py, &form.L)?,
            matrix(py, &form.ad_V)?,
            matrix(py, &form.ad_Adtheta)?,
            vector(py, &form.V)?,
            vector(py, &form.V_base)?,
            vector(py, &form.dV_base)?,
            vector(py, &form.F_tip)?,
            matrix(py, &form.mass_matrix())?,
            vector(py, &form.velocity_product())?,
            vector(py, &form.gravity_forces())?,
            vector(py, &form.tip_forces())?,
            vector(py, &form.friction)?,
            matrix(py, &form.armature)?,
            vector(py, &form.springs)?,
        ];
        named(py, "ClosedForm", fields)
    }

    /// Compute inverse dynamics at one state with the recursion's twists, accelerations and wrenches.
    ///
    /// They are those of the N moving links, base to tips.
    ///
    /// Parameters
    /// ----------
    /// theta, dtheta, ddtheta : array_like, shapes (nq,), (n,) and (n,)
    ///     Positions, rad or m; velocities, rad/s or m/s; accelerations, rad/s² or m/s².
    /// frame : {'center_of_mass', 'link'}
    ///     Frames of the results: the book's frames {i}, at the centres of mass, or the links' own.
    #[doc = environment!()]
    ///
    /// Returns
    /// -------
    /// NewtonEuler
    ///     `twists`, `accelerations` (gravity in them), `wrenches` that the joints transmit, each (N, 6);
    ///     `base_reaction` (6,); `tau` (n,).
    ///
    /// Examples
    /// --------
    /// >>> import mozzi
    /// >>> ur5 = mozzi.models.ur5()
    /// >>> found = ur5.newton_euler([0.0] * 6, [0.0] * 6, [0.0] * 6)
    /// >>> found.wrenches.shape
    /// (6, 6)
    #[pyo3(signature = (theta, dtheta, ddtheta, tip_wrench=None, *, frame="center_of_mass", gravity=None, applied_wrenches=None, base_twist=None, base_acceleration=None))]
    #[allow(clippy::too_many_arguments)] // Python's
    fn newton_euler<'py>(
        &self,
        py: Python<'py>,
        theta: &Bound<'py, PyAny>,
        dtheta: &Bound<'py, PyAny>,
        ddtheta: &Bound<'py, PyAny>,
        tip_wrench: Given<'_, 'py>,
        frame: &str,
        gravity: Given<'_, 'py>,
        applied_wrenches: Given<'_, 'py>,
        base_twist: Given<'_, 'py>,
        base_acceleration: Given<'_, 'py>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let model = &self.robot().model;
        let frame = match frame {
            "center_of_mass" => BodyFrame::CenterOfMass,
            "link" => BodyFrame::Link,
            other => return Err(refused(format!("frame is '{other}', expected 'center_of_mass' or 'link'"))),
        };
        let [theta, dtheta, ddtheta] = self.one_state([("theta", theta), ("dtheta", dtheta), ("ddtheta", ddtheta)])?;
        let given = [tip_wrench, gravity, applied_wrenches, base_twist, base_acceleration];
        let environment = environment(model, given)?;
        let found =
            model.newton_euler(&theta, &dtheta, &ddtheta, &environment.environment(), frame).map_err(of_model)?;
        let twists = |list: &[Twist]| array(py, &[list.len(), 6], list.iter().flat_map(|V| V.to_array()));
        let wrenches = |list: &[Wrench]| array(py, &[list.len(), 6], list.iter().flat_map(|F| F.to_array()));
        let fields = vec![
            twists(&found.twists)?,
            twists(&found.accelerations)?,
            wrenches(&found.wrenches)?,
            array(py, &[6], found.base_reaction.to_array())?,
            vector(py, &found.tau)?,
        ];
        named(py, "NewtonEuler", fields)
    }

    /// Compute the base parameters π_b = K π, the combinations that determine the joint forces.
    ///
    /// They are those under the model's gravity; no motion determines π any further.
    ///
    /// Returns
    /// -------
    /// BaseParameters
    ///     `columns` of `regressor` that are independent; `combination` K, (base parameters, parameters); `names`, such
    ///     as `link1.Izz + 0.25 link2.m`.
    ///
    /// Examples
    /// --------
    /// >>> import mozzi
    /// >>> arm = mozzi.models.two_link_planar()
    /// >>> base = arm.base_parameters()
    /// >>> Y = arm.regressor([0.3, 0.5], [1.0, 2.0], [0.1, 0.2])
    /// >>> tau = Y[:, base.columns] @ base.combination @ arm.parameters
    /// >>> bool(abs(tau - arm.inverse_dynamics([0.3, 0.5], [1.0, 2.0], [0.1, 0.2])).max() < 1e-9)
    /// True
    fn base_parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let found = py.detach(|| self.robot().model.base_parameters());
        let fields = vec![
            found.columns.clone().into_pyobject(py)?.into_any(),
            matrix(py, &found.combination)?,
            found.names().into_pyobject(py)?.into_any(),
        ];
        named(py, "BaseParameters", fields)
    }
}
