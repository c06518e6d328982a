//! wᵀ∂𝒱_b and wᵀ∂a_b: a covector times the derivatives of a frame's twist and acceleration, in O(n).
//!
//! The classical acceleration a = (ω̇, v̇ + ω × v) of a frame changes by
//!
//! > ∂a = ∂𝒱̇ + (0, ∂ω × v + ω × ∂v) = Ä + (−ω × ∂ω, 2 ∂ω × v)
//!
//! with ∂𝒱̇ = Ä − `[ad_𝒱]`Ȧ and ∂𝒱 = Ȧ (see [`vjp.rs`](super::vjp)), all seen from the frame. So for w = (m, f), Q = w
//! and R = ω × m + 2 v × f.

use super::bias_forces::take_zeros;
use super::vjp::{add_products_of, from_rest};
use crate::kinematics::joint_transforms;
use crate::model::{FrameId, Model};
use crate::quantities::{
    ANY, CONSTANT_SIX, Call, DDTHETA, DTHETA, Declaration, Kernel, Memory, Of, Quantity, THETA, VECTOR, output, six,
    sized,
};
use crate::scalar::Scalar;
use crate::spatial::{Twist, Wrench};
use crate::workspace::Workspace;

/// The gradient of wᵀ𝒱_b, 𝒱_b = `J_b`(θ)θ̇ the twist of a frame in its own coordinates with {s} at rest, for a constant
/// w: `[wᵀ∂𝒱_b/∂θ, J_bᵀw]`, each n long; along velocities. `unused` is n numbers of memory. That of the frame's pose,
/// along its own twist, is `J_bᵀw` too.
///
/// Cost O(n), no allocation.
///
/// # Panics
/// When θ is not nq long, or another slice not n.
#[cfg_attr(not(debug_assertions), inline(always))]
#[allow(clippy::too_many_arguments)] // the state, the frame, w, memory and the products
pub fn frame_twist_vjp<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    frame: FrameId,
    w: Wrench<S>,
    workspace: &mut Workspace<S>,
    unused: &mut [S],
    [d_theta, d_dtheta]: [&mut [S]; 2],
) {
    let zero = take_zeros(workspace);
    let products = [d_theta, unused, d_dtheta];
    of_frame(model, [theta, &zero, dtheta], frame, w, workspace, products);
    workspace.vector = zero;
}

/// The gradient of wᵀa_b, a_b the [`frame_acceleration`](crate::kinematics::frame_acceleration()), for a constant w:
/// `[wᵀ∂a_b/∂θ, wᵀ∂a_b/∂θ̇, wᵀ∂a_b/∂θ̈ = J_bᵀw]`, each n long; along velocities.
///
/// Cost O(n), no allocation.
///
/// # Panics
/// When θ is not nq long, or another slice not n.
#[cfg_attr(not(debug_assertions), inline(always))]
#[allow(clippy::too_many_arguments)]
pub fn frame_acceleration_vjp<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    ddtheta: &[S],
    frame: FrameId,
    w: Wrench<S>,
    workspace: &mut Workspace<S>,
    products: [&mut [S]; 3],
) {
    of_frame(model, [theta, dtheta, ddtheta], frame, w, workspace, products);
}

#[cfg_attr(not(debug_assertions), inline(always))]
fn of_frame<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    [theta, dtheta, ddtheta]: [&[S]; 3],
    frame: FrameId,
    w: Wrench<S>,
    workspace: &mut Workspace<S>,
    mut products: [&mut [S]; 3],
) {
    let lengths = products.each_ref().map(|product| product.len());
    model.assert_lengths(theta.len(), [dtheta.len(), ddtheta.len(), lengths[0], lengths[1], lengths[2]]);
    for product in &mut products {
        product.fill(S::zero());
    }
    let frame = model.frame_at::<S>(frame);
    let at_frame = |workspace: &mut Workspace<S>| {
        let (i, T_bi) = (frame.slot, frame.T.inverse());
        let V = T_bi.Ad() * workspace.recursion.V[i];
        workspace.composite.Q[i] = T_bi.Ad().transpose() * w;
        workspace.composite.B[i].f = frame.T.R * (V.w.cross(w.m) + (V.v + V.v).cross(w.f));
    };
    joint_transforms(model, theta, workspace);
    let environment = from_rest(Twist::zero());
    add_products_of(model, theta, dtheta, ddtheta, &environment, workspace, at_frame, products);
}

/// See [`frame_twist_vjp`].
#[derive(Clone, Copy, Debug)]
pub struct FrameTwistVjp;
impl Quantity for FrameTwistVjp {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "frame_twist_vjp",
        "wᵀ∂𝒱_b/∂θ along the velocities, and J_bᵀw: the gradient of wᵀ𝒱_b, the twist of a frame in its own coordinates",
        &[THETA, DTHETA, CONSTANT_SIX],
        &[output("d_theta", VECTOR, ANY), output("d_dtheta", VECTOR, ANY)],
    )
    .of(Of::Frame);
}
impl Kernel for FrameTwistVjp {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, w, _], [a, b, ..]) = (c.inputs, c.outputs);
        let Memory { workspace, matrix, .. } = c.memory;
        let (w, unused) = (Wrench::from_array(six(w)), sized(matrix, c.model.n(), S::zero()));
        frame_twist_vjp(c.model, theta, dtheta, c.of.frame(), w, workspace, unused, [a, b]);
    }
}

/// See [`frame_acceleration_vjp`].
#[derive(Clone, Copy, Debug)]
pub struct FrameAccelerationVjp;
impl Quantity for FrameAccelerationVjp {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "frame_acceleration_vjp",
        "wᵀ∂a_b/∂θ along the velocities, wᵀ∂a_b/∂θ̇ and J_bᵀw: the gradient of wᵀa_b, a_b the acceleration of a frame",
        &[THETA, DTHETA, DDTHETA, CONSTANT_SIX],
        &[output("d_theta", VECTOR, ANY), output("d_dtheta", VECTOR, ANY), output("d_ddtheta", VECTOR, ANY)],
    )
    .of(Of::Frame);
}
impl Kernel for FrameAccelerationVjp {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, ddtheta, w], [a, b, d, _]) = (c.inputs, c.outputs);
        let (w, workspace) = (Wrench::from_array(six(w)), &mut c.memory.workspace);
        frame_acceleration_vjp(c.model, theta, dtheta, ddtheta, c.of.frame(), w, workspace, [a, b, d]);
    }
}
