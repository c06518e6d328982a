//! Kinematics as methods.

use crate::kinematics as kernel;
use crate::kinematics::Jacobian;
use crate::lie::SE3;
use crate::model::{Error, FrameId, Model, Workspace};
use crate::spatial::Twist;
use alloc::vec;
use alloc::vec::Vec;

impl Model<f64> {
    /// `T_sb` of a frame {b} seen from the base: see [`forward_kinematics`](kernel::forward_kinematics).
    ///
    /// # Errors
    /// [`Error::WrongLength`]; [`Error::BadArgument`] for a frame of another model.
    pub fn forward_kinematics(&self, theta: &[f64], frame: FrameId) -> Result<SE3, Error> {
        self.check_lengths(theta, [])?;
        self.check_frame(frame)?;
        Ok(kernel::forward_kinematics(self, theta, frame))
    }

    /// The configurations of all frames seen from the base, in the order of [`frames`](Self::frames).
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
        self.check_lengths(theta, [])?;
        self.check_frame(frame)?;
        Ok(self.columns(|J| kernel::space_jacobian(self, theta, frame, J)))
    }

    /// `J_b`(θ), in the frame's coordinates: see [`body_jacobian`](kernel::body_jacobian).
    ///
    /// # Errors
    /// [`Error::WrongLength`]; [`Error::BadArgument`] for a frame of another model.
    pub fn body_jacobian(&self, theta: &[f64], frame: FrameId) -> Result<Jacobian, Error> {
        self.check_lengths(theta, [])?;
        self.check_frame(frame)?;
        Ok(self.columns(|J| kernel::body_jacobian(self, theta, frame, J)))
    }

    /// d`J_s`/dt: see [`space_jacobian_rate`](kernel::space_jacobian_rate).
    ///
    /// # Errors
    /// [`Error::WrongLength`]; [`Error::BadArgument`] for a frame of another model.
    pub fn space_jacobian_rate(&self, theta: &[f64], dtheta: &[f64], frame: FrameId) -> Result<Jacobian, Error> {
        self.check_lengths(theta, [("dtheta", dtheta)])?;
        self.check_frame(frame)?;
        Ok(self.columns(|dJ| kernel::space_jacobian_rate(self, theta, dtheta, frame, &mut Workspace::new(self), dJ)))
    }

    /// d`J_b`/dt: see [`body_jacobian_rate`](kernel::body_jacobian_rate).
    ///
    /// # Errors
    /// [`Error::WrongLength`]; [`Error::BadArgument`] for a frame of another model.
    pub fn body_jacobian_rate(&self, theta: &[f64], dtheta: &[f64], frame: FrameId) -> Result<Jacobian, Error> {
        self.check_lengths(theta, [("dtheta", dtheta)])?;
        self.check_frame(frame)?;
        Ok(self.columns(|dJ| kernel::body_jacobian_rate(self, theta, dtheta, frame, dJ)))
    }

    /// ∂`J_s`/∂θ_j for each joint j: see [`space_jacobian_derivative`](kernel::space_jacobian_derivative).
    ///
    /// # Errors
    /// [`Error::WrongLength`]; [`Error::BadArgument`] for a frame of another model.
    pub fn space_jacobian_derivative(&self, theta: &[f64], frame: FrameId) -> Result<Vec<Jacobian>, Error> {
        self.check_lengths(theta, [])?;
        self.check_frame(frame)?;
        Ok(self.by_joint(|H| kernel::space_jacobian_derivative(self, theta, frame, &mut Workspace::new(self), H)))
    }

    /// ∂`J_b`/∂θ_j for each joint j: see [`body_jacobian_derivative`](kernel::body_jacobian_derivative).
    ///
    /// # Errors
    /// [`Error::WrongLength`]; [`Error::BadArgument`] for a frame of another model.
    pub fn body_jacobian_derivative(&self, theta: &[f64], frame: FrameId) -> Result<Vec<Jacobian>, Error> {
        self.check_lengths(theta, [])?;
        self.check_frame(frame)?;
        Ok(self.by_joint(|H| kernel::body_jacobian_derivative(self, theta, frame, &mut Workspace::new(self), H)))
    }

    fn columns(&self, fill: impl FnOnce(&mut [Twist])) -> Jacobian {
        let mut columns = vec![Twist::zero(); self.n()];
        fill(&mut columns);
        Jacobian(columns)
    }

    /// From H[i n + j] = ∂J_i/∂θ_j to one Jacobian for each j.
    fn by_joint(&self, fill: impl FnOnce(&mut [Twist])) -> Vec<Jacobian> {
        let n = self.n();
        let mut H = vec![Twist::zero(); n * n];
        fill(&mut H);
        (0..n).map(|j| Jacobian((0..n).map(|i| H[i * n + j]).collect())).collect()
    }
}
