//! Kinetic and potential energy.

use super::armature::rotor_energy;
use crate::kinematics::{base_pose, joint_transforms, link_twists};
use crate::linalg::Vec3;
use crate::model::Model;
use crate::quantities::{Call, DTHETA, Declaration, Kernel, NUMBER, Quantity, THETA, Uses, output};
use crate::scalar::{Scalar, pass};
use crate::spatial::Twist;
use crate::workspace::Workspace;

pass! {
/// 𝒦 = ½ Σ 𝒱_iᵀ 𝒢_i 𝒱_i + ½ Σ armature θ̇² = ½ θ̇ᵀMθ̇ in joules, of the moving links and a floating base. `V_s` is the
/// twist of {s} in its own coordinates (zero for ½ θ̇ᵀMθ̇).
///
/// Cost O(n), no allocation.
///
/// # Panics
/// When θ is not nq long, or θ̇ not n.
pub fn kinetic_energy<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, theta: &[S], dtheta: &[S], V_s: Twist<S>, workspace: &mut Workspace<S>,
) -> S {
    model.assert_lengths(theta.len(), [dtheta.len()]);
    joint_transforms(model, theta, workspace);
    link_twists(model, theta, dtheta, V_s, workspace);
    let V = &workspace.recursion.V;
    let mut twice = S::zero();
    if model.is_floating() {
        twice = V[0].dot(model.base_inertia.map(S::from) * V[0]);
    }
    for (i, link) in model.outward::<S>() {
        twice += V[i].dot(link.G() * V[i]);
    }
    (twice + rotor_energy(model, dtheta)) * S::from_f64(0.5)
}
}

pass! {
/// 𝒫 = −Σ m_i gᵀp_i + Σ ½k(θ − θ₀)² in joules, p_i the centres of mass of the moving links and a floating base, seen
/// from {s}; 0 for a mass at the origin of {s} and a spring at rest.
///
/// Cost O(n), no allocation.
///
/// # Panics
/// When θ is not nq long.
pub fn potential_energy<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, theta: &[S], gravity: Vec3<S>, workspace: &mut Workspace<S>,
) -> S {
    model.assert_lengths(theta.len(), []);
    let T = &mut workspace.recursion.T;
    T[0] = base_pose(model, theta);
    let mut first_moment = Vec3::zero();
    if model.is_floating() {
        let G = model.base_inertia.map(S::from);
        first_moment = T[0].R * G.mc + T[0].p * G.mass;
    }
    for (i, link) in model.outward::<S>() {
        T[i] = T[link.parent] * link.transform(theta).inverse();                 // T_{s,i}
        first_moment += T[i].R * link.G().mc + T[i].p * link.G().mass;
    }
    let mut springs = S::from(model.spring_energy);
    for spring in &model.springs {
        springs += spring.energy(theta);
    }
    springs - gravity.dot(first_moment)
}
}

/// See [`kinetic_energy`].
#[derive(Clone, Copy, Debug)]
pub struct KineticEnergy;
impl Quantity for KineticEnergy {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "kinetic_energy",
        "½θ̇ᵀMθ̇, of all that moves",
        &[THETA, DTHETA],
        &[output("energy", NUMBER, "J")],
    )
    .uses(Uses::BASE_TWIST)
    .is_of_masses();
}
impl Kernel for KineticEnergy {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, ..], [energy, ..]) = (c.inputs, c.outputs);
        energy[0] = kinetic_energy(c.model, theta, dtheta, c.environment.base_twist, &mut c.memory.workspace);
    }
}

/// See [`potential_energy`].
#[derive(Clone, Copy, Debug)]
pub struct PotentialEnergy;
impl Quantity for PotentialEnergy {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "potential_energy",
        "−Σ m gᵀp + Σ ½k(θ − θ₀)², p seen from the origin of {s}",
        &[THETA],
        &[output("energy", NUMBER, "J")],
    )
    .uses(Uses::GRAVITY)
    .is_of_masses();
}
impl Kernel for PotentialEnergy {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, ..], [energy, ..]) = (c.inputs, c.outputs);
        energy[0] = potential_energy(c.model, theta, c.environment.gravity, &mut c.memory.workspace);
    }
}
