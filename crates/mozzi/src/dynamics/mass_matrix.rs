//! The mass matrix: composite rigid bodies (Walker and Orin 1982; Featherstone 2008, section 6.2).

use super::armature::set_armature;
use super::composite_bodies::composite_inertias;
use crate::kinematics::joint_transforms;
use crate::linalg::Square;
use crate::model::Error;
use crate::model::Model;
use crate::quantities::{Call, Declaration, INERTIA, Kernel, MATRIX, Quantity, THETA, symmetric};
use crate::scalar::{Scalar, pass};
use crate::spatial::Twist;
use crate::workspace::Workspace;
use nalgebra::DMatrix;

pass! {
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
pub fn mass_matrix<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, theta: &[S], workspace: &mut Workspace<S>, M: &mut [S]) {
    model.assert_lengths(theta.len(), []);
    joint_transforms(model, theta, workspace);
    composite_inertias(model, workspace);
    fill_mass_matrix(model, workspace, M);
}
}

/// M_ij = A_iᵀ 𝒢ᶜ_j A_j for i at or before j, from T_{i,i−1} and 𝒢ᶜ in the workspace.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn fill_mass_matrix<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    workspace: &Workspace<S>,
    M: &mut [S],
) {
    set_armature(model, M);
    let slots = model.links.len() + 1;
    let (mut M, T, G) = (Square::new(model.n(), M), &workspace.recursion.T[..slots], &workspace.composite.G[..slots]);
    for (j, joint) in model.outward::<S>() {
        let mut F = G[j] * joint.A(); // moves all beyond joint j
        M[(joint.j, joint.j)] += joint.A() * F; // (8.54)
        let mut link = j;
        for (i, below) in model.to_base::<S>(joint.parent) {
            F = T[link].Ad().transpose() * F; // seen from its parent: (8.53)
            M.add_pair(below.j, joint.j, [below.A() * F; 2]); // (8.54)
            link = i;
        }
        if model.is_floating() {
            F = T[link].Ad().transpose() * F;
            M.add_sixes(joint.j, F.to_array(), F.to_array());
        }
    }
    if model.is_floating() {
        for (k, e) in Twist::axes().into_iter().enumerate() {
            M.set_six(k, (G[0] * e).to_array());
        }
    }
}

/// See [`mass_matrix`].
#[derive(Clone, Copy, Debug)]
pub struct MassMatrix;
#[doc(hidden)]
impl Quantity for MassMatrix {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "mass_matrix",
        "M(θ), symmetric, with the rotors' inertia on its diagonal",
        &[THETA],
        &[symmetric("M", MATRIX, INERTIA)],
    );
}
#[doc(hidden)]
impl Kernel for MassMatrix {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, ..], [M, ..]) = (c.inputs, c.outputs);
        mass_matrix(c.model, theta, &mut c.memory.workspace, M);
    }
}

impl Model<f64> {
    /// M(θ): see [`mass_matrix`](mass_matrix()).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn mass_matrix(&self, theta: &[f64]) -> Result<DMatrix<f64>, Error> {
        self.matrix(MassMatrix, &[theta], &self.environment())
    }
}
