//! The two passes behind all products of a vector with derivatives, in O(n).
//!
//! A number that is linear in small changes of the links' motions, wᵀ∂f = Σ_b (Q_bᵀ∂𝒱̇_b + …), needs no matrix. By
//! [`derivatives.rs`](super::derivatives), a joint changes the wrench of each body beyond it by ∂𝓕 = 𝒢Ä + 𝓑Ȧ, and its
//! axis moves the bodies themselves. With Q = 𝒢X and R = 𝓑ᵀX, a moment, and X how the joints' rates x move the link,
//!
//! > X_b = X_p + A_b x_b, the sum of A_i x_i from the base on
//!
//! xᵀτ = Σ X_bᵀ𝓕_b changes by the sum over all links that joint j carries, 𝓠ᶜ = Σ Q, 𝓡ᶜ = Σ R and 𝓕ᶜ = Σ 𝓕:
//!
//! > xᵀ∂τ/∂θ_j = Ä_jᵀ𝓠ᶜ + Ȧ_jᵀ𝓡ᶜ + (`[ad_X_p]` A_j)ᵀ𝓕ᶜ
//! >
//! > xᵀ∂τ/∂θ̇_j = D_jᵀ𝓠ᶜ + A_jᵀ𝓡ᶜ
//! >
//! > xᵀ∂τ/∂θ̈_j = A_jᵀ𝓠ᶜ
//!
//! where X_p is the motion of the link that carries the joint. Other quantities differ in where Q and R come from: a
//! frame's acceleration has them at one link, the momentum has the same X_0 for all links and x = 0.
//!
//! **Velocities are accelerations at rest.** At θ̇ = 0, 𝒱̇ is linear in θ̈ as 𝒱 is in θ̇. So what is linear in
//! velocities, a twist, a momentum, is computed [`from_rest`].

use super::base_rates::BaseRates;
use super::derivatives::outward_pass;
use crate::kinematics::base_pose;
use crate::linalg::Vec3;
use crate::model::{Environment, Model};
use crate::scalar::{Scalar, pass};
use crate::spatial::{Twist, Wrench};
use crate::workspace::{Composite, Recursion, Workspace};

/// An environment without gravity and wrenches, in which the acceleration of {s} is `V_s`: the motion at θ̇ = 0 with θ̇
/// in place of θ̈ has 𝒱 in place of 𝒱̇ and the momentum 𝒢𝒱 in place of 𝓕.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn from_rest<'a, S: Scalar>(V_s: Twist<S>) -> Environment<'a, S> {
    Environment { base_acceleration: V_s, ..Environment::with_gravity(Vec3::zero()) }
}

/// A twist given in {s}, in the base's coordinates.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn in_base<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, theta: &[S], X_s: Twist<S>) -> Twist<S> {
    base_pose(model, theta).inverse().Ad() * X_s
}

/// How the rates x move a floating base.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn of_base<S: Scalar, C: Scalar>(model: &Model<C>, x: &[S]) -> Twist<S> {
    match x.first_chunk() {
        Some(&first) if model.is_floating() => Twist::from_array(first),
        _ => Twist::zero(),
    }
}

pass! {
/// Inward: adds the products to `[by θ, by θ̇, by θ̈]`. Requires the results of the outward pass along X in the
/// workspace: T_{i,i−1}, the rates of the axes, 𝓕, X, Q and R of each link; `X_s` is how {s} moves, in the base's
/// coordinates.
pub(super) fn add_products<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    X_s: Option<Twist<S>>,
    environment: &Environment<S>,
    workspace: &mut Workspace<S>,
    products: [&mut [S]; 3],
) {
    let [d_theta, d_dtheta, d_ddtheta] = products;
    match model.structure.of_one_axis {
        true => inward::<true, S, C>(model, workspace, [d_theta, d_dtheta, d_ddtheta]),
        false => inward::<false, S, C>(model, workspace, [d_theta, d_dtheta, d_ddtheta]),
    }
    if !model.is_floating() {
        return;
    }
    let [by_theta, by_rates] = BaseRates::of_derivatives(model, theta, environment, workspace);
    let (Q, R) = (workspace.composite.Q[0], workspace.composite.B[0].f); // 𝓠ᶜ and 𝓡ᶜ of all
    let mut of_theta = by_theta.dot(Q, R);
    if let Some(X_s) = X_s {
        of_theta += X_s.ad().transpose() * workspace.recursion.F[0];
    }
    let entries = [of_theta, by_rates.dot(Q, R), Q];
    for (sum, entries) in [d_theta, d_dtheta, d_ddtheta].into_iter().zip(entries) {
        for (k, entry) in entries.to_array().into_iter().enumerate() {
            sum[k] += entry;
        }
    }
}
}

#[cfg_attr(not(debug_assertions), inline(always))]
#[rustfmt::skip] // one equation a line
fn inward<const ONE_AXIS: bool, S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, workspace: &mut Workspace<S>, [d_theta, d_dtheta, d_ddtheta]: [&mut [S]; 3],
) {
    let slots = model.links.len() + 1;
    let Workspace { recursion: Recursion { T, X, F, carrier, .. }, composite: Composite { Q, by_theta, by_rates, B, .. }, .. } = workspace;
    let (T, X, F, Q) = (&T[..slots], &X[..slots], &mut F[..slots], &mut Q[..slots]);
    let (by_theta, by_rates, B) = (&by_theta[..slots], &by_rates[..slots], &mut B[..slots]);
    for (i, link) in model.inward::<S>() {
        let link = link.among::<ONE_AXIS>();
        let (p, j, A, Ad) = (link.parent, link.j, link.A(), T[i].Ad().transpose());
        let (Q_i, R_i, F_i) = (Q[i], B[i].f, F[i]);
        let X_c = if link.has_one_axis() { X[i] } else { carrier[i][2] };    // the joint's own part is along A
        d_theta[j]   += by_theta[i].dot(Q_i, R_i) + (X_c.ad() * A).rate().dot(F_i);
        d_dtheta[j]  += by_rates[i].dot(Q_i, R_i);
        d_ddtheta[j] += A * Q_i;
        (F[p], Q[p]) = (Ad.mul_add(F_i, F[p]), Ad.mul_add(Q_i, Q[p]));
        B[p].f += T[i].R.inverse_mul(R_i);
    }
}

pass! {
/// Adds the products of a number with the derivative Q_bᵀ∂𝒱̇_b + R_bᵀ∂ω_b at the links of a motion, which `sources`
/// sets from the outward pass.
pub(super) fn add_products_of<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    ddtheta: &[S],
    environment: &Environment<S>,
    workspace: &mut Workspace<S>,
    sources: impl FnOnce(&mut Workspace<S>),
    products: [&mut [S]; 3],
) {
    outward_pass(model, theta, dtheta, ddtheta, environment, None, workspace);
    for X in workspace.recursion.X.iter_mut().chain(workspace.recursion.carrier.iter_mut().flatten()) {
        *X = Twist::zero();
    }
    workspace.composite.Q.fill(Wrench::zero());
    for B in &mut workspace.composite.B {
        B.f = Vec3::zero();
    }
    sources(workspace);
    workspace.recursion.F.fill(Wrench::zero());
    add_products(model, theta, None, environment, workspace, products);
}
}
