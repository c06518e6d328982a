//! The gradients of the energies, in O(n).

use super::armature::add_rotor_forces;
use super::bias_forces::{gravity_forces, take_zeros};
use super::spring_forces::add_spring_forces;
use super::vjp::{add_products_of, from_rest};
use crate::kinematics::joint_transforms;
use crate::linalg::Vec3;
use crate::model::Model;
use crate::quantities::{
    Call, DTHETA, Declaration, FORCE, Kernel, Memory, Quantity, THETA, Uses, VECTOR, output, sized,
};
use crate::scalar::Scalar;
use crate::spatial::Twist;
use crate::workspace::Workspace;

/// The gradients of [`kinetic_energy`](super::kinetic_energy()) and [`potential_energy`](super::potential_energy()),
/// `[∂𝒦/∂θ, ∂𝒦/∂θ̇, ∂𝒫/∂θ]`, n numbers each; by θ along the velocities. `V_s` is the twist of {s}. With 𝓟ᶜ the momentum
/// of all links that joint j carries:
///
/// > ∂𝒦/∂θ_j = Ȧ_jᵀ𝓟ᶜ, ∂𝒦/∂θ̇_j = A_jᵀ𝓟ᶜ (= Mθ̇ if {s} is at rest), ∂𝒫/∂θ = g(θ) + f_s(θ)
///
/// N m or N by θ, N m s or N s by θ̇. `unused` is n numbers of memory. Cost O(n), no allocation.
///
/// # Panics
/// When θ is not nq long, or another slice not n.
#[cfg_attr(not(debug_assertions), inline(always))]
#[allow(clippy::too_many_arguments)] // the energies' five, memory and the gradients
pub fn energy_gradients<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    V_s: Twist<S>,
    gravity: Vec3<S>,
    workspace: &mut Workspace<S>,
    unused: &mut [S],
    [kinetic_by_theta, kinetic_by_dtheta, potential_by_theta]: [&mut [S]; 3],
) {
    model.assert_lengths(
        theta.len(),
        [dtheta.len(), unused.len(), kinetic_by_theta.len(), kinetic_by_dtheta.len(), potential_by_theta.len()],
    );
    gravity_forces(model, theta, gravity, workspace, potential_by_theta);
    add_spring_forces(model, theta, potential_by_theta);

    let zero = take_zeros(workspace);
    joint_transforms(model, theta, workspace);
    kinetic_by_theta.fill(S::zero());
    for j in 0..model.n() {
        (unused[j], kinetic_by_dtheta[j]) = (S::zero(), S::from(model.armature[j]) * dtheta[j]);
    }
    add_rotor_forces(model, dtheta, kinetic_by_dtheta);
    // d𝒦 = Σ 𝓟ᵀ∂𝒱: the sources are the momenta
    let momenta = |workspace: &mut Workspace<S>| {
        for (Q, P) in workspace.composite.Q.iter_mut().zip(&workspace.recursion.F) {
            *Q = *P;
        }
    };
    let products = [kinetic_by_theta, unused, kinetic_by_dtheta];
    add_products_of(model, theta, &zero, dtheta, &from_rest(V_s), workspace, momenta, products);
    workspace.vector = zero;
}

/// See [`energy_gradients`].
#[derive(Clone, Copy, Debug)]
pub struct EnergyGradients;
impl Quantity for EnergyGradients {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "energy_gradients",
        "∂𝒦/∂θ, ∂𝒦/∂θ̇ and ∂𝒫/∂θ of the kinetic and potential energy; by θ along the velocities",
        &[THETA, DTHETA],
        &[
            output("kinetic_d_theta", VECTOR, FORCE),
            output("kinetic_d_dtheta", VECTOR, "N m s or N s"),
            output("potential_d_theta", VECTOR, FORCE),
        ],
    )
    .uses(Uses::GRAVITY.and(Uses::BASE_TWIST))
    .is_of_masses();
}
impl Kernel for EnergyGradients {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, ..], [a, b, d, _], e) = (c.inputs, c.outputs, c.environment);
        let Memory { workspace, matrix, .. } = c.memory;
        let unused = sized(matrix, c.model.n(), S::zero());
        energy_gradients(c.model, theta, dtheta, e.base_twist, e.gravity, workspace, unused, [a, b, d]);
    }
}
