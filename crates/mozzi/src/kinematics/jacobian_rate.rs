//! Rates of the Jacobians along a motion.

use super::jacobian::{body_columns, twist_of};
use crate::model::{FrameId, Model, Workspace};
use crate::quantity::{Call, DTHETA, Declaration, JACOBIAN, Kernel, Of, Quantity, THETA, by_rows, output, sized};
use crate::scalar::Scalar;
use crate::spatial::Twist;

/// d`J_b`/dt of a frame along θ̇: 𝒱̇_b = `J_b` θ̈ + J̇_b θ̇ in {b} coordinates. `dJ` takes its n columns,
/// J̇_i = `[ad_{J_i}]` Σ_k J_k θ̇_k over the joints k between joint i and the frame.
///
/// Cost O(depth), no allocation.
///
/// # Panics
/// When θ is not nq long, or θ̇ or `dJ` not n.
#[cfg_attr(not(test), inline(always))]
#[rustfmt::skip]
pub fn body_jacobian_rate<S: Scalar + From<C>, C: Scalar>(model: &Model<C>, theta: &[S], dtheta: &[S], frame: FrameId, dJ: &mut [Twist<S>]) {
    model.assert_lengths(theta.len(), [dtheta.len(), dJ.len()]);
    dJ.fill(Twist::zero());
    let frame = model.frame_at::<S>(frame);
    let mut T = frame.T.inverse();                                        // T_{b,i}
    let mut V = Twist::zero();                                            // of the frame seen from link i
    for (_, link) in model.to_base::<S>(frame.slot) {
        let J_i = T.Ad() * link.A().twist();
        dJ[link.j] += J_i.ad() * V * link.ratio();
        V += J_i * link.rate(dtheta);
        T = T * link.transform(theta);
    }
    if model.is_floating() {
        for (column, e) in dJ.iter_mut().zip(Twist::axes()) {
            *column = (T.Ad() * e).ad() * V;
        }
    }
}

/// d`J_s`/dt of a frame along θ̇: 𝒱̇_s = `J_s` θ̈ + J̇_s θ̇ in {s} coordinates. `dJ` takes its n columns,
/// J̇_s = `[Ad_T_sb]` (`[ad_V_b]` `J_b` + J̇_b).
///
/// Cost O(n), no allocation.
///
/// # Panics
/// When θ is not nq long, or θ̇ or `dJ` not n.
#[cfg_attr(not(test), inline(always))]
pub fn space_jacobian_rate<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    frame: FrameId,
    workspace: &mut Workspace<S>,
    dJ: &mut [Twist<S>],
) {
    body_jacobian_rate(model, theta, dtheta, frame, dJ);
    let J = &mut workspace.V[..model.n()];
    let T_sb = body_columns(model, theta, frame, J);
    let V_b = twist_of(J, dtheta);
    for (dJ_i, &J_i) in dJ.iter_mut().zip(&*J) {
        *dJ_i = T_sb.Ad() * (V_b.ad() * J_i + *dJ_i);
    }
}

/// See [`space_jacobian_rate`].
#[derive(Clone, Copy, Debug)]
pub struct SpaceJacobianRate;
impl Quantity for SpaceJacobianRate {
    type Kernel = Self;
    type Registers = Self;
    const DECLARATION: Declaration = Declaration::new(
        "space_jacobian_rate",
        "dJ_s/dt of a frame",
        &[THETA, DTHETA],
        &[output("dJ", JACOBIAN, "1/s or m/s")],
    )
    .of(Of::Frame);
}
impl Kernel for SpaceJacobianRate {
    #[inline(always)]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, _], [dJ, ..], frame) = (c.inputs, c.outputs, c.of.frame());
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
    type Registers = Self;
    const DECLARATION: Declaration = Declaration::new(
        "body_jacobian_rate",
        "dJ_b/dt of a frame",
        &[THETA, DTHETA],
        &[output("dJ", JACOBIAN, "1/s or m/s")],
    )
    .of(Of::Frame);
}
impl Kernel for BodyJacobianRate {
    #[inline(always)]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, _], [dJ, ..], frame) = (c.inputs, c.outputs, c.of.frame());
        let columns = sized(&mut c.memory.twists, c.model.n(), Twist::zero());
        body_jacobian_rate(c.model, theta, dtheta, frame, columns);
        by_rows(columns.iter().map(|column| column.to_array()), dJ);
    }
}
