//! ∂τ of inverse dynamics, by every argument at once.

use super::armature::{add_velocity_product_rates, set_armature};
use super::base_rates::BaseRates;
use super::composite_bodies::add_up_bodies;
use super::derivatives::{add_damping, outward_pass};
use super::several_axes::carried_together;
use super::spring_forces::add_stiffness;
use crate::kinematics::joint_transforms;
use crate::linalg::{Square, Vec3};
use crate::model::{Environment, Model};
use crate::quantities::{
    Call, D_FORCE, DDTHETA, DTHETA, Declaration, Kernel, MATRIX, Quantity, THETA, Uses, output, symmetric,
};
use crate::scalar::{Scalar, pass};
use crate::spatial::{Twist, Wrench, Wrenches};
use crate::workspace::Workspace;

pass! {
/// The derivatives of [`inverse_dynamics`](super::inverse_dynamics()), `[∂τ/∂θ, ∂τ/∂θ̇, ∂τ/∂θ̈ = M]`, each n × n,
/// row-major: row i is τ_i's.
///
/// Column j of ∂τ/∂θ is along the j-th velocity, θ ⊕ e_j ε as [`integrate`](crate::model::integrate) moves it: an
/// entry of θ for a joint, the body twist of a floating base, in its own coordinates. Applied wrenches keep their
/// coordinates in their frames, and {s} keeps its motion. Springs add k to the diagonal of ∂τ/∂θ, friction d to that of
/// ∂τ/∂θ̇ (the derivative of sgn is 0), armature to that of M. N m, N per rad, m, rad/s, ….
///
/// Entries are 0 unless [`couples`](Model::couples) i and j.
///
/// Cost O(n · depth) plus 3 n² zeros, no allocation.
///
/// # Panics
/// When θ is not nq long, θ̇ or θ̈ not n, or a derivative not n².
pub fn inverse_dynamics_derivatives<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, theta: &[S], dtheta: &[S], ddtheta: &[S],
    environment: &Environment<S>, workspace: &mut Workspace<S>, matrices: [&mut [S]; 3],
) {
    let ([d_theta, d_dtheta, M], n) = (matrices, model.n());
    joint_transforms(model, theta, workspace);
    outward_pass(model, theta, dtheta, ddtheta, environment, None, workspace);
    let base = BaseRates::of_derivatives(model, theta, environment, workspace);
    add_up_bodies::<true, S, C>(model, workspace);
    set_armature(model, M);
    let matrices = [Square::zero(n, d_theta), Square::zero(n, d_dtheta), Square::new(n, M)];
    fill_derivatives::<3, S, C>(model, base, workspace, matrices);
    add_damping(model, d_dtheta);
    add_stiffness(model, theta, d_theta);
    add_velocity_product_rates(model, dtheta, d_dtheta);
}
}

/// Adds the links' part of the first K of ∂τ/∂θ, ∂τ/∂θ̇ and M to K matrices, from T_{i,i−1}, the pairs and the
/// composite bodies in the workspace.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn fill_derivatives<const K: usize, S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    base: [BaseRates<S>; 2],
    workspace: &Workspace<S>,
    mut X: [Square<S>; K],
) {
    let slots = model.links.len() + 1;
    let (T, F, G, B) = (
        &workspace.recursion.T[..slots],
        &workspace.recursion.F[..slots],
        &workspace.composite.G[..slots],
        &workspace.composite.B[..slots],
    );
    let (by_theta, by_rates) = (&workspace.composite.by_theta[..slots], &workspace.composite.by_rates[..slots]);
    for (j, joint) in model.outward::<S>() {
        let (jj, A, f) = (joint.j, joint.A(), Vec3::zero());
        let past = A.ad_transpose(F[j]); // 𝓕ᶜ moves past the axes below
        let of_theta = by_theta[j].column(G[j], B[j]) - past; // 𝒢ᶜÄ + 𝓑ᶜȦ − [ad_A]ᵀ𝓕ᶜ
        let of_rates = if K > 1 { by_rates[j].column(G[j], B[j]) } else { Wrench::zero() }; // 𝒢ᶜD + 𝓑ᶜA
        let (row, m) = (G[j] * A, B[j].transpose_mul(A)); // 𝒢ᶜA, 𝓑ᶜᵀA
        X[0][(jj, jj)] += A * of_theta;
        if K > 1 {
            X[1][(jj, jj)] += A * of_rates;
        }
        if K > 2 {
            X[2][(jj, jj)] += A * row;
        }
        if joint.is_next() {
            carried_together(model, j, T, past, &mut X[0]);
        }
        let mut load = Wrenches::new([of_theta, of_rates, row, Wrench { m, f }]);
        for (link, i, below) in model.steps_to_base::<S>(j) {
            load = load.carried(&T[link]);
            let [of_theta, of_rates, row, Wrench { m, .. }] = load.parts();
            match below {
                Some(below) => {
                    let (ii, A) = (below.j, below.A());
                    X[0].add_pair(ii, jj, [A * of_theta, by_theta[i].dot(row, m)]);
                    if K > 1 {
                        X[1].add_pair(ii, jj, [A * of_rates, by_rates[i].dot(row, m)]);
                    }
                    if K > 2 {
                        X[2].add_pair(ii, jj, [A * row; 2]);
                    }
                }
                None => {
                    X[0].add_sixes(jj, of_theta.to_array(), base[0].dot(row, m).to_array());
                    if K > 1 {
                        X[1].add_sixes(jj, of_rates.to_array(), base[1].dot(row, m).to_array());
                    }
                    if K > 2 {
                        X[2].add_sixes(jj, row.to_array(), row.to_array());
                    }
                }
            }
        }
    }
    if model.is_floating() {
        for (k, e) in Twist::axes().into_iter().enumerate() {
            X[0].set_six(k, base[0].column(e, G[0], B[0]).to_array());
            if K > 1 {
                X[1].set_six(k, base[1].column(e, G[0], B[0]).to_array());
            }
            if K > 2 {
                X[2].set_six(k, (G[0] * e).to_array());
            }
        }
    }
}

/// See [`inverse_dynamics_derivatives`].
#[derive(Clone, Copy, Debug)]
pub struct InverseDynamicsDerivatives;
impl Quantity for InverseDynamicsDerivatives {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "inverse_dynamics_derivatives",
        "∂τ/∂θ, ∂τ/∂θ̇ and ∂τ/∂θ̈ = M, row i of τ_i; by θ along the velocities",
        &[THETA, DTHETA, DDTHETA],
        &[
            output("d_theta", MATRIX, D_FORCE),
            output("d_dtheta", MATRIX, D_FORCE),
            symmetric("d_ddtheta", MATRIX, D_FORCE),
        ],
    )
    .uses(Uses::ALL);
}
impl Kernel for InverseDynamicsDerivatives {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, ddtheta, ..], [a, b, M, _]) = (c.inputs, c.outputs);
        inverse_dynamics_derivatives(
            c.model,
            theta,
            dtheta,
            ddtheta,
            c.environment,
            &mut c.memory.workspace,
            [a, b, M],
        );
    }
}
