//! The Coriolis matrix of the Christoffel symbols and the rate of the mass matrix (Echeandia and Wensing 2021).

use crate::kinematics::{base_twist, joint_transforms};
use crate::lie::SE3;
use crate::linalg::add_transpose;
use crate::model::{Model, Workspace};
use crate::quantity::{Call, DTHETA, Declaration, Kernel, MATRIX, Quantity, THETA, output};
use crate::scalar::Scalar;
use crate::spatial::{Twist, Wrench};

/// C(θ, θ̇) of the Christoffel symbols, n × n, row-major into `C`: Cθ̇ = c and Ṁ − 2C skew-symmetric; base at rest.
///
/// > C = Σ_k J_kᵀ (𝒢_k J̇_k + ½ (𝒢`[ad_𝒱]` − `[ad_𝒱]`ᵀ𝒢 + H(𝒢𝒱)) J_k), H(m, f) = `[[−[m], −[f]], [−[f], 0]]`
///
/// With J̇_k = Ad `[ad_𝒱_i]` A_i − `[ad_𝒱_k]` Ad A_i, what stands before Ad A_i is ½ (𝒢̇ + H(𝒢𝒱)): the rate of the
/// inertia and its momentum, which add up over composite bodies. (The factor of θ̇ in the book's c gives Cθ̇ = c too, but
/// Ṁ − 2C is not skew for it.) A floating base's velocities are no coordinates' rates and have no Christoffel symbols; the same
/// formula gives a C with the same two properties for it.
///
/// Cost O(n · depth), no allocation.
///
/// # Panics
/// When θ is not nq long, θ̇ not n, or `C` not n².
#[cfg_attr(not(test), inline(always))]
#[rustfmt::skip]
pub fn coriolis_matrix<S: Scalar + From<C0>, C0: Scalar>(
    model: &Model<C0>, theta: &[S], dtheta: &[S], workspace: &mut Workspace<S>, C: &mut [S],
) {
    with_base_twist(model, theta, dtheta, base_twist(model, theta, dtheta, Twist::zero()), workspace, C);
}

/// C at this twist of the base.
#[cfg_attr(not(test), inline(always))]
#[rustfmt::skip]
fn with_base_twist<S: Scalar + From<C0>, C0: Scalar>(
    model: &Model<C0>, theta: &[S], dtheta: &[S], base_twist: Twist<S>, workspace: &mut Workspace<S>, C: &mut [S],
) {
    let n = model.n();
    model.assert_lengths(theta.len(), [dtheta.len()]);
    assert!(C.len() == n * n, "C has {} entries, expected n² = {}", C.len(), n * n);
    joint_transforms(model, theta, workspace);
    let Workspace { T, V, dV, F: P, G_c, dG_c, .. } = workspace;
    let half = S::from_f64(0.5);

    C.fill(S::zero());
    V[0] = base_twist;
    let G_0 = model.base_inertia.map(S::from);
    (G_c[0], dG_c[0], P[0]) = (G_0, G_0.rate(V[0]), G_0 * V[0]);
    for (i, link) in model.outward::<S>() {
        V[i]    = T[i].Ad() * V[link.parent] + link.A() * link.rate(dtheta);
        dV[i]   = (V[i].ad() * (link.A() * link.ratio())).twist();                         // rate of A, per unit of θ̇_j
        G_c[i]  = link.G();
        dG_c[i] = link.G().rate(V[i]);
        P[i]    = link.G() * V[i];                                             // momentum
        if link.is_last && link.is_next() {
            moved_by_all(model, i, T, V, dV);
        }
    }
    for (i, link) in model.inward::<S>() {
        let (j, A) = (link.j, link.A().twist() * link.ratio());
        let (dGA, HA): (Wrench<S>, Wrench<S>) = (dG_c[i] * A, -(A.ad().transpose() * P[i]));
        let mut F1 = G_c[i] * dV[i] + (dGA + HA) * half;                     // column j of C, as a wrench
        let mut F2 = G_c[i] * A;                                             // row j: times the rate of A …
        let mut F3 = (dGA - HA) * half;                                      // … and times A
        C[j * n + j] += A.dot(F1);
        let mut k = i;
        while model.links[k - 1].parent > 0 {
            let Ad = T[k].Ad().transpose();
            (F1, F2, F3) = (Ad * F1, Ad * F2, Ad * F3);
            k = model.links[k - 1].parent;
            let below = model.link::<S>(k);
            C[below.j * n + j] += below.ratio() * (below.A() * F1);
            C[j * n + below.j] += dV[k].dot(F2) + below.ratio() * (below.A() * F3);
        }
        if model.is_floating() {
            let Ad = T[k].Ad().transpose();
            (F1, F2, F3) = (Ad * F1, Ad * F2, Ad * F3);
            let row = V[0].ad().transpose() * F2 + F3;                       // each axis e turns with [ad_𝒱_0] e
            for (r, (column, row)) in F1.to_array().into_iter().zip(row.to_array()).enumerate() {
                C[r * n + j] += column;
                C[j * n + r] += row;
            }
        }
        if link.parent > 0 || model.is_floating() {
            let Ad = T[i].Ad();
            let (G_i, dG_i, P_i) = (G_c[i].congruence(Ad), dG_c[i].congruence(Ad), Ad.transpose() * P[i]);
            G_c[link.parent]  += G_i;
            dG_c[link.parent] += dG_i;
            P[link.parent]    += P_i;
        }
    }
    if model.is_floating() {
        for (r, e) in Twist::axes().into_iter().enumerate() {
            let column = G_c[0] * (V[0].ad() * e) + (dG_c[0] * e - e.ad().transpose() * P[0]) * half;
            for (s, entry) in column.to_array().into_iter().enumerate() {
                C[s * n + r] = entry;
            }
        }
    }
}

/// The rates of the axes of a ball or a free joint, whose last is i: its link moves them all.
#[cfg_attr(not(test), inline(always))]
#[rustfmt::skip]
fn moved_by_all<S: Scalar + From<C0>, C0: Scalar>(model: &Model<C0>, i: usize, T: &[SE3<S>], V: &[Twist<S>], dV: &mut [Twist<S>]) {
    let mut V_J = V[i];
    let mut above = i;
    for (k, link) in model.to_base::<S>(model.links[i - 1].parent) {
        V_J = T[above].inverse().Ad() * V_J;
        dV[k] = (V_J.ad() * link.unit()).twist();
        if !link.is_next() {
            break;
        }
        above = k;
    }
}

/// Ṁ = C + Cᵀ, n × n, row-major into `dM`; base at rest. M does not depend on where a floating base is, so its twist is left out: in C + Cᵀ
/// what it adds would cancel, up to rounding.
///
/// Cost O(n · depth), no allocation.
///
/// # Panics
/// When θ is not nq long, θ̇ not n, or `dM` not n².
#[cfg_attr(not(test), inline(always))]
pub fn mass_matrix_rate<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    workspace: &mut Workspace<S>,
    dM: &mut [S],
) {
    with_base_twist(model, theta, dtheta, Twist::zero(), workspace, dM);
    add_transpose(model.n(), dM);
}

/// See [`coriolis_matrix`]. The kernel answers Ṁ where that is kept.
#[derive(Clone, Copy, Debug)]
pub struct CoriolisMatrix;
impl Quantity for CoriolisMatrix {
    type Kernel = Self;
    type Registers = Self;
    const DECLARATION: Declaration = Declaration::new(
        "coriolis_matrix",
        "C(θ, θ̇) of the Christoffel symbols: c = Cθ̇, and Ṁ − 2C is skew-symmetric",
        &[THETA, DTHETA],
        &[output("C", MATRIX, "N m s or N s")],
    );
}
impl Kernel for CoriolisMatrix {
    #[inline(always)]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, _], [C, dM, ..], w) = (c.inputs, c.outputs, &mut c.memory.workspace);
        // one text for both, compiled once
        let (base, X) = match dM.is_empty() {
            true => (base_twist(c.model, theta, dtheta, Twist::zero()), C),
            false => (Twist::zero(), &mut *dM),
        };
        with_base_twist(c.model, theta, dtheta, base, w, X);
        if !dM.is_empty() {
            add_transpose(c.model.n(), dM);
        }
    }
}

/// See [`mass_matrix_rate`].
#[derive(Clone, Copy, Debug)]
pub struct MassMatrixRate;
impl Quantity for MassMatrixRate {
    type Kernel = CoriolisMatrix;
    type Registers = CoriolisMatrix;
    const DECLARATION: Declaration = Declaration::new(
        "mass_matrix_rate",
        "Ṁ(θ, θ̇) = C + Cᵀ",
        &[THETA, DTHETA],
        &[output("dM", MATRIX, "kg m²/s, kg m/s or kg/s")],
    )
    .with_first_output(1);
}
