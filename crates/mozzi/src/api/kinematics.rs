//! Kinematics as methods.

use crate::kinematics as kernel;
use crate::kinematics::Jacobian;
use crate::lie::SE3;
use crate::model::{Error, FrameId, Model};
use crate::quantities::{self as q, Query};
use crate::spatial::Twist;
use crate::workspace::Workspace;
use alloc::vec;
use alloc::vec::Vec;

impl Model<f64> {
    /// `T_sb` of a frame {b} relative to {s}: see [`forward_kinematics`](kernel::forward_kinematics).
    ///
    /// # Errors
    /// [`Error::WrongLength`]; [`Error::BadArgument`] for a frame of another model.
    pub fn forward_kinematics(&self, theta: &[f64], frame: FrameId) -> Result<SE3, Error> {
        self.check_lengths(theta, [])?;
        self.check_frame(frame)?;
        Ok(kernel::forward_kinematics(self, theta, frame))
    }

    /// The configurations of all frames relative to {s}, in the order of [`frames`](Self::frames).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn frame_poses(&self, theta: &[f64]) -> Result<Vec<SE3>, Error> {
        self.check_lengths(theta, [])?;
        let mut poses = vec![SE3::identity(); self.frames().len()];
        kernel::frame_poses(self, theta, &mut Workspace::new(self), &mut poses);
        Ok(poses)
    }

    /// `J_s`(θ), in base coordinates: see [`space_jacobian`](kernel::space_jacobian).
    ///
    /// # Errors
    /// [`Error::WrongLength`]; [`Error::BadArgument`] for a frame of another model.
    pub fn space_jacobian(&self, theta: &[f64], frame: FrameId) -> Result<Jacobian, Error> {
        self.jacobian(Query::from(q::SpaceJacobian).of(frame), &[theta])
    }

    /// `J_b`(θ), in the frame's coordinates: see [`body_jacobian`](kernel::body_jacobian).
    ///
    /// # Errors
    /// [`Error::WrongLength`]; [`Error::BadArgument`] for a frame of another model.
    pub fn body_jacobian(&self, theta: &[f64], frame: FrameId) -> Result<Jacobian, Error> {
        self.jacobian(Query::from(q::BodyJacobian).of(frame), &[theta])
    }

    /// d`J_s`/dt: see [`space_jacobian_rate`](kernel::space_jacobian_rate).
    ///
    /// # Errors
    /// [`Error::WrongLength`]; [`Error::BadArgument`] for a frame of another model.
    pub fn space_jacobian_rate(&self, theta: &[f64], dtheta: &[f64], frame: FrameId) -> Result<Jacobian, Error> {
        self.jacobian(Query::from(q::SpaceJacobianRate).of(frame), &[theta, dtheta])
    }

    /// d`J_b`/dt: see [`body_jacobian_rate`](kernel::body_jacobian_rate).
    ///
    /// # Errors
    /// [`Error::WrongLength`]; [`Error::BadArgument`] for a frame of another model.
    pub fn body_jacobian_rate(&self, theta: &[f64], dtheta: &[f64], frame: FrameId) -> Result<Jacobian, Error> {
        self.jacobian(Query::from(q::BodyJacobianRate).of(frame), &[theta, dtheta])
    }

    /// ∂`J_s`/∂θ_j for each joint j: see [`space_jacobian_derivative`](kernel::space_jacobian_derivative).
    ///
    /// # Errors
    /// [`Error::WrongLength`]; [`Error::BadArgument`] for a frame of another model.
    pub fn space_jacobian_derivative(&self, theta: &[f64], frame: FrameId) -> Result<Vec<Jacobian>, Error> {
        let H = self.first(Query::from(q::SpaceJacobianDerivative).of(frame), &[theta], &self.environment())?;
        Ok(H.chunks_exact(6 * self.n().max(1)).map(from_rows).collect())
    }

    /// ∂`J_b`/∂θ_j for each joint j: see [`body_jacobian_derivative`](kernel::body_jacobian_derivative).
    ///
    /// # Errors
    /// [`Error::WrongLength`]; [`Error::BadArgument`] for a frame of another model.
    pub fn body_jacobian_derivative(&self, theta: &[f64], frame: FrameId) -> Result<Vec<Jacobian>, Error> {
        let H = self.first(Query::from(q::BodyJacobianDerivative).of(frame), &[theta], &self.environment())?;
        Ok(H.chunks_exact(6 * self.n().max(1)).map(from_rows).collect())
    }

    fn jacobian(&self, query: Query, inputs: &[&[f64]]) -> Result<Jacobian, Error> {
        Ok(from_rows(&self.first(query, inputs, &self.environment())?))
    }
}

/// A Jacobian from its six rows.
fn from_rows(rows: &[f64]) -> Jacobian {
    let n = rows.len() / 6;
    Jacobian((0..n).map(|j| Twist::from_array(core::array::from_fn(|row| rows[row * n + j]))).collect())
}
