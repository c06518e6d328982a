//! Momentum of the moving links and a floating base: its matrix by composite rigid bodies, its rate by Newton-Euler
//! (Orin, Goswami and Lee 2013).

use super::inverse_dynamics::newton_euler;
use crate::kinematics::{base_pose, joint_transforms, link_twists};
use crate::lie::SE3;
use crate::linalg::Vec3;
use crate::model::Error;
use crate::model::{Environment, Model};
use crate::quantities::Query;
use crate::quantities::{Call, DDTHETA, DTHETA, Declaration, Kernel, Of, Quantity, SIX, THETA, output};
use crate::scalar::{Scalar, pass};
use crate::spatial::{SpatialInertia, Twist, Wrench};
use crate::workspace::{Composite, Recursion, Workspace};

/// The spatial inertia of the moving links and a floating base together, about the origin of {s} in its coordinates:
/// its `mass`, and its `mc`, the mass times the centre of mass.
///
/// Cost O(n), no allocation.
///
/// # Panics
/// When θ is not nq long.
#[cfg_attr(not(debug_assertions), inline(always))]
#[rustfmt::skip]
pub fn total_inertia<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, theta: &[S], workspace: &mut Workspace<S>) -> SpatialInertia<S> {
    composite_inertia(model, theta, workspace).transformed(base_pose(model, theta))
}

pass! {
/// The momentum of the moving links and a floating base, (angular, linear), about the origin of {s} in its coordinates,
/// {s} at rest:
///
/// > h = Σ `[Ad_T_is]`ᵀ 𝒢_i 𝒱_i
///
/// in kg m²/s and kg m/s. About a point p it is (m − p × f, f): see [`Wrench::about`]. Rotors (armature) are not
/// included.
///
/// Cost O(n), no allocation.
///
/// # Panics
/// When θ is not nq long, or θ̇ not n.
pub fn momentum<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, theta: &[S], dtheta: &[S], workspace: &mut Workspace<S>,
) -> Wrench<S> {
    model.assert_lengths(theta.len(), [dtheta.len()]);
    joint_transforms(model, theta, workspace);
    link_twists(model, theta, dtheta, Twist::zero(), workspace);
    let Workspace { recursion: Recursion { T, V, F: P, .. }, .. } = workspace;
    P[0] = base_inertia(model) * V[0];
    for (i, link) in model.outward::<S>() {
        P[i] = link.G() * V[i];
    }
    for (i, link) in model.inward::<S>() {
        let P_i = T[i].Ad().transpose() * P[i];
        P[link.parent] += P_i;
    }
    seen_from_space(model, theta, P[0])
}
}

/// The n columns of the matrix A with [`momentum`] h = Aθ̇. About the centre of mass it is the centroidal momentum
/// matrix.
///
/// > A_i = `[Ad_T_is]`ᵀ 𝒢ᶜ_i 𝒜_i
///
/// Cost O(n), no allocation.
///
/// # Panics
/// When θ is not nq long, or `A` not n.
#[cfg_attr(not(debug_assertions), inline(always))]
#[rustfmt::skip]
pub fn momentum_matrix<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, theta: &[S], workspace: &mut Workspace<S>, A: &mut [Wrench<S>],
) {
    composite_inertia(model, theta, workspace);
    columns(model, base_pose(model, theta).inverse(), workspace, A);
}

pass! {
/// The columns of the momentum matrix in a frame {s}, seen from the base; requires the composite inertias in the
/// workspace.
pub(super) fn columns<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, T_bs: SE3<S>, workspace: &mut Workspace<S>, A: &mut [Wrench<S>]) {
    assert!(A.len() == model.n(), "A has {} columns, expected n = {}", A.len(), model.n());
    let Workspace { recursion: Recursion { T, .. }, composite: Composite { G: G_c, .. }, .. } = workspace;
    A.fill(Wrench::zero());
    if model.is_floating() {
        for (column, axis) in A.iter_mut().zip(Twist::axes()) {
            *column = T_bs.Ad().transpose() * (G_c[0] * axis);
        }
    }
    T[0] = T_bs;
    for (i, link) in model.outward::<S>() {
        T[i] = T[i] * T[link.parent];                                                     // T_is
        A[link.j] += T[i].Ad().transpose() * (G_c[i] * link.A());
    }
}
}

/// ḣ of the [`momentum`] h along a motion: Aθ̈ + Ȧθ̇, about the origin of {s}. It equals the sum of all external
/// wrenches: gravity, ground contact and others.
///
/// Cost O(n), no allocation.
///
/// # Panics
/// When θ is not nq long, or θ̇ or θ̈ not n.
#[cfg_attr(not(debug_assertions), inline(always))]
#[rustfmt::skip]
pub fn momentum_rate<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, theta: &[S], dtheta: &[S], ddtheta: &[S], workspace: &mut Workspace<S>,
) -> Wrench<S> {
    let rate = rate_in_base(model, theta, dtheta, ddtheta, workspace);
    seen_from_space(model, theta, rate)
}

/// ḣ in the base's coordinates.
#[cfg_attr(not(debug_assertions), inline(always))]
#[rustfmt::skip]
pub(super) fn rate_in_base<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, theta: &[S], dtheta: &[S], ddtheta: &[S], workspace: &mut Workspace<S>,
) -> Wrench<S> {
    let mut tau = core::mem::take(&mut workspace.vector); // its values do not matter
    newton_euler(model, theta, dtheta, ddtheta, &Environment::with_gravity(Vec3::zero()), workspace, &mut tau);
    workspace.vector = tau;
    workspace.recursion.F[0]
}

pass! {
/// 𝒢ᶜ of every slot. Slot 0 is the base: it holds all moving links, and the base's own inertia only if it is floating.
pub(super) fn composite_inertia<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, theta: &[S], workspace: &mut Workspace<S>) -> SpatialInertia<S> {
    model.assert_lengths(theta.len(), []);
    joint_transforms(model, theta, workspace);
    let Workspace { recursion: Recursion { T, .. }, composite: Composite { G: G_c, .. }, .. } = workspace;
    G_c[0] = base_inertia(model);
    for (i, link) in model.outward::<S>() {
        G_c[i] = link.G();
    }
    for (i, link) in model.inward::<S>() {
        let G = G_c[i].congruence(T[i].Ad());
        G_c[link.parent] += G;
    }
    G_c[0]
}
}

/// 𝒢 of a floating base, 0 for a fixed one.
#[cfg_attr(not(debug_assertions), inline(always))]
fn base_inertia<S: Scalar + From<C>, C: Scalar>(model: &Model<C>) -> SpatialInertia<S> {
    if model.is_floating() { model.base_inertia.map(S::from) } else { SpatialInertia::zero() }
}

#[cfg_attr(not(debug_assertions), inline(always))]
fn seen_from_space<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, theta: &[S], P: Wrench<S>) -> Wrench<S> {
    base_pose(model, theta).inverse().Ad().transpose() * P
}

/// See [`momentum`].
#[derive(Clone, Copy, Debug)]
pub struct Momentum;
#[doc(hidden)]
impl Quantity for Momentum {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "momentum",
        "h, the momentum (angular, linear) of all that moves, about a point of {s}, in the axes of {s}",
        &[THETA, DTHETA],
        &[output("h", SIX, "kg m²/s, kg m/s")],
    )
    .of(Of::Point)
    .is_of_masses();
}
#[doc(hidden)]
impl Kernel for Momentum {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, ..], [h, ..], point) = (c.inputs, c.outputs, c.point);
        h.copy_from_slice(&momentum(c.model, theta, dtheta, &mut c.memory.workspace).about(point).to_array());
    }
}

/// See [`momentum_rate`].
#[derive(Clone, Copy, Debug)]
pub struct MomentumRate;
#[doc(hidden)]
impl Quantity for MomentumRate {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "momentum_rate",
        "ḣ of the momentum about a fixed point of {s}, along a motion",
        &[THETA, DTHETA, DDTHETA],
        &[output("dh", SIX, "N m, N")],
    )
    .of(Of::Point)
    .is_of_masses();
}
#[doc(hidden)]
impl Kernel for MomentumRate {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, ddtheta, ..], [dh, ..], point) = (c.inputs, c.outputs, c.point);
        let rate = momentum_rate(c.model, theta, dtheta, ddtheta, &mut c.memory.workspace);
        dh.copy_from_slice(&rate.about(point).to_array());
    }
}

impl Model<f64> {
    /// The momentum of the moving links and a floating base, (angular, linear) in kg m²/s and kg m/s, about a point of
    /// {s}, in {s} coordinates: see [`momentum`](momentum()).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn momentum(&self, theta: &[f64], dtheta: &[f64], about: Vec3) -> Result<Wrench, Error> {
        self.wrench(Query::from(Momentum).about(about), &[theta, dtheta])
    }

    /// ḣ, the rate of the momentum about a fixed point of {s}; with the present centre of mass as the point, the rate
    /// of the centroidal momentum. See [`momentum_rate`](momentum_rate()).
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn momentum_rate(&self, theta: &[f64], dtheta: &[f64], ddtheta: &[f64], about: Vec3) -> Result<Wrench, Error> {
        self.wrench(Query::from(MomentumRate).about(about), &[theta, dtheta, ddtheta])
    }
}
