//! wᵀ∂h and wᵀ∂ḣ: a covector times the derivatives of the momentum and its rate, in O(n).
//!
//! wᵀh = Σ X_bᵀ𝓟_b, where all links move like one rigid body, with {s}, by the twist X_s that w means about the origin
//! of {s}. So it is [`vjp.rs`](super::vjp) with x = 0 and X_0 = X_s.

use super::bias_forces::take_zeros;
use super::derivatives::outward_pass;
use super::vjp::{add_products, from_rest, in_base};
use crate::kinematics::joint_transforms;
use crate::linalg::Vec3;
use crate::model::Model;
use crate::quantities::{
    ANY, CONSTANT_SIX, Call, DDTHETA, DTHETA, Declaration, Kernel, Memory, Of, Quantity, THETA, VECTOR, output, six,
    sized,
};
use crate::scalar::Scalar;
use crate::spatial::Twist;
use crate::workspace::Workspace;

/// The gradient of wᵀh, h the [`momentum`](super::momentum()) about a point p of {s}, for a constant w: `[wᵀ∂h/∂θ,
/// wᵀ∂h/∂θ̇]`, each n long; along velocities. `unused` is n numbers of memory.
///
/// Cost O(n), no allocation.
///
/// # Panics
/// When θ is not nq long, or another slice not n.
#[cfg_attr(not(debug_assertions), inline(always))]
#[allow(clippy::too_many_arguments)] // the state, the point, w, memory and the products
pub fn momentum_vjp<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    p: Vec3<S>,
    w: Twist<S>,
    workspace: &mut Workspace<S>,
    unused: &mut [S],
    [d_theta, d_dtheta]: [&mut [S]; 2],
) {
    let zero = take_zeros(workspace);
    of_momentum(model, [theta, &zero, dtheta, &zero], p, w, workspace, [d_theta, unused, d_dtheta]);
    workspace.vector = zero;
}

/// The gradient of wᵀḣ, ḣ the [`momentum_rate`](super::momentum_rate()) about a fixed point p of {s}, for a constant w:
/// `[wᵀ∂ḣ/∂θ, wᵀ∂ḣ/∂θ̇, wᵀ∂ḣ/∂θ̈]`, each n long; along velocities.
///
/// Cost O(n), no allocation.
///
/// # Panics
/// When θ is not nq long, or another slice not n.
#[cfg_attr(not(debug_assertions), inline(always))]
#[allow(clippy::too_many_arguments)]
pub fn momentum_rate_vjp<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    ddtheta: &[S],
    p: Vec3<S>,
    w: Twist<S>,
    workspace: &mut Workspace<S>,
    products: [&mut [S]; 3],
) {
    let zero = take_zeros(workspace);
    of_momentum(model, [theta, dtheta, ddtheta, &zero], p, w, workspace, products);
    workspace.vector = zero;
}

#[cfg_attr(not(debug_assertions), inline(always))]
fn of_momentum<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    [theta, dtheta, ddtheta, zero]: [&[S]; 4],
    p: Vec3<S>,
    w: Twist<S>,
    workspace: &mut Workspace<S>,
    mut products: [&mut [S]; 3],
) {
    let lengths = products.each_ref().map(|product| product.len());
    model.assert_lengths(theta.len(), [dtheta.len(), ddtheta.len(), lengths[0], lengths[1], lengths[2]]);
    for product in &mut products {
        product.fill(S::zero());
    }
    // wᵀ(m − p × f, f) = X_sᵀ(m, f)
    let X_s = in_base(model, theta, Twist { w: w.w, v: w.v + p.cross(w.w) });
    let environment = from_rest(Twist::zero());
    joint_transforms(model, theta, workspace);
    outward_pass(model, theta, dtheta, ddtheta, &environment, Some((X_s, zero)), workspace);
    add_products(model, theta, Some(X_s), &environment, workspace, products);
}

/// See [`momentum_vjp`].
#[derive(Clone, Copy, Debug)]
pub struct MomentumVjp;
impl Quantity for MomentumVjp {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "momentum_vjp",
        "wᵀ∂h/∂θ along the velocities, and wᵀ∂h/∂θ̇: the gradient of wᵀh, h the momentum about a point of {s}",
        &[THETA, DTHETA, CONSTANT_SIX],
        &[output("d_theta", VECTOR, ANY), output("d_dtheta", VECTOR, ANY)],
    )
    .of(Of::Point)
    .is_of_masses();
}
impl Kernel for MomentumVjp {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, w, _], [a, b, ..]) = (c.inputs, c.outputs);
        let Memory { workspace, matrix, .. } = c.memory;
        let (w, unused) = (Twist::from_array(six(w)), sized(matrix, c.model.n(), S::zero()));
        momentum_vjp(c.model, theta, dtheta, c.point, w, workspace, unused, [a, b]);
    }
}

/// See [`momentum_rate_vjp`].
#[derive(Clone, Copy, Debug)]
pub struct MomentumRateVjp;
impl Quantity for MomentumRateVjp {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "momentum_rate_vjp",
        "wᵀ∂ḣ/∂θ along the velocities, wᵀ∂ḣ/∂θ̇ and wᵀ∂ḣ/∂θ̈: the gradient of wᵀḣ, ḣ the rate of the momentum",
        &[THETA, DTHETA, DDTHETA, CONSTANT_SIX],
        &[output("d_theta", VECTOR, ANY), output("d_dtheta", VECTOR, ANY), output("d_ddtheta", VECTOR, ANY)],
    )
    .of(Of::Point)
    .is_of_masses();
}
impl Kernel for MomentumRateVjp {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, ddtheta, w], [a, b, d, _]) = (c.inputs, c.outputs);
        let (w, workspace) = (Twist::from_array(six(w)), &mut c.memory.workspace);
        momentum_rate_vjp(c.model, theta, dtheta, ddtheta, c.point, w, workspace, [a, b, d]);
    }
}
