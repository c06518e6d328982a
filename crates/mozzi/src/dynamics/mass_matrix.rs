//! The mass matrix: composite rigid bodies (Walker and Orin 1982; Featherstone 2008, section 6.2).

use crate::kinematics::joint_transforms;
use crate::model::{Model, Workspace};
use crate::quantity::{Call, Declaration, INERTIA, Kernel, MATRIX, Quantity, THETA, output};
use crate::scalar::Scalar;

/// M(θ), symmetric and positive definite, n × n, row-major into `M`; armature on the diagonal. kg m², kg m or kg.
///
/// Each link's composite inertia 𝒢ᶜ holds all that hangs from it. Accelerating joint i alone needs the wrench 𝒢ᶜA at
/// link i, which every joint between it and the base feels. A floating base's six rows and columns come first; their block is the
/// whole robot's composite inertia.
///
/// Cost O(n · depth), no allocation.
///
/// # Panics
/// When θ is not nq long, or `M` not n².
#[cfg_attr(not(test), inline(always))]
#[rustfmt::skip]
pub fn mass_matrix<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, theta: &[S], workspace: &mut Workspace<S>, M: &mut [S]) {
    let n = model.n();
    model.assert_lengths(theta.len(), []);
    assert!(M.len() == n * n, "M has {} entries, expected n² = {}", M.len(), n * n);
    joint_transforms(model, theta, workspace);
    let slots = model.links.len() + 1;
    let (T, G_c) = (&workspace.T[..slots], &mut workspace.G_c[..slots]);

    M.fill(S::zero());
    for (j, &armature) in model.armature.iter().enumerate() {
        M[j * n + j] = S::from(armature);
    }
    G_c[0] = model.base_inertia.map(S::from);
    for (i, link) in model.outward::<S>() {
        G_c[i] = link.G();
    }
    for (i, link) in model.inward::<S>() {
        let j = link.j;
        let (p, G) = (link.parent, G_c[i]);
        let mut F = G * link.A() * link.ratio();                            // 𝒢ᶜ A
        M[j * n + j] += link.ratio() * (link.A() * F);
        let mut k = i;
        for (below_k, below) in model.to_base::<S>(p) {
            F = T[k].Ad().transpose() * F;                                   // seen from the link below
            k = below_k;
            let entry = below.ratio() * (below.A() * F);
            M[j * n + below.j] += entry;
            M[below.j * n + j] += entry;
        }
        if model.is_floating() {
            F = T[k].Ad().transpose() * F;                                   // seen from the base
            for (r, entry) in F.to_array().into_iter().enumerate() {
                M[j * n + r] += entry;
                M[r * n + j] += entry;
            }
        }
        if p > 0 || model.is_floating() {
            G_c[p] = G.congruence_add(T[i].Ad(), G_c[p]);
        }
    }
    if model.is_floating() {
        for (row, entries) in M.chunks_exact_mut(n).zip(G_c[0].to_matrix()) {
            row[..6].copy_from_slice(&entries);
        }
    }
}

/// See [`mass_matrix`].
#[derive(Clone, Copy, Debug)]
pub struct MassMatrix;
impl Quantity for MassMatrix {
    type Kernel = Self;
    type Registers = Self;
    const DECLARATION: Declaration = Declaration::new(
        "mass_matrix",
        "M(θ), symmetric, with the rotors' inertia on its diagonal",
        &[THETA],
        &[output("M", MATRIX, INERTIA)],
    );
}
impl Kernel for MassMatrix {
    #[inline(always)]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, ..], [M, ..]) = (c.inputs, c.outputs);
        mass_matrix(c.model, theta, &mut c.memory.workspace, M);
    }
}
