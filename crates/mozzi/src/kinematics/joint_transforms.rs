//! The configuration of each moving link's parent relative to the link (Modern Robotics 8.50).

use crate::model::Model;
use crate::scalar::{Scalar, pass};
use crate::workspace::{Recursion, Workspace};

pass! {
/// `workspace.recursion.T[i]` = T_{i,i−1}(θ) = e^{−`[A]`q} M_{i,i−1} of every link.
pub(crate) fn joint_transforms<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, theta: &[S], workspace: &mut Workspace<S>) {
    joint_sines(model, theta, workspace);
    let Workspace { recursion: Recursion { T, sin_cos, .. }, .. } = workspace;
    for (i, link) in model.outward::<S>() { T[i] = link.transform_with(sin_cos[i], theta); } // (8.50)
}
}

/// `workspace.recursion.sin_cos[i]` of every joint's angle. All are computed first because they are independent of each
/// other, unlike the steps of the recursions that follow.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn joint_sines<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, theta: &[S], workspace: &mut Workspace<S>) {
    model.assert_lengths(theta.len(), []);
    let sin_cos = &mut workspace.recursion.sin_cos;
    for (i, link) in model.outward::<S>() {
        sin_cos[i] = link.sin_cos(theta);
    }
}
