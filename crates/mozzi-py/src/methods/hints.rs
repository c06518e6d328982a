//! Names of other libraries, and guesses: an attribute that does not exist names the one that was meant.

use crate::model::PyModel;
use mozzi::quantities::Query;
use mozzi_urdf::did_you_mean;
use pyo3::exceptions::{PyAttributeError, PyTypeError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

/// Attributes of others, and what is meant.
const MEANT: [(&[&str], &str); 21] = [
    (
        &["nv", "dof", "ndof", "dofs", "num_joints", "njoints"],
        "`n` is the number of velocities, `nq` that of positions",
    ),
    (&["joints", "names", "actuated_joint_names"], "`joint_names`"),
    (
        &["limits", "joint_limits", "lower_limits", "upper_limits", "qlim"],
        "`position_limits`, `velocity_limits`, `effort_limits`",
    ),
    (&["frame_names", "bodies", "body_names"], "`frames` are the names of all links and frames"),
    (&["links"], "`link_names`"),
    (&["total_mass"], "`mass`"),
    (&["energy", "total_energy"], "`kinetic_energy(theta, dtheta)` + `potential_energy(theta)`"),
    (
        &["neutral", "zero", "zeros", "q0", "qpos0", "home"],
        "`neutral_configuration`; named states are `states`, `state(name)`",
    ),
    (&["lock", "locked", "lock_joints", "build_reduced_model"], "`with_locked_joints({joint: position})`"),
    (&["payload", "add_payload"], "`with_payload(frame, inertia)`"),
    (&["ik", "inverse_kinematics"], "`mozzi.InverseKinematics(model, frame).solve(guess, position=…)`"),
    (&["step", "rollouts", "integrate_dynamics"], "`simulate(theta, dtheta, duration, steps)`, `rollout`"),
    (
        &["jacobian", "J", "jac", "jac_site", "jac_body"],
        "`body_jacobian(theta, frame=…)`, in the frame's axes, or `space_jacobian`",
    ),
    (&["inv_mass_matrix", "inverse_mass_matrix", "minv"], "`mass_matrix_inverse(theta)`"),
    (&["torque_limits", "torque_limit", "max_torque"], "`effort_limits`"),
    (
        &["gravity_compensation"],
        "`gravity_forces(theta)`; `simulate(…, torque=\"gravity_compensation\")` applies it to the motors",
    ),
    (
        &["operational_space", "task_space"],
        "`task_space_dynamics(theta, dtheta, frame=…)`; the controller is `mozzi.controllers.TaskSpace`",
    ),
    (&["manipulability"], "`numpy.linalg.det(J @ J.T) ** 0.5` with J = `body_jacobian(theta, frame=…)`"),
    (
        &["from_file", "from_xml", "from_xml_path", "from_xml_string"],
        "`mozzi.Model.load(path)`; `from_urdf_string(text)` reads text",
    ),
    (&["view", "show", "visualize", "display", "plot"], "`play()`; `report(trajectory)` is the page of a motion"),
    (&["write", "to_urdf", "to_mjcf", "to_sdf", "to_json", "export"], "`save(path)`; the ending chooses the format"),
];

#[pymethods]
impl PyModel {
    #[new]
    #[pyo3(signature = (*_arguments, **_options), text_signature = None)]
    fn new(_arguments: &Bound<'_, PyTuple>, _options: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let meant = "`mozzi.Model.load(path)` reads a file, or an embedded robot by its name; `from_screws` takes the book's lists";
        Err(PyTypeError::new_err(format!("cannot create 'mozzi.Model' instances: {meant}")))
    }

    /// Called for an attribute that does not exist.
    fn __getattr__(slf: &Bound<'_, Self>, name: &str) -> PyResult<Py<PyAny>> {
        let message = format!("'mozzi.Model' object has no attribute '{name}'");
        let meant = if name.starts_with('_') { None } else { meant(slf, name)? };
        Err(PyAttributeError::new_err(match meant {
            Some(meant) => format!("{message}: {meant}"),
            None => message,
        }))
    }
}

fn meant(model: &Bound<'_, PyModel>, name: &str) -> PyResult<Option<String>> {
    if let Some((_, meant)) = MEANT.iter().find(|(guesses, _)| guesses.contains(&name)) {
        return Ok(Some((*meant).to_string()));
    }
    if let Ok(query) = Query::named(name) {
        let declaration = query.declaration();
        let arguments: Vec<&str> = declaration.inputs.iter().map(|input| input.name).collect();
        return Ok(Some(format!("`{}({})`", declaration.name, arguments.join(", "))));
    }
    let known = model.get_type().dir()?.iter().map(|name| name.extract()).collect::<PyResult<Vec<String>>>()?;
    Ok(did_you_mean(name, known.iter().map(String::as_str).filter(|name| !name.starts_with('_'))))
}
