//! Composite rigid bodies: what a link and all links beyond it have together, for M, C, ∂τ and ∂θ̈ (Walker and Orin
//! 1982; Featherstone 2008, section 6.2; Echeandia and Wensing 2021; Singh, Russell and Wensing 2022).
//!
//! Each of these n × n matrices has the same form, with another pair of twists (r, s) for each axis:
//!
//! > X_ij = A_iᵀ (𝒢ᶜ r_j + 𝓑ᶜ s_j) for i and j on one path from the base to a tip, else 0
//!
//! with 𝒢ᶜ and 𝓑ᶜ of the outer one of i and j. A is a joint's screw axis, 𝒢ᶜ the composite inertia of its link, 𝓑ᶜ the
//! sum of 𝓑 = 𝒢̇ + H(𝒢𝒱) (see [`CoriolisFactor`](crate::spatial::CoriolisFactor)).
//!
//! | X | r | s |
//! |---|---|---|
//! | M | A | 0 |
//! | C | `[ad_𝒱]` A, 𝒱 of the joint's link | ½ A |
//! | ∂τ/∂θ̇ | D | A |
//! | ∂τ/∂θ | Ä | Ȧ |
//!
//! D, Ȧ and Ä are explained in `derivatives.rs`; ∂τ_i/∂θ_j has one more term if j is beyond i. A mimic joint's axis is
//! multiplied by its ratio, and its entries are added to its source joint's.
//!
//! So row and column j of each matrix are filled on one way from link j to the base: the wrench 𝒢ᶜr_j + 𝓑ᶜs_j of axis j
//! meets each axis A_i on the way, for X_ij; and 𝒢ᶜA_j and the moment 𝓑ᶜᵀA_j meet each pair (r_i, s_i), for X_ji.
//! Bodies and wrenches are in each link's own frame, whose z is the joint's axis.

use crate::model::Model;
use crate::scalar::Scalar;
use crate::workspace::{Composite, Recursion, Workspace};

/// 𝒢ᶜ of each link and of a floating base.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn composite_inertias<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, workspace: &mut Workspace<S>) {
    let slots = model.links.len() + 1;
    let (T, G) = (&workspace.recursion.T[..slots], &mut workspace.composite.G[..slots]);
    G[0] = model.base_inertia.map(S::from);
    for (i, link) in model.outward::<S>() {
        G[i] = link.G();
    }
    for (i, link) in model.inward::<S>() {
        if link.parent > 0 || model.is_floating() {
            G[link.parent] = G[i].congruence_add(T[i].Ad(), G[link.parent]);
        }
    }
}

/// 𝒢, 𝓑 and, if `WRENCHES`, 𝓕 of each link become those of its composite body.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn add_up_bodies<const WRENCHES: bool, S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    workspace: &mut Workspace<S>,
) {
    let slots = model.links.len() + 1;
    let Workspace { recursion: Recursion { T, F, .. }, composite: Composite { G: G_c, B, .. }, .. } = workspace;
    let (T, G, B, F) = (&T[..slots], &mut G_c[..slots], &mut B[..slots], &mut F[..slots]);
    for (i, link) in model.inward::<S>() {
        let (p, Ad) = (link.parent, T[i].Ad());
        if p > 0 || model.is_floating() {
            G[p] = G[i].congruence_add(Ad, G[p]);
            B[p] += B[i].congruence(Ad);
            if WRENCHES {
                F[p] = Ad.transpose().mul_add(F[i], F[p]);
            }
        }
    }
}
