//! A(θ), Ȧθ̇ and the residual φ(θ) of the constraints (Modern Robotics, section 8.7).

use super::relative_motion::{RelativeMotion, relative_motion, z_of};
use crate::kinematics::joint_transforms;
use crate::linalg::Vec3;
use crate::model::description::Closure;
use crate::model::{Model, Own, TieKind, Workspace};
use crate::quantity::{Call, DTHETA, Declaration, Dim, Kernel, Quantity, THETA, output};
use crate::scalar::Scalar;
use crate::spatial::{Twist, Wrench};

/// A(θ), m × n by rows, Ȧ(θ, θ̇)θ̇ and φ(θ), m each: A θ̇ = 0 and Aθ̈ + Ȧθ̇ = 0 are the constraints on velocities and
/// accelerations, φ = 0 those on positions. Rows are those of [`Closure`] in the axes of anchor {a}; rad and m.
///
/// φ is the position of the origin of {b} in {a}, and before it 2 sin(α/2) times the axis of the rotation by α from {a}
/// to {b}; for a hinge −z_y and z_x of the z-axis of {b}; for a distance d (pᵀp − d²)/2d; for a wheel the height of its
/// lowest point, after two zeros; for a joint θ_j − Σ c_k θ_iᵏ. Where A is not the derivative of φ (angles), it is for
/// φ = 0.
///
/// Outputs that are empty are not computed. Cost O(Σ depth of the anchors), no allocation.
///
/// # Panics
/// When θ is not nq long, θ̇ not n, or an output has another length than its own and 0.
#[cfg_attr(not(test), inline(always))]
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

/// The same; the workspace holds T_{i,i−1}(θ).
#[cfg_attr(not(test), inline(always))]
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
    for tie in &model.ties.list {
        let first = tie.first;
        let mut set = |row: usize, bias: S, residual: S| {
            if let Some(x) = dA_dtheta.get_mut(first + row) {
                *x = bias;
            }
            if let Some(x) = phi.get_mut(first + row) {
                *x = residual;
            }
        };
        match &tie.kind {
            TieKind::Joint { joint, source, polynomial } => {
                let value = |own: &Own<C>| S::from(own.ratio).mul_add(theta[own.q], S::from(own.offset));
                let [c0, c1, c2, c3, c4] = polynomial.map(S::from);
                let (x, dx) = source
                    .as_ref()
                    .map_or((S::zero(), S::zero()), |own| (value(own), S::from(own.ratio) * dtheta[own.j]));
                let (two, three, four) = (S::from_f64(2.0), S::from_f64(3.0), S::from_f64(4.0));
                let (six, twelve) = (S::from_f64(6.0), S::from_f64(12.0));
                let f = x.mul_add(x.mul_add(x.mul_add(x.mul_add(c4, c3), c2), c1), c0);
                let df = x.mul_add(x.mul_add(x.mul_add(four * c4, three * c3), two * c2), c1);
                let ddf = x.mul_add(x.mul_add(twelve * c4, six * c3), two * c2);
                if !A.is_empty() {
                    let row = &mut A[first * n..][..n];
                    row[joint.j] += S::from(joint.ratio);
                    if let Some(own) = source {
                        row[own.j] -= df * S::from(own.ratio);
                    }
                }
                set(0, -(ddf * dx * dx), value(joint) - f);
            }
            TieKind::Frames { a, b, closure: Closure::Point } => {
                let motion = relative_motion(model, theta, dtheta, [a, b], workspace, |j, J| {
                    add_to_rows(A, n, first, j, J.v.0);
                });
                for k in 0..3 {
                    set(k, motion.bias.v.0[k], motion.T.p.0[k]);
                }
            }
            TieKind::Frames { a, b, closure: Closure::Weld } => {
                let motion = relative_motion(model, theta, dtheta, [a, b], workspace, |j, J| {
                    add_to_rows(A, n, first, j, J.to_array());
                });
                let (bias, residual) =
                    (motion.bias.to_array(), Twist { w: rotation(&motion), v: motion.T.p }.to_array());
                for k in 0..6 {
                    set(k, bias[k], residual[k]);
                }
            }
            TieKind::Frames { a, b, closure: Closure::Hinge } => {
                let motion = relative_motion(model, theta, dtheta, [a, b], workspace, |j, J| {
                    let [wx, wy, _, vx, vy, vz] = J.to_array();
                    add_to_rows(A, n, first, j, [wx, wy, vx, vy, vz]);
                });
                let [wx, wy, _, vx, vy, vz] = motion.bias.to_array();
                let (bias, z, p) = ([wx, wy, vx, vy, vz], z_of(motion.T).0, motion.T.p.0);
                let residual = [-z[1], z[0], p[0], p[1], p[2]];
                for k in 0..5 {
                    set(k, bias[k], residual[k]);
                }
            }
            TieKind::Frames { a, b, closure: Closure::Distance(length) } => {
                // the wrench's direction needs T_ab, which the first call finds
                let one_over = S::one() / S::from(*length);
                let RelativeMotion { T, V, bias } = relative_motion(model, theta, dtheta, [a, b], workspace, |_, _| {});
                let along = T.p * one_over;
                if !A.is_empty() {
                    relative_motion(model, theta, dtheta, [a, b], workspace, |j, J| {
                        add_to_rows(A, n, first, j, [along.dot(J.v)]);
                    });
                }
                let half = S::from_f64(0.5);
                set(0, V.v.dot(V.v) * one_over + along.dot(bias.v), (T.p.dot(along) - S::from(*length)) * half);
            }
            TieKind::Frames { a, b, closure: Closure::Rolling(radius) } => {
                let radius = S::from(*radius);
                let motion = relative_motion(model, theta, dtheta, [a, b], workspace, |_, _| {});
                let wheel = Wheel::new(&motion);
                let arm = wheel.up * -radius; // from the centre to the lowest point
                if !A.is_empty() {
                    relative_motion(model, theta, dtheta, [a, b], workspace, |j, J| {
                        add_to_rows(A, n, first, j, (J.v + J.w.cross(arm)).0);
                    });
                }
                let rate = wheel.rate(&motion) * -radius;
                let bias = motion.bias.v + motion.bias.w.cross(arm) + motion.V.w.cross(rate);
                let height = motion.T.p.0[2] - radius * wheel.size;
                let residual = [S::zero(), S::zero(), height];
                for k in 0..3 {
                    set(k, bias.0[k], residual[k]);
                }
            }
        }
    }
}

/// Adds a column's part to rows.
#[inline(always)]
fn add_to_rows<S: Scalar, const K: usize>(A: &mut [S], n: usize, first: usize, j: usize, column: [S; K]) {
    if A.is_empty() {
        return;
    }
    for (k, x) in column.into_iter().enumerate() {
        A[(first + k) * n + j] += x;
    }
}

/// 2 sin(α/2) times the axis of the rotation by α from {a} to {b}.
#[inline(always)]
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
    fn new(motion: &RelativeMotion<S>) -> Self {
        let axis = z_of(motion.T);
        let w = Self::normal() - axis * axis.0[2];
        let size = w.norm();
        Wheel { axis, up: w * (S::one() / size), size }
    }

    fn normal() -> Vec3<S> {
        Vec3([S::zero(), S::zero(), S::one()])
    }

    /// d(up)/dt.
    fn rate(&self, motion: &RelativeMotion<S>) -> Vec3<S> {
        let turning = motion.V.w.cross(self.axis);
        let dw = -(self.axis * turning.0[2] + turning * self.axis.0[2]);
        (dw - self.up * self.up.dot(dw)) * (S::one() / self.size)
    }
}

/// The wrench that the constraint's multipliers stand for: in the axes of {a}, about the origin of {b}.
pub(crate) fn wrench_of(closure: Closure, T_ab: crate::SE3, lambda: &[f64]) -> Wrench {
    let vector = |k: usize| Vec3([lambda[k], lambda[k + 1], lambda[k + 2]]);
    match closure {
        Closure::Point => Wrench { m: Vec3::zero(), f: vector(0) },
        Closure::Weld => Wrench { m: vector(0), f: vector(3) },
        Closure::Hinge => Wrench { m: Vec3([lambda[0], lambda[1], 0.0]), f: vector(2) },
        Closure::Distance(length) => Wrench { m: Vec3::zero(), f: T_ab.p * (lambda[0] / length) },
        Closure::Rolling(radius) => {
            let motion = RelativeMotion { T: T_ab, V: Twist::zero(), bias: Twist::zero() };
            let arm = Wheel::new(&motion).up * -radius;
            Wrench { m: arm.cross(vector(0)), f: vector(0) }
        }
    }
}

const ROWS: &[Dim] = &[Dim::Constraints];

/// See [`constraint_jacobian`].
#[derive(Clone, Copy, Debug)]
pub struct ConstraintJacobian;
impl Quantity for ConstraintJacobian {
    type Kernel = Self;
    type Registers = Self;
    const DECLARATION: Declaration = Declaration::new(
        "constraint_jacobian",
        "A(θ) of the constraints A(θ)θ̇ = 0",
        &[THETA],
        &[output("A", &[Dim::Constraints, Dim::N], "1 or m")],
    )
    .at_rest();
}
impl Kernel for ConstraintJacobian {
    #[inline(always)]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, _], [A, dA_dtheta, phi, _]) = (c.inputs, c.outputs);
        constraint_jacobian(c.model, theta, dtheta, &mut c.memory.workspace, A, dA_dtheta, phi);
    }
}

/// See [`constraint_jacobian`].
#[derive(Clone, Copy, Debug)]
pub struct ConstraintBias;
impl Quantity for ConstraintBias {
    type Kernel = ConstraintJacobian;
    type Registers = ConstraintJacobian;
    const DECLARATION: Declaration = Declaration::new(
        "constraint_bias",
        "Ȧ(θ, θ̇)θ̇ of the constraints: Aθ̈ + Ȧθ̇ = 0",
        &[THETA, DTHETA],
        &[output("dA_dtheta", ROWS, "rad/s² or m/s²")],
    )
    .with_first_output(1);
}

/// See [`constraint_jacobian`].
#[derive(Clone, Copy, Debug)]
pub struct ConstraintResidual;
impl Quantity for ConstraintResidual {
    type Kernel = ConstraintJacobian;
    type Registers = ConstraintJacobian;
    const DECLARATION: Declaration = Declaration::new(
        "constraint_residual",
        "φ(θ), by how much the positions violate the constraints",
        &[THETA],
        &[output("phi", ROWS, "rad or m")],
    )
    .at_rest()
    .with_first_output(2);
}
