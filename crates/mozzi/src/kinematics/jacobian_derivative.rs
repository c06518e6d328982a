//! ∂J_i/∂θ_j of both Jacobians (Modern Robotics, exercise 8.6).

use super::base_pose;
use crate::lie::SE3;
use crate::model::{FrameId, Model};
use crate::quantities::{Call, Declaration, JACOBIANS, Kernel, Of, Quantity, THETA, by_rows, output, sized};
use crate::scalar::{Scalar, pass};
use crate::spatial::Twist;
use crate::workspace::Workspace;

/// ∂J_i/∂θ_j of the body Jacobian, at `H[i * n + j]`: `[ad_{J_i}]` J_j if joint j is between joint i and the frame,
/// else 0. For a floating base the six derivatives are along its twist in its own coordinates.
///
/// Cost O(n² + depth²), no allocation.
///
/// # Panics
/// When θ is not nq long, or `H` not n².
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn body_jacobian_derivative<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    frame: FrameId,
    workspace: &mut Workspace<S>,
    H: &mut [Twist<S>],
) {
    brackets(model, theta, frame, workspace, H, |outer, inner, bracket, is_one_joint, H, n| {
        if !is_one_joint {
            H[inner * n + outer] += bracket;
        }
    });
}

/// ∂J_i/∂θ_j of the space Jacobian, at `H[i * n + j]`: `[ad_{J_j}]` J_i if joint j is between the base and joint i,
/// else 0. For a floating base the six derivatives are along its twist in its own coordinates.
///
/// Cost O(n² + depth²), no allocation.
///
/// # Panics
/// When θ is not nq long, or `H` not n².
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn space_jacobian_derivative<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    frame: FrameId,
    workspace: &mut Workspace<S>,
    H: &mut [Twist<S>],
) {
    let T_sb = brackets(model, theta, frame, workspace, H, |outer, inner, bracket, is_one_joint, H, n| {
        H[outer * n + inner] += bracket;
        if is_one_joint {
            H[inner * n + outer] += -bracket;
        }
    });
    for entry in H.iter_mut() {
        *entry = T_sb.Ad() * *entry;
    }
    if model.is_floating() {
        // a floating base's own columns rotate and translate with it
        let (n, Ad) = (model.n(), base_pose(model, theta).Ad());
        for (j, along) in Twist::axes().into_iter().enumerate() {
            for (i, axis) in Twist::axes().into_iter().enumerate() {
                H[i * n + j] = Ad * (along.ad() * axis);
            }
        }
    }
}

pass! {
/// Calls `add` with `[ad_{J_inner}]` J_outer, in {b} coordinates, for every pair of axes on the frame's path, and with
/// whether both are axes of one ball or free joint, which all move with the link that they carry; returns `T_sb`.
fn brackets<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    frame: FrameId,
    workspace: &mut Workspace<S>,
    H: &mut [Twist<S>],
    add: impl Fn(usize, usize, Twist<S>, bool, &mut [Twist<S>], usize),
) -> SE3<S> {
    let n = model.n();
    model.assert_lengths(theta.len(), []);
    assert!(H.len() == n * n, "H has {} entries, expected n² = {}", H.len(), n * n);
    H.fill(Twist::zero());
    let frame = model.frame_at::<S>(frame);
    let J = &mut workspace.recursion.V;
    let mut T = frame.T.inverse(); // T_{b,i}
    for (i, inner) in model.to_base::<S>(frame.slot) {
        J[i] = T.Ad() * inner.A().twist();
        for (k, outer) in model.to_base::<S>(frame.slot).take_while(|&(k, _)| k != i) {
            add(outer.j, inner.j, J[i].ad() * J[k], model.is_one_joint(i, k), H, n);
        }
        T = T * inner.transform(theta);
    }
    if model.is_floating() {
        for (j, axis) in Twist::axes().into_iter().enumerate() {
            let J_j = T.Ad() * axis;
            for (k, outer) in model.to_base::<S>(frame.slot) {
                add(outer.j, j, J_j.ad() * J[k], false, H, n);
            }
        }
    }
    base_pose(model, theta) * T.inverse()
}
}

/// See [`space_jacobian_derivative`].
#[derive(Clone, Copy, Debug)]
pub struct SpaceJacobianDerivative;
impl Quantity for SpaceJacobianDerivative {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "space_jacobian_derivative",
        "∂J_s/∂θ_j of a frame for each velocity j",
        &[THETA],
        &[output("H", JACOBIANS, "1 or m, each per unit of θ_j")],
    )
    .of(Of::Frame);
}
impl Kernel for SpaceJacobianDerivative {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, ..], [H, ..], n) = (c.inputs, c.outputs, c.model.n());
        let columns = sized(&mut c.memory.twists, n * n, Twist::zero());
        space_jacobian_derivative(c.model, theta, c.of.frame(), &mut c.memory.workspace, columns);
        by_velocity(columns, n, H);
    }
}

/// See [`body_jacobian_derivative`].
#[derive(Clone, Copy, Debug)]
pub struct BodyJacobianDerivative;
impl Quantity for BodyJacobianDerivative {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "body_jacobian_derivative",
        "∂J_b/∂θ_j of a frame for each velocity j",
        &[THETA],
        &[output("H", JACOBIANS, "1 or m, each per unit of θ_j")],
    )
    .of(Of::Frame);
}
impl Kernel for BodyJacobianDerivative {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, ..], [H, ..], n) = (c.inputs, c.outputs, c.model.n());
        let columns = sized(&mut c.memory.twists, n * n, Twist::zero());
        body_jacobian_derivative(c.model, theta, c.of.frame(), &mut c.memory.workspace, columns);
        by_velocity(columns, n, H);
    }
}

/// From H[i n + j] = ∂J_i/∂θ_j to one 6 × n matrix for each j.
#[cfg_attr(not(debug_assertions), inline(always))]
fn by_velocity<S: Scalar>(columns: &[Twist<S>], n: usize, H: &mut [S]) {
    for (j, matrix) in H.chunks_exact_mut((6 * n).max(1)).enumerate() {
        by_rows((0..n).map(|i| columns[i * n + j].to_array()), matrix);
    }
}
