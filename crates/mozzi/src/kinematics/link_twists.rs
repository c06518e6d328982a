//! The body twist of every link (Modern Robotics 8.51).

use super::base_twist;
use crate::model::Model;
use crate::scalar::{Scalar, pass};
use crate::spatial::Twist;
use crate::workspace::{Recursion, Workspace};

pass! {
/// `workspace.recursion.V[i]` = 𝒱_i of every link in its own coordinates, {s} moving with `V_s`; requires T_{i,i−1}(θ)
/// in the workspace.
pub(crate) fn link_twists<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, theta: &[S], dtheta: &[S], V_s: Twist<S>, workspace: &mut Workspace<S>,
) {
    let Workspace { recursion: Recursion { T, V, .. }, .. } = workspace;
    V[0] = base_twist(model, theta, dtheta, V_s);
    for (i, link) in model.outward::<S>() {
        V[i] = T[i].Ad() * V[link.parent] + link.A() * dtheta[link.j]; // (8.51)
    }
}
}
