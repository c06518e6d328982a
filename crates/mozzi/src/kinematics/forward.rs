//! Forward kinematics (Modern Robotics, chapter 4, by relative configurations).

use super::base_pose;
use crate::lie::SE3;
use crate::model::{FrameId, Model, Workspace};
use crate::scalar::Scalar;

/// The configuration `T_sb` of a frame {b} seen from {s}, at the positions θ.
///
/// Cost O(depth), no allocation.
///
/// # Panics
/// When θ is not nq long.
#[cfg_attr(not(test), inline(always))]
#[rustfmt::skip]
pub fn forward_kinematics<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, theta: &[S], frame: FrameId) -> SE3<S> {
    model.assert_lengths(theta.len(), []);
    let frame = model.frame_at::<S>(frame);
    let mut T = frame.T;
    for (_, link) in model.to_base::<S>(frame.slot) {
        T = link.transform(theta).inverse() * T;                          // T_{i−1,b} = T_{i−1,i} T_{i,b}
    }
    base_pose(model, theta) * T
}

/// The configurations of all frames seen from {s}, in the order of [`Model::frames`].
///
/// Cost O(n + frames), no allocation.
///
/// # Panics
/// When θ is not nq long, or `poses` not one for each frame.
#[cfg_attr(not(test), inline(always))]
#[rustfmt::skip]
pub fn frame_poses<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, theta: &[S], workspace: &mut Workspace<S>, poses: &mut [SE3<S>]) {
    model.assert_lengths(theta.len(), []);
    assert!(poses.len() == model.frames().len(), "poses has {} entries, expected one for each of {} frames", poses.len(), model.frames().len());
    let T = &mut workspace.T;
    T[0] = base_pose(model, theta);
    for (i, link) in model.outward::<S>() {
        T[i] = T[link.parent] * link.transform(theta).inverse();          // T_{s,i} = T_{s,i−1} T_{i−1,i}
    }
    for (pose, (id, _)) in poses.iter_mut().zip(model.frames()) {
        let frame = model.frame_at::<S>(id);
        *pose = T[frame.slot] * frame.T;
    }
}
