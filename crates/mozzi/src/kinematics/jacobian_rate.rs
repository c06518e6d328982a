//! Rates of the Jacobians along a motion.

use super::{base_pose, base_twist};
use crate::model::{FrameId, Model};
use crate::quantities::{Call, DTHETA, Declaration, JACOBIAN, Kernel, Of, Quantity, THETA, by_rows, output, sized};
use crate::scalar::{Scalar, pass};
use crate::spatial::Twist;
use crate::workspace::Workspace;

pass! {
/// d`J_b`/dt of a frame along θ̇: 𝒱̇_b = `J_b` θ̈ + J̇_b θ̇ in {b} coordinates. `dJ` receives its n columns, J̇_i =
/// `[ad_{J_i}]` Σ_k J_k θ̇_k over the joints k between joint i and the frame; a ball's axes move with the link beyond
/// all three.
///
/// Cost O(depth), no allocation.
///
/// # Panics
/// When θ is not nq long, or θ̇ or `dJ` not n.
pub fn body_jacobian_rate<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, theta: &[S], dtheta: &[S], frame: FrameId, dJ: &mut [Twist<S>]) {
    model.assert_lengths(theta.len(), [dtheta.len(), dJ.len()]);
    dJ.fill(Twist::zero());
    let frame = model.frame_at::<S>(frame);
    let mut T = frame.T.inverse();                                        // T_{b,i}
    let (mut V, mut V_J) = (Twist::zero(), Twist::zero());                // of the frame seen from link i, and from the joint's link
    for (_, link) in model.to_base::<S>(frame.slot) {
        let J_i = T.Ad() * link.A().twist();
        if link.is_last {
            V_J = V;
        }
        dJ[link.j] += J_i.ad() * V_J;
        V += J_i * dtheta[link.j];
        T = T * link.transform(theta);
    }
    if model.is_floating() {
        for (column, e) in dJ.iter_mut().zip(Twist::axes()) {
            *column = (T.Ad() * e).ad() * V;
        }
    }
}
}

pass! {
/// d`J_s`/dt of a frame along θ̇: 𝒱̇_s = `J_s` θ̈ + J̇_s θ̇ in {s} coordinates. `dJ` receives its n columns, J̇_i =
/// `[ad_𝒱]` J_i, with 𝒱 the twist of the link that carries joint i. A ball's axes move with the link beyond all three,
/// so their 𝒱 is the twist of that link. (Computed from J̇_b and the frame's own twist, the contributions of the joints
/// in between would have to cancel.)
///
/// Cost O(depth), no allocation.
///
/// # Panics
/// When θ is not nq long, or θ̇ or `dJ` not n.
pub fn space_jacobian_rate<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    frame: FrameId,
    workspace: &mut Workspace<S>,
    dJ: &mut [Twist<S>],
) {
    model.assert_lengths(theta.len(), [dtheta.len(), dJ.len()]);
    dJ.fill(Twist::zero());
    let path = &mut workspace.path;
    path.clear();
    path.extend(model.to_base::<S>(model.frame_at::<S>(frame).slot).map(|(i, _)| i));
    let mut T = base_pose(model, theta); // T_{s,i}
    let mut V = T.Ad() * base_twist(model, theta, dtheta, Twist::zero());
    if model.is_floating() {
        for (column, e) in dJ.iter_mut().zip(Twist::axes()) {
            *column = V.ad() * (T.Ad() * e);
        }
    }
    for (at, &i) in path.iter().enumerate().rev() {
        let link = model.link::<S>(i);
        T = T * link.transform(theta).inverse();
        let J_i = T.Ad() * link.A().twist();
        if link.is_last && link.is_next() {
            V += J_i * dtheta[link.j];
            // all axes of the joint, whose columns were stored above
            for slot in path[at..].iter().copied() {
                let axis = model.link::<S>(slot);
                let J = if slot == i { J_i } else { dJ[axis.j] };
                dJ[axis.j] = V.ad() * J;
                if !axis.is_next() {
                    break;
                }
            }
        } else if link.is_last {
            dJ[link.j] += V.ad() * J_i;
            V += J_i * dtheta[link.j];
        } else {
            dJ[link.j] = J_i;
            V += J_i * dtheta[link.j];
        }
    }
}
}

/// See [`space_jacobian_rate`].
#[derive(Clone, Copy, Debug)]
pub struct SpaceJacobianRate;
impl Quantity for SpaceJacobianRate {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "space_jacobian_rate",
        "dJ_s/dt of a frame",
        &[THETA, DTHETA],
        &[output("dJ", JACOBIAN, "1/s or m/s")],
    )
    .of(Of::Frame);
}
impl Kernel for SpaceJacobianRate {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, ..], [dJ, ..], frame) = (c.inputs, c.outputs, c.of.frame());
        let columns = sized(&mut c.memory.twists, c.model.n(), Twist::zero());
        space_jacobian_rate(c.model, theta, dtheta, frame, &mut c.memory.workspace, columns);
        by_rows(columns.iter().map(|column| column.to_array()), dJ);
    }
}

/// See [`body_jacobian_rate`].
#[derive(Clone, Copy, Debug)]
pub struct BodyJacobianRate;
impl Quantity for BodyJacobianRate {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "body_jacobian_rate",
        "dJ_b/dt of a frame",
        &[THETA, DTHETA],
        &[output("dJ", JACOBIAN, "1/s or m/s")],
    )
    .of(Of::Frame);
}
impl Kernel for BodyJacobianRate {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, ..], [dJ, ..], frame) = (c.inputs, c.outputs, c.of.frame());
        let columns = sized(&mut c.memory.twists, c.model.n(), Twist::zero());
        body_jacobian_rate(c.model, theta, dtheta, frame, columns);
        by_rows(columns.iter().map(|column| column.to_array()), dJ);
    }
}
