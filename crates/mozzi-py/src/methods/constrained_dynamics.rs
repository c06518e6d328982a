//! Dynamics of a robot with constraints, at one state: reduction, constrained inverse dynamics, derivatives.

use super::closed_form::{environment, matrix, vector};
use super::constraints::{names, wrenches};
use crate::arguments::Given;
use crate::array::list;
use crate::failure::of_model;
use crate::model::PyModel;
use crate::results::named;
use pyo3::prelude::*;

#[pymethods]
impl PyModel {
    /// Reduce the mechanism's dynamics to the velocities u of independent joints.
    ///
    /// The constraints determine all other velocities: θ̇ = N u, θ̈ = N u̇ + bias, Nᵀτ = M u̇ + h.
    ///
    /// Parameters
    /// ----------
    /// theta, dtheta : array_like, shapes (nq,) and (n,)
    ///     Positions, rad or m; velocities, rad/s or m/s.
    /// independent : list of str
    ///     Names of joints, one for each degree of freedom.
    /// tip_wrench, gravity, applied_wrenches, base_twist, base_acceleration : optional
    ///     The environment, as in `closed_form`.
    ///
    /// Returns
    /// -------
    /// Reduction
    ///     A named tuple: `independent`, the indices of u among the velocities; `N` (n, d); `bias` (n,); `M` (d, d);
    ///     `h` and `g` (d,), without friction and springs.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If the independent joints do not determine a joint, or depend on each other.
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

    /// Compute the motors' torques and the multipliers λ of a motion that satisfies the constraints.
    ///
    /// τ = Mθ̈ + h + f + Aᵀλ, with τ_j = 0 for a joint without a motor.
    ///
    /// Parameters
    /// ----------
    /// theta, dtheta, ddtheta : array_like, shapes (nq,), (n,) and (n,)
    ///     Positions, rad or m; velocities, rad/s or m/s; accelerations, rad/s² or m/s².
    /// weights : array_like, shape (n,), optional
    ///     If there are more motors than degrees of freedom, τ has the least Σ w_j τ_j². Default: 1.
    /// tip_wrench, gravity, applied_wrenches, base_twist, base_acceleration : optional
    ///     The environment, as in `closed_form`.
    ///
    /// Returns
    /// -------
    /// ConstrainedDynamics
    ///     A named tuple: `ddtheta` and `tau` (n,); `multipliers` λ (m,), of least norm; `wrenches`, as from
    ///     `constraint_wrenches`.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If θ̈ violates a constraint, or a motor is missing; the message names the joint.
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

    /// Compute the derivatives of θ̈ and λ of `constrained_forward_dynamics` at one state.
    ///
    /// Parameters
    /// ----------
    /// theta, dtheta, tau : array_like, shapes (nq,), (n,) and (n,)
    ///     Positions, rad or m; velocities, rad/s or m/s; torques, N m or N.
    /// tip_wrench, gravity, applied_wrenches, base_twist, base_acceleration : optional
    ///     The environment, as in `closed_form`.
    ///
    /// Returns
    /// -------
    /// ConstrainedForwardDynamicsDerivatives
    ///     A named tuple: `d_theta`, `d_dtheta`, `d_tau` (n, n) of θ̈; `multipliers_d_theta`, `multipliers_d_dtheta`,
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
