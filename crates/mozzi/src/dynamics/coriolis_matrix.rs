//! The Coriolis matrix of the Christoffel symbols and the rate of the mass matrix (Echeandia and Wensing 2021).

use super::armature::add_coriolis_blocks;
use super::base_rates::BaseRates;
use super::composite_bodies::add_up_bodies;
use super::several_axes::add_moved_by_link;
use crate::kinematics::{base_twist, joint_transforms};
use crate::linalg::{Square, Vec3, add_transpose};
use crate::model::Error;
use crate::model::Model;
use crate::quantities::{Call, DTHETA, Declaration, Kernel, MATRIX, Quantity, THETA, output, symmetric};
use crate::scalar::{Scalar, pass};
use crate::spatial::{AxisRate, CoriolisFactor, Twist, Wrench, Wrenches};
use crate::workspace::{ByRates, Composite, Recursion, Workspace};
use nalgebra::DMatrix;

/// C(θ, θ̇) of the Christoffel symbols, n × n, row-major into `C`: Cθ̇ = c and Ṁ − 2C skew-symmetric; base at rest.
///
/// > C = Σ_k J_kᵀ (𝒢_k J̇_k + ½ (𝒢`[ad_𝒱]` − `[ad_𝒱]`ᵀ𝒢 + H(𝒢𝒱)) J_k), H(m, f) = `[[−[m], −[f]], [−[f], 0]]`
///
/// With J̇_k = Ad `[ad_𝒱_i]` A_i − `[ad_𝒱_k]` Ad A_i, the factor of Ad A_i is ½ (𝒢̇ + H(𝒢𝒱)): the rate of the inertia
/// and its momentum, which add up over composite bodies. (The factor of θ̇ in the book's c gives Cθ̇ = c too, but Ṁ −
/// 2C is not skew for it.) A floating base's velocities are not rates of coordinates and have no Christoffel symbols;
/// the same formula gives a C with the same two properties for it.
///
/// Cost O(n · depth), no allocation.
///
/// # Panics
/// When θ is not nq long, θ̇ not n, or `C` not n².
#[cfg_attr(not(debug_assertions), inline(always))]
#[rustfmt::skip]
pub fn coriolis_matrix<S: Scalar + From<C0>, C0: Scalar>(
    model: &Model<C0>, theta: &[S], dtheta: &[S], workspace: &mut Workspace<S>, C: &mut [S],
) {
    with_base_twist(model, theta, dtheta, base_twist(model, theta, dtheta, Twist::zero()), workspace, C);
}

pass! {
/// C for a given twist of the base.
fn with_base_twist<S: Scalar + From<C0>, C0: Scalar>(
    model: &Model<C0>, theta: &[S], dtheta: &[S], base_twist: Twist<S>, workspace: &mut Workspace<S>, C: &mut [S],
) {
    model.assert_lengths(theta.len(), [dtheta.len()]);
    joint_transforms(model, theta, workspace);
    let slots = model.links.len() + 1;
    let Workspace { recursion: Recursion { T, V, .. }, composite: Composite { by_rates, G: G_c, B, .. }, .. } = workspace;
    let (T, V, by_rates) = (&T[..slots], &mut V[..slots], &mut by_rates[..slots]);
    let (G_c, B, half) = (&mut G_c[..slots], &mut B[..slots], S::from_f64(0.5));
    V[0] = base_twist;
    let G = model.base_inertia.map(S::from);
    (G_c[0], B[0]) = (G, CoriolisFactor::new(G, V[0], G * V[0]));
    for (i, link) in model.outward::<S>() {
        V[i] = T[i].Ad() * V[link.parent] + link.A() * dtheta[link.j]; // (8.51)
        let (A, G) = (link.A(), link.G());
        let moved = if link.has_one_axis() { (V[i].ad() * A).rate() } else { AxisRate::zero() };
        by_rates[i] = ByRates { r: moved, s: A.a * half };
        if !link.has_one_axis() && link.is_last {
            add_moved_by_link(model, i, T, V[i], by_rates);
        }
        (G_c[i], B[i]) = (G, CoriolisFactor::new(G, V[i], G * V[i]));
    }
    add_up_bodies::<false, S, C0>(model, workspace);
    fill(model, BaseRates { X: base_twist, Y: None, sigma: half }, workspace, C);
    add_coriolis_blocks(model, dtheta, C);
}
}

/// C_ij = A_iᵀ (𝒢ᶜ r_j + 𝓑ᶜ s_j), the bodies those of the outer one of i and j.
#[cfg_attr(not(debug_assertions), inline(always))]
#[rustfmt::skip]
fn fill<S: Scalar + From<C0>, C0: Scalar>(model: &Model<C0>, base: BaseRates<S>, workspace: &Workspace<S>, C: &mut [S]) {
    let slots = model.links.len() + 1;
    let (T, pairs) = (&workspace.recursion.T[..slots], &workspace.composite.by_rates[..slots]);
    let (G, B, mut C) = (&workspace.composite.G[..slots], &workspace.composite.B[..slots], Square::zero(model.n(), C));
    for (j, joint) in model.outward::<S>() {
        let (A, f) = (joint.A(), Vec3::zero());
        let (column, row, m) = (pairs[j].column(G[j], B[j]), G[j] * A, B[j].transpose_mul(A));
        C[(joint.j, joint.j)] += A * column;
        let mut load = Wrenches::new([column, row, Wrench { m, f }]);
        for (link, i, below) in model.steps_to_base::<S>(j) {
            load = load.carried(&T[link]);
            let [column, row, Wrench { m, .. }] = load.parts();
            match below {
                Some(below) => C.add_pair(below.j, joint.j, [below.A() * column, pairs[i].dot(row, m)]),
                None => C.add_sixes(joint.j, column.to_array(), base.dot(row, m).to_array()),
            }
        }
    }
    if model.is_floating() {
        for (k, e) in Twist::axes().into_iter().enumerate() {
            C.set_six(k, base.column(e, G[0], B[0]).to_array());
        }
    }
}

/// Ṁ = C + Cᵀ, n × n, row-major into `dM`; base at rest. M does not depend on the pose of a floating base, so its twist
/// is left out: its contribution to C + Cᵀ would cancel, up to rounding.
///
/// Cost O(n · depth), no allocation.
///
/// # Panics
/// When θ is not nq long, θ̇ not n, or `dM` not n².
#[cfg_attr(not(debug_assertions), inline(always))]
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

/// See [`coriolis_matrix`]. The kernel computes Ṁ instead if that output is kept.
#[derive(Clone, Copy, Debug)]
pub struct CoriolisMatrix;
#[doc(hidden)]
impl Quantity for CoriolisMatrix {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "coriolis_matrix",
        "C(θ, θ̇) of the Christoffel symbols: c = Cθ̇, and Ṁ − 2C is skew-symmetric",
        &[THETA, DTHETA],
        &[output("C", MATRIX, "N m s, N s or N s/m")],
    );
}
#[doc(hidden)]
impl Kernel for CoriolisMatrix {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, ..], [C, dM, ..], w) = (c.inputs, c.outputs, &mut c.memory.workspace);
        // one call for both, so that it is compiled once
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
#[doc(hidden)]
impl Quantity for MassMatrixRate {
    type Kernel = CoriolisMatrix;
    const DECLARATION: Declaration = Declaration::new(
        "mass_matrix_rate",
        "Ṁ(θ, θ̇) = C + Cᵀ",
        &[THETA, DTHETA],
        &[symmetric("dM", MATRIX, "kg m²/s, kg m/s or kg/s")],
    )
    .with_first_output(1);
}

impl Model<f64> {
    /// Ṁ(θ, θ̇): see [`mass_matrix_rate`](mass_matrix_rate()).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn mass_matrix_rate(&self, theta: &[f64], dtheta: &[f64]) -> Result<DMatrix<f64>, Error> {
        self.matrix(MassMatrixRate, &[theta, dtheta], &self.environment())
    }

    /// C(θ, θ̇) of the Christoffel symbols: see [`coriolis_matrix`](coriolis_matrix()).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn coriolis_matrix(&self, theta: &[f64], dtheta: &[f64]) -> Result<DMatrix<f64>, Error> {
        self.matrix(CoriolisMatrix, &[theta, dtheta], &self.environment())
    }
}
