//! Configurations, Jacobians and the task space, of a model in Python.

use crate::call::{Options, named};
use crate::environment::{Arguments, Given};
use crate::model::PyModel;
use crate::quantity::Quantity;
use crate::threads::Threads;
use mozzi::{FrameId, Task, TaskFrame};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

methods! {
    /// T_sb, the configuration of a frame seen from {s}.
    forward_kinematics(theta; of frame; to out) = Quantity::ForwardKinematics(frame) => {
        /// T : numpy.ndarray, shape (..., 4, 4)
        ///     Lengths in m.
        ///
        /// Examples
        /// --------
        /// >>> import mozzi
        /// >>> ur5 = mozzi.models.ur5()
        /// >>> T = ur5.forward_kinematics([0, -1.2, 1.5, 0.3, 1.1, 0])
        /// >>> T.shape
        /// (4, 4)
        /// >>> ur5.forward_kinematics([0, -1.2, 1.5, 0.3, 1.1, 0], "forearm_link")[:3, 3].round(3).tolist()
        /// [0.154, 0.016, 0.485]
    }

    /// The poses of all frames.
    frame_poses(theta; to out) = Quantity::FramePoses => {
        /// T : numpy.ndarray, shape (..., frames, 4, 4)
        ///     T_sb of each frame {b}, in the order of `frames`; positions in m.
        ///
        /// Examples
        /// --------
        /// >>> import mozzi
        /// >>> ur5 = mozzi.models.ur5()
        /// >>> T = ur5.frame_poses([0, -1.2, 1.5, 0.3, 1.1, 0])
        /// >>> T[ur5.frames.index("forearm_link"), :3, 3].round(3).tolist()
        /// [0.154, 0.016, 0.485]
    }

    /// J_s(θ) of a frame: its twist in {s} is J_s θ̇, (ω, v).
    space_jacobian(theta; of frame; to out) = Quantity::SpaceJacobian(frame) => {
        /// J : numpy.ndarray, shape (..., 6, n)
    }

    /// J_b(θ) of a frame: its twist in its own coordinates is J_b θ̇, (ω, v).
    body_jacobian(theta; of frame; to out) = Quantity::BodyJacobian(frame) => {
        /// J : numpy.ndarray, shape (..., 6, n)
    }

    /// dJ_s/dt of a frame.
    space_jacobian_rate(theta, dtheta; of frame; to out) = Quantity::SpaceJacobianRate(frame) => {
        /// dJ : numpy.ndarray, shape (..., 6, n)
    }

    /// dJ_b/dt of a frame.
    body_jacobian_rate(theta, dtheta; of frame; to out) = Quantity::BodyJacobianRate(frame) => {
        /// dJ : numpy.ndarray, shape (..., 6, n)
    }

    /// ∂J_s/∂θ_j of a frame for each joint j.
    space_jacobian_derivative(theta; of frame; to out) = Quantity::SpaceJacobianDerivative(frame) => {
        /// H : numpy.ndarray, shape (..., n, 6, n)
        ///     H[j] is ∂J_s/∂θ_j.
    }

    /// ∂J_b/∂θ_j of a frame for each joint j.
    body_jacobian_derivative(theta; of frame; to out) = Quantity::BodyJacobianDerivative(frame) => {
        /// H : numpy.ndarray, shape (..., n, 6, n)
        ///     H[j] is ∂J_b/∂θ_j.
    }

    /// Λ and η of 𝓕 = Λ(θ)𝒱̇ + η(θ, 𝒱), the dynamics as a frame shows them.
    task_space_dynamics(
        theta, dtheta; of frame; touching tip_wrench; with coordinates: &str = "body", rows: Option<Vec<usize>> = None;
        in gravity, applied_wrenches, base_twist, base_acceleration
    ) = Quantity::TaskSpaceDynamics(task(frame, coordinates, rows.as_deref())?), as TaskSpaceDynamics => {
        /// TaskSpaceDynamics
        ///     `Lambda`, shape (..., k, k), and `eta`, shape (..., k).
        ///
        /// Raises
        /// ------
        /// SingularError
        ///     Where the rows cannot be moved independently.
    }
}

/// The task of a frame, in coordinates that have a name; all rows by default.
fn task<'a>(frame: FrameId, coordinates: &str, rows: Option<&'a [usize]>) -> PyResult<Task<'a>> {
    let coordinates = match coordinates {
        "body" => TaskFrame::Body,
        "space" => TaskFrame::Space,
        other => return Err(PyValueError::new_err(format!("coordinates is '{other}', expected 'body' or 'space'"))),
    };
    Ok(Task { frame, coordinates, rows: rows.unwrap_or(&[0, 1, 2, 3, 4, 5]) })
}
