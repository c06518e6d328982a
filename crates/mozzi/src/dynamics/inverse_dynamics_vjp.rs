//! xᵀ∂τ: a vector times the derivatives of inverse dynamics, in O(n), without the matrices.
//!
//! By [`derivatives.rs`](super::inverse_dynamics_derivatives), an entry of ∂τ/∂θ is A_iᵀ(𝒢ᶜÄ_j + 𝓑ᶜȦ_j) with 𝒢ᶜ and 𝓑ᶜ
//! of the outer one of i and j, less A_iᵀ`[ad_A_j]`ᵀ𝓕ᶜ_j if j is beyond i. Let x be rates of the joints. They move link
//! b, in its own coordinates, by
//!
//! > X_b = X_p + A_b x_b, the sum of A_i x_i from the base on
//!
//! With the sums over all links that joint j carries, 𝓠ᶜ = Σ 𝒢X, 𝓡ᶜ = Σ 𝓑ᵀX and 𝓕ᶜ = Σ 𝓕, the sum over i is
//!
//! > xᵀ∂τ/∂θ_j = Ä_jᵀ𝓠ᶜ + Ȧ_jᵀ𝓡ᶜ + (`[ad_X_p]` A_j)ᵀ𝓕ᶜ
//! >
//! > xᵀ∂τ/∂θ̇_j = D_jᵀ𝓠ᶜ + A_jᵀ𝓡ᶜ
//! >
//! > xᵀ∂τ/∂θ̈_j = A_jᵀ𝓠ᶜ
//!
//! where X_p is the motion of the link that carries the joint. 𝓑ᵀX is a moment: 𝓡 has three numbers. One pass goes
//! outward and one inward.

use super::armature::{add_rotor_forces, add_velocity_product_vjp};
use super::derivatives::{base_rates, outward_pass};
use crate::kinematics::joint_transforms;
use crate::model::{Environment, Model, Workspace};
use crate::quantity::{
    ANY, CONSTANT_VECTOR, Call, DDTHETA, DTHETA, Declaration, Kernel, Quantity, THETA, Uses, VECTOR, output,
};
use crate::scalar::Scalar;
use crate::spatial::Twist;

/// The vector-Jacobian products of [`inverse_dynamics`](super::inverse_dynamics()), `[xᵀ∂τ/∂θ, xᵀ∂τ/∂θ̇, xᵀ∂τ/∂θ̈]`,
/// each n long: the gradient of xᵀτ for a constant x, which is n long.
///
/// They are xᵀ times the matrices of [`inverse_dynamics_derivatives`](super::inverse_dynamics_derivatives()), with the
/// same conventions: an entry of xᵀ∂τ/∂θ is along a velocity. xᵀ∂τ/∂θ̈ is Mx.
///
/// Cost O(n), no allocation.
///
/// # Panics
/// When θ is not nq long, or another slice not n.
#[cfg_attr(not(test), inline(always))]
#[allow(clippy::too_many_arguments)] // the derivatives', and x
pub fn inverse_dynamics_vjp<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    ddtheta: &[S],
    x: &[S],
    environment: &Environment<S>,
    workspace: &mut Workspace<S>,
    [d_theta, d_dtheta, d_ddtheta]: [&mut [S]; 3],
) {
    model.assert_lengths(theta.len(), [x.len(), d_theta.len(), d_dtheta.len(), d_ddtheta.len()]);
    joint_transforms(model, theta, workspace);
    outward_pass(model, theta, dtheta, ddtheta, environment, workspace);
    for j in 0..model.n() {
        d_theta[j] = S::zero();
        d_dtheta[j] = S::from(model.damping[j]) * x[j];
        d_ddtheta[j] = S::from(model.armature[j]) * x[j];
    }
    for spring in &model.springs {
        spring.add_vjp(theta, x, d_theta);
    }
    add_velocity_product_vjp(model, dtheta, x, d_dtheta);
    add_rotor_forces(model, x, d_ddtheta);
    match model.structure.of_one_axis {
        true => sweep::<true, S, C>(model, x, workspace, [d_theta, d_dtheta, d_ddtheta]),
        false => sweep::<false, S, C>(model, x, workspace, [d_theta, d_dtheta, d_ddtheta]),
    }
    if model.is_floating() {
        let [by_theta, by_rates] = base_rates(model, theta, environment, workspace);
        let (Q, R) = (workspace.U[0], workspace.B[0].f); // 𝓠ᶜ and 𝓡ᶜ of all
        for (k, entry) in by_theta.dot(Q, R).to_array().into_iter().enumerate() {
            d_theta[k] += entry;
        }
        for (k, entry) in by_rates.dot(Q, R).to_array().into_iter().enumerate() {
            d_dtheta[k] += entry;
        }
        for (k, entry) in Q.to_array().into_iter().enumerate() {
            d_ddtheta[k] += entry;
        }
    }
}

/// Adds the entries of the joints. The workspace holds what the outward pass of the derivatives leaves: T_{i,i−1}, the
/// rates of the axes, 𝒢, 𝓑 and 𝓕 of each link.
#[inline(always)]
#[rustfmt::skip] // one equation a line
fn sweep<const ONE_AXIS: bool, S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, x: &[S], workspace: &mut Workspace<S>, [d_theta, d_dtheta, d_ddtheta]: [&mut [S]; 3],
) {
    let slots = model.links.len() + 1;
    let Workspace { T, dV, F, U, carrier, by_theta, by_rates, G_c, B, .. } = workspace;
    let (T, X, F, Q) = (&T[..slots], &mut dV[..slots], &mut F[..slots], &mut U[..slots]);
    let (by_theta, by_rates, G, B) = (&by_theta[..slots], &by_rates[..slots], &G_c[..slots], &mut B[..slots]);

    // base to tips: how x moves each link, in place of 𝒱̇; 𝓠, and 𝓡 in place of f
    X[0] = match x.first_chunk() {
        Some(&first) if model.is_floating() => Twist::from_array(first),
        _ => Twist::zero(),
    };
    (Q[0], B[0].f) = (G[0] * X[0], B[0].transpose_mul_twist(X[0]));
    for (i, link) in model.outward::<S>() {
        let link = link.among::<ONE_AXIS>();
        let (p, Ad) = (link.parent, T[i].Ad());
        let X_p = Ad * X[p];
        if !link.has_one_axis() {
            carrier[i][0] = if link.is_next() { Ad * carrier[p][0] } else { X_p };
        }
        X[i] = X_p + link.A() * x[link.j];
        (Q[i], B[i].f) = (G[i] * X[i], B[i].transpose_mul_twist(X[i]));
    }

    // tips to base: the sums, and each joint's entries
    for (i, link) in model.inward::<S>() {
        let link = link.among::<ONE_AXIS>();
        let (p, j, A, Ad) = (link.parent, link.j, link.A(), T[i].Ad().transpose());
        let (Q_i, R_i, F_i) = (Q[i], B[i].f, F[i]);
        let X_c = if link.has_one_axis() { X[i] } else { carrier[i][0] };    // the joint's own part is along A
        d_theta[j]   += by_theta[i].dot(Q_i, R_i) + (X_c.ad() * A).rate().dot(F_i);
        d_dtheta[j]  += by_rates[i].dot(Q_i, R_i);
        d_ddtheta[j] += A * Q_i;
        (F[p], Q[p]) = (Ad.mul_add(F_i, F[p]), Ad.mul_add(Q_i, Q[p]));
        B[p].f += T[i].R.inverse_mul(R_i);
    }
}

/// See [`inverse_dynamics_vjp`].
#[derive(Clone, Copy, Debug)]
pub struct InverseDynamicsVjp;
impl Quantity for InverseDynamicsVjp {
    type Kernel = Self;
    type Registers = Self;
    const DECLARATION: Declaration = Declaration::new(
        "inverse_dynamics_vjp",
        "xᵀ∂τ/∂θ, xᵀ∂τ/∂θ̇ and xᵀ∂τ/∂θ̈ = Mx, the gradient of xᵀτ; by θ along the velocities",
        &[THETA, DTHETA, DDTHETA, CONSTANT_VECTOR],
        &[output("d_theta", VECTOR, ANY), output("d_dtheta", VECTOR, ANY), output("d_ddtheta", VECTOR, ANY)],
    )
    .uses(Uses::ALL);
}
impl Kernel for InverseDynamicsVjp {
    #[inline(always)]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, ddtheta, x], [a, b, d, _]) = (c.inputs, c.outputs);
        let (workspace, outputs) = (&mut c.memory.workspace, [a, b, d]);
        inverse_dynamics_vjp(c.model, theta, dtheta, ddtheta, x, c.environment, workspace, outputs);
    }
}
