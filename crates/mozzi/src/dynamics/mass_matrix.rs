//! The mass matrix: composite rigid bodies (Walker and Orin 1982; Featherstone 2008, section 6.2).

use super::composite::{Does, Matrices, composite_pass};
use crate::kinematics::joint_transforms;
use crate::model::{Model, Workspace};
use crate::quantity::{Call, Declaration, INERTIA, Kernel, MATRIX, Quantity, THETA, symmetric};
use crate::scalar::{Scalar, apart};

/// M(θ), symmetric and positive definite, n × n, row-major into `M`; armature on the diagonal, and a JᵀJ for each rotor
/// that several joints turn. kg m², kg m or kg.
///
/// Each link's composite inertia 𝒢ᶜ includes all links that it carries. Accelerating joint i alone needs the wrench 𝒢ᶜA
/// at link i, which every joint between it and the base feels. A floating base's six rows and columns come first; their
/// block is the whole robot's composite inertia.
///
/// Cost O(n · depth), no allocation.
///
/// # Panics
/// When θ is not nq long, or `M` not n².
#[cfg_attr(not(debug_assertions), inline(always))]
#[rustfmt::skip]
pub fn mass_matrix<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, theta: &[S], workspace: &mut Workspace<S>, M: &mut [S]) {
    let n = model.n();
    model.assert_lengths(theta.len(), []);
    assert!(M.len() == n * n, "M has {} entries, expected n² = {}", M.len(), n * n);
    joint_transforms(model, theta, workspace);
    composite_inertias(model, workspace, M);
}

apart! {
/// M; the workspace already holds T_{i,i−1}(θ).
pub(crate) fn composite_inertias<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    workspace: &mut Workspace<S>,
    M: &mut [S],
) {
    workspace.G_c[0] = model.base_inertia.map(S::from);
    for (i, link) in model.outward::<S>() {
        workspace.G_c[i] = link.G();
    }
    let does = Does { adds_factors: false, adds_wrenches: false, keeps_columns: false, is_composite: false };
    composite_pass(model, workspace, Matrices { by_theta: None, by_rates: None, M: Some(M) }, does);
}
}

/// See [`mass_matrix`].
#[derive(Clone, Copy, Debug)]
pub struct MassMatrix;
impl Quantity for MassMatrix {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "mass_matrix",
        "M(θ), symmetric, with the rotors' inertia on its diagonal",
        &[THETA],
        &[symmetric("M", MATRIX, INERTIA)],
    );
}
impl Kernel for MassMatrix {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, ..], [M, ..]) = (c.inputs, c.outputs);
        mass_matrix(c.model, theta, &mut c.memory.workspace, M);
    }
}
