//! A(θ), Ȧθ̇ and the residual φ(θ) of the constraints (Modern Robotics, section 8.7).

use super::relative_motion::{RelativeMotion, relative_motion, z_of};
use crate::kinematics::{base_pose, joint_transforms};
use crate::lie::SE3;
use crate::linalg::Vec3;
use crate::model::description::Closure;
use crate::model::{End, Model, Own, TieKind, Way};
use crate::quantities::{Call, DTHETA, Declaration, Dim, Kernel, Quantity, THETA, output};
use crate::scalar::{Scalar, pass};
use crate::spatial::{Twist, Wrench};
use crate::workspace::Workspace;

/// A(θ), m × n by rows, Ȧ(θ, θ̇)θ̇ and φ(θ), m each: A θ̇ = 0 and Aθ̈ + Ȧθ̇ = 0 are the constraints on velocities and
/// accelerations, φ = 0 those on positions. Rows are those of [`Closure`] in the axes of anchor {a}; rad and m.
///
/// φ is the position of the origin of {b} in {a}, preceded by 2 sin(α/2) times the axis of the rotation by α from {a}
/// to {b}; for a hinge −z_y and z_x of the z-axis of {b}; for a distance d (pᵀp − d²)/2d; for a wheel the height of its
/// lowest point, after two zeros; for joints Σ r_j θ_j − Σ c_k (Σ r_i θ_i)ᵏ. If A is not the derivative of φ (angles),
/// it is the derivative at φ = 0.
///
/// Empty outputs are not computed. Cost O(Σ depth of the anchors), no allocation.
///
/// # Panics
/// When θ is not nq long, θ̇ not n, or an output has another length than its own and 0.
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn constraint_jacobian<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    workspace: &mut Workspace<S>,
    A: &mut [S],
    dA_dtheta: &mut [S],
    phi: &mut [S],
) {
    joint_transforms(model, theta, workspace);
    rows(model, theta, dtheta, workspace, A, dA_dtheta, phi);
}

pass! {
/// As [`constraint_jacobian`]; requires T_{i,i−1}(θ) in the workspace.
pub(super) fn rows<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    workspace: &mut Workspace<S>,
    A: &mut [S],
    dA_dtheta: &mut [S],
    phi: &mut [S],
) {
    model.assert_lengths(theta.len(), [dtheta.len()]);
    let (m, n) = (model.ties.rows, model.n());
    for (what, found, expected) in [("A", A.len(), m * n), ("dA_dtheta", dA_dtheta.len(), m), ("phi", phi.len(), m)] {
        assert!(found == expected || found == 0, "{what} has {found} entries, expected {expected}");
    }
    A.fill(S::zero());
    let base = base_pose(model, theta);
    for tie in &model.ties.list {
        let rows = tie.first..tie.first + tie.kind.rows();
        let A = if A.is_empty() { &mut [][..] } else { &mut A[rows.start * n..rows.end * n] };
        let dA_dtheta = dA_dtheta.get_mut(rows.clone()).unwrap_or_default();
        let phi = phi.get_mut(rows).unwrap_or_default();
        match &tie.kind {
            TieKind::Joint { joints, source, polynomial } => {
                joint_row(theta, dtheta, (joints, source, polynomial), A, dA_dtheta, phi);
            }
            TieKind::Frames { a, b, closure } => {
                frame_rows(model, base, dtheta, ([a, b], closure), workspace, A, dA_dtheta, phi);
            }
        }
    }
}
}

/// The row of y − f(x) = 0, with y = Σ r_j θ_j, x = Σ r_i θ_i, f(x) = Σ c_k xᵏ.
#[cfg_attr(not(debug_assertions), inline(always))]
fn joint_row<S: Scalar + From<C>, C: Scalar>(
    theta: &[S],
    dtheta: &[S],
    (joints, source, polynomial): (&[Own<C>], &[Own<C>], &[C; 5]),
    A: &mut [S],
    dA_dtheta: &mut [S],
    phi: &mut [S],
) {
    let [c0, c1, c2, c3, c4] = polynomial.map(S::from);
    let (mut x, mut dx, mut y) = (S::zero(), S::zero(), S::zero());
    for own in source {
        x += own.position(theta);
        dx = S::from(own.ratio).mul_add(dtheta[own.j], dx);
    }
    for own in joints {
        y += own.position(theta);
    }
    let (two, three, four) = (S::from_f64(2.0), S::from_f64(3.0), S::from_f64(4.0));
    let (six, twelve) = (S::from_f64(6.0), S::from_f64(12.0));
    let f = x.mul_add(x.mul_add(x.mul_add(x.mul_add(c4, c3), c2), c1), c0);
    let df = x.mul_add(x.mul_add(x.mul_add(four * c4, three * c3), two * c2), c1);
    let ddf = x.mul_add(x.mul_add(twelve * c4, six * c3), two * c2);
    if !A.is_empty() {
        for own in joints {
            A[own.j] += S::from(own.ratio);
        }
        for own in source {
            A[own.j] -= df * S::from(own.ratio);
        }
    }
    set(dA_dtheta, [-(ddf * dx * dx)]);
    set(phi, [y - f]);
}

/// The rows between two anchors.
#[cfg_attr(not(debug_assertions), inline(always))]
#[allow(clippy::too_many_arguments)] // a state, a constraint, and its rows
fn frame_rows<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    base: SE3<S>,
    dtheta: &[S],
    (ends, closure): ([&End<C>; 2], &Closure<C>),
    workspace: &mut Workspace<S>,
    A: &mut [S],
    dA_dtheta: &mut [S],
    phi: &mut [S],
) {
    let motion = relative_motion(model, base, dtheta, ends, workspace);
    let RelativeMotion { T, V, bias, .. } = &motion;
    let mut direction = Vec3::zero(); // the rows of distances and wheels depend on it
    match closure {
        Closure::Point => {
            set(dA_dtheta, bias.v.0);
            set(phi, T.p.0);
        }
        Closure::Weld => {
            set(dA_dtheta, bias.to_array());
            set(phi, Twist { w: rotation(&motion), v: T.p }.to_array());
        }
        Closure::Hinge => {
            let (z, p) = (z_of(*T).0, T.p.0);
            set(dA_dtheta, without_wz(*bias));
            set(phi, [-z[1], z[0], p[0], p[1], p[2]]);
        }
        Closure::Distance(length) => {
            let (length, half) = (S::from(*length), S::from_f64(0.5));
            let one_over = S::one() / length;
            direction = T.p * one_over;
            set(dA_dtheta, [V.v.dot(V.v) * one_over + direction.dot(bias.v)]);
            set(phi, [(T.p.dot(direction) - length) * half]);
        }
        Closure::Rolling(radius) => {
            let radius = S::from(*radius);
            let wheel = Wheel::new(*T);
            direction = wheel.up * -radius; // from the centre to the lowest point
            let rate = wheel.rate(V.w) * -radius;
            set(dA_dtheta, (bias.v + bias.w.cross(direction) + V.w.cross(rate)).0);
            set(phi, [S::zero(), S::zero(), T.p.0[2] - radius * wheel.size]);
        }
    }
    if A.is_empty() {
        return;
    }
    let n = model.n();
    for (_, slot) in Way::new(&model.links, ends.map(|end| end.slot)) {
        add_column(closure, direction, workspace.recursion.V[slot], &mut A[model.links[slot - 1].j..], n);
    }
    if let Some(six) = motion.by_base {
        for (j, J) in six.into_iter().enumerate() {
            add_column(closure, direction, J, &mut A[j..], n);
        }
    }
}

/// Adds what a velocity with these ω and ṗ contributes to the rows: `A` begins at its column.
#[cfg_attr(not(debug_assertions), inline(always))]
fn add_column<S: Scalar, C>(closure: &Closure<C>, direction: Vec3<S>, J: Twist<S>, A: &mut [S], n: usize) {
    match closure {
        Closure::Point => add(A, n, J.v.0),
        Closure::Weld => add(A, n, J.to_array()),
        Closure::Hinge => add(A, n, without_wz(J)),
        Closure::Distance(_) => add(A, n, [direction.dot(J.v)]),
        Closure::Rolling(_) => add(A, n, (J.v + J.w.cross(direction)).0),
    }
}

#[cfg_attr(not(debug_assertions), inline(always))]
fn add<S: Scalar, const K: usize>(A: &mut [S], n: usize, column: [S; K]) {
    for k in 0..K {
        A[k * n] += column[k];
    }
}

/// Rows of an output that may be empty.
#[cfg_attr(not(debug_assertions), inline(always))]
fn set<S: Scalar, const K: usize>(rows: &mut [S], values: [S; K]) {
    if !rows.is_empty() {
        rows.copy_from_slice(&values);
    }
}

/// The components of a twist that a hinge about z constrains.
#[cfg_attr(not(debug_assertions), inline(always))]
fn without_wz<S: Scalar>(V: Twist<S>) -> [S; 5] {
    let [wx, wy, _, vx, vy, vz] = V.to_array();
    [wx, wy, vx, vy, vz]
}

/// 2 sin(α/2) times the axis of the rotation by α from {a} to {b}.
#[cfg_attr(not(debug_assertions), inline(always))]
fn rotation<S: Scalar>(motion: &RelativeMotion<S>) -> Vec3<S> {
    let R = motion.T.R.matrix();
    let half = S::from_f64(0.5);
    let vee = Vec3([R.z.0[1] - R.y.0[2], R.x.0[2] - R.z.0[0], R.y.0[0] - R.x.0[1]]) * half; // sin α times the axis
    let one_plus_cos = (R.trace() + S::one()) * half;
    vee * (S::from_f64(2.0) / one_plus_cos).sqrt()
}

/// A wheel on a plane, in the plane's axes.
struct Wheel<S> {
    /// Its axis.
    axis: Vec3<S>,
    /// The unit vector from its lowest point to its centre, the steepest one in its plane.
    up: Vec3<S>,
    /// The sine of the angle between its axis and the plane's normal.
    size: S,
}

impl<S: Scalar> Wheel<S> {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn new(T_ab: SE3<S>) -> Self {
        let axis = z_of(T_ab);
        let normal = Vec3([S::zero(), S::zero(), S::one()]);
        let w = normal - axis * axis.0[2];
        let size = w.norm();
        Wheel { axis, up: w * (S::one() / size), size }
    }

    /// d(up)/dt of a wheel that turns with ω.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn rate(&self, w: Vec3<S>) -> Vec3<S> {
        let turning = w.cross(self.axis);
        let dw = -(self.axis * turning.0[2] + turning * self.axis.0[2]);
        (dw - self.up * self.up.dot(dw)) * (S::one() / self.size)
    }
}

/// The wrench of the constraint's multipliers: in the axes of {a}, about the origin of {b}.
pub(crate) fn wrench_of(closure: Closure, T_ab: SE3, lambda: &[f64]) -> Wrench {
    let vector = |k: usize| Vec3([lambda[k], lambda[k + 1], lambda[k + 2]]);
    match closure {
        Closure::Point => Wrench { m: Vec3::zero(), f: vector(0) },
        Closure::Weld => Wrench { m: vector(0), f: vector(3) },
        Closure::Hinge => Wrench { m: Vec3([lambda[0], lambda[1], 0.0]), f: vector(2) },
        Closure::Distance(length) => Wrench { m: Vec3::zero(), f: T_ab.p * (lambda[0] / length) },
        Closure::Rolling(radius) => {
            let arm = Wheel::new(T_ab).up * -radius;
            Wrench { m: arm.cross(vector(0)), f: vector(0) }
        }
    }
}

const ROWS: &[Dim] = &[Dim::Constraints];

/// See [`constraint_jacobian`].
#[derive(Clone, Copy, Debug)]
pub struct ConstraintJacobian;
#[doc(hidden)]
impl Quantity for ConstraintJacobian {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "constraint_jacobian",
        "A(θ) of the constraints A(θ)θ̇ = 0",
        &[THETA],
        &[output("A", &[Dim::Constraints, Dim::N], "1 or m")],
    )
    .is_constrained()
    .at_rest();
}
#[doc(hidden)]
impl Kernel for ConstraintJacobian {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, ..], [A, dA_dtheta, phi, _]) = (c.inputs, c.outputs);
        constraint_jacobian(c.model, theta, dtheta, &mut c.memory.workspace, A, dA_dtheta, phi);
    }
}

/// See [`constraint_jacobian`].
#[derive(Clone, Copy, Debug)]
pub struct ConstraintBias;
#[doc(hidden)]
impl Quantity for ConstraintBias {
    type Kernel = ConstraintJacobian;
    const DECLARATION: Declaration = Declaration::new(
        "constraint_bias",
        "Ȧ(θ, θ̇)θ̇ of the constraints: Aθ̈ + Ȧθ̇ = 0",
        &[THETA, DTHETA],
        &[output("dA_dtheta", ROWS, "rad/s² or m/s²")],
    )
    .is_constrained()
    .with_first_output(1);
}

/// See [`constraint_jacobian`].
#[derive(Clone, Copy, Debug)]
pub struct ConstraintResidual;
#[doc(hidden)]
impl Quantity for ConstraintResidual {
    type Kernel = ConstraintJacobian;
    const DECLARATION: Declaration = Declaration::new(
        "constraint_residual",
        "φ(θ), by how much the positions violate the constraints",
        &[THETA],
        &[output("phi", ROWS, "rad or m")],
    )
    .is_constrained()
    .at_rest()
    .with_first_output(2);
}
