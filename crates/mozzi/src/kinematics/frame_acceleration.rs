//! The classical acceleration of a frame.

use crate::model::{FrameId, Model};
use crate::quantities::{Call, DDTHETA, DTHETA, Declaration, Kernel, Of, Quantity, SIX, THETA, output};
use crate::scalar::Scalar;
use crate::spatial::Twist;

/// The classical acceleration of a frame {b}, (ω̇, p̈) in its own coordinates: its angular acceleration and that of its
/// origin,
///
/// > 𝒱̇_b = `J_b` θ̈ + J̇_b θ̇, p̈ = v̇_b + ω_b × v_b
///
/// with {s} at rest and without gravity; rad/s² and m/s².
///
/// Cost O(depth), no allocation.
///
/// # Panics
/// When θ is not nq long, or θ̇ or θ̈ not n.
#[cfg_attr(not(debug_assertions), inline(always))]
#[rustfmt::skip]
pub fn frame_acceleration<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>, theta: &[S], dtheta: &[S], ddtheta: &[S], frame: FrameId,
) -> Twist<S> {
    model.assert_lengths(theta.len(), [dtheta.len(), ddtheta.len()]);
    let frame = model.frame_at::<S>(frame);
    let mut T = frame.T.inverse();                                        // T_{b,i}
    let (mut V, mut dV) = (Twist::zero(), Twist::zero());                 // of the frame seen from link i
    let mut V_J = V;                                                      // and from the joint's link
    for (_, link) in model.to_base::<S>(frame.slot) {
        let J_i = T.Ad() * link.A().twist();
        if link.is_last {
            V_J = V;
        }
        dV += J_i * ddtheta[link.j] + J_i.ad() * V_J * dtheta[link.j];
        V  += J_i * dtheta[link.j];
        T   = T * link.transform(theta);
    }
    if let (Some(&V_0), Some(&dV_0), true) = (dtheta.first_chunk(), ddtheta.first_chunk(), model.is_floating()) {
        let V_0 = T.Ad() * Twist::from_array(V_0);
        dV += T.Ad() * Twist::from_array(dV_0) + V_0.ad() * V;
        V  += V_0;
    }
    Twist { w: dV.w, v: dV.v + V.w.cross(V.v) }
}

/// See [`frame_acceleration`].
#[derive(Clone, Copy, Debug)]
pub struct FrameAcceleration;
impl Quantity for FrameAcceleration {
    type Kernel = Self;
    const DECLARATION: Declaration = Declaration::new(
        "frame_acceleration",
        "the classical acceleration of a frame, angular and of its origin, in its own coordinates",
        &[THETA, DTHETA, DDTHETA],
        &[output("a", SIX, "rad/s², m/s²")],
    )
    .of(Of::Frame);
}
impl Kernel for FrameAcceleration {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn run<S: Scalar + From<C>, C: Scalar>(c: Call<S, C>) {
        let ([theta, dtheta, ddtheta, ..], [a, ..]) = (c.inputs, c.outputs);
        a.copy_from_slice(&frame_acceleration(c.model, theta, dtheta, ddtheta, c.of.frame()).to_array());
    }
}
