//! Forward kinematics (Modern Robotics, chapter 4, by relative configurations).

use super::base_pose;
use crate::lie::SE3;
use crate::model::{FrameId, Model};
use crate::quantities::{Call, Declaration, Dim, Kernel, Of, Quantity, THETA, output, sized};
use crate::scalar::{Scalar, pass};
use crate::workspace::Workspace;

/// The configuration `T_sb` of a frame {b} relative to {s} at the positions θ.
///
/// Cost O(depth), no allocation.
///
/// # Panics
/// When θ is not nq long.
#[cfg_attr(not(debug_assertions), inline(always))]
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

pass! {
/// The configurations of all frames relative to {s}, in the order of [`Model::frames`].
///
/// Cost O(n + frames), no allocation.
///
/// # Panics
/// If the length of θ is not nq, or `poses` does not have one entry per frame.
pub fn frame_poses<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, theta: &[S], workspace: &mut Workspace<S>, poses: &mut [SE3<S>]) {
    model.assert_lengths(theta.len(), []);
    assert!(poses.len() == model.frames().len(), "poses has {} entries, expected one for each of {} frames", poses.len(), model.frames().len());
    let T = &mut workspace.recursion.T;
    T[0] = base_pose(model, theta);
    for (i, link) in model.outward::<S>() {
        T[i] = T[link.parent] * link.transform(theta).inverse();          // T_{s,i} = T_{s,i−1} T_{i−1,i}
    }
    for (pose, (id, _)) in poses.iter_mut().zip(model.frames()) {
        let frame = model.frame_at::<S>(id);
        *pose = T[frame.slot] * frame.T;
    }
}
}

/// See [`forward_kinematics`].
#[derive(Clone, Copy, Debug)]
pub struct ForwardKinematics;
impl Quantity for ForwardKinematics {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "forward_kinematics",
        "T_sb(θ), the configuration of a frame {b} seen from {s}",
        &[THETA],
        &[output("T", &[Dim::Is(4), Dim::Is(4)], "m")],
    )
    .of(Of::Frame);
}
impl Kernel for ForwardKinematics {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, ..], [T, ..]) = (c.inputs, c.outputs);
        T.copy_from_slice(forward_kinematics(c.model, theta, c.of.frame()).to_matrix().as_flattened());
    }
}

/// See [`frame_poses`].
#[derive(Clone, Copy, Debug)]
pub struct FramePoses;
impl Quantity for FramePoses {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "frame_poses",
        "T_sb(θ) of all frames, in the order of the model's list",
        &[THETA],
        &[output("T", &[Dim::Frames, Dim::Is(4), Dim::Is(4)], "m")],
    );
}
impl Kernel for FramePoses {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, ..], [T, ..]) = (c.inputs, c.outputs);
        let poses = sized(&mut c.memory.poses, c.model.frames().len(), SE3::identity());
        frame_poses(c.model, theta, &mut c.memory.workspace, poses);
        for (T, pose) in T.chunks_exact_mut(16).zip(poses) {
            T.copy_from_slice(pose.to_matrix().as_flattened());
        }
    }
}
