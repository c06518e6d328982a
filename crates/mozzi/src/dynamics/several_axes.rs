//! The axes of one ball or free joint, which move together.

use crate::lie::SE3;
use crate::linalg::{Square, Vec3};
use crate::model::{Lifted, Model};
use crate::scalar::Scalar;
use crate::spatial::{Twist, Wrench};
use crate::workspace::ByRates;

/// Adds the motion of a joint's own link to r of the joint's axes: `[ad_𝒱]` A, 𝒱 seen from each axis. i is the last
/// axis.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn add_moved_by_link<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    i: usize,
    T: &[SE3<S>],
    V: Twist<S>,
    pairs: &mut [ByRates<S>],
) {
    let (mut k, mut V) = (i, V);
    loop {
        let link = model.link::<S>(k);
        pairs[k].r += (V.ad() * link.A()).rate();
        if !link.is_next() {
            break;
        }
        (k, V) = (link.parent, T[k].inverse().Ad() * V);
    }
}

/// Cancels the term W = `[ad_A]`ᵀ𝓕ᶜ between axis i and the earlier axes of the same joint: they move together, so the
/// wrench at axis i does not move past them.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn carried_together<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    i: usize,
    T: &[SE3<S>],
    W: Wrench<S>,
    d_theta: &mut Square<S>,
) {
    let (j, mut above, mut W) = (model.links[i - 1].j, i, W);
    for (k, below) in model.to_base::<S>(model.links[i - 1].parent) {
        W = T[above].Ad().transpose() * W;
        d_theta[(below.j, j)] += below.A() * W;
        if !below.is_next() {
            break;
        }
        above = k;
    }
}

/// The twist that moves a joint's axis, up to a multiple of the axis itself. For the first or only axis of a joint it
/// is the twist `V_i` of its own link; for a further axis of a ball or a free joint it is that of the joint's parent
/// about the joint's origin, with v set to zero.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn carrier_twist<S: Scalar + From<C>, C: Scalar>(
    link: &Lifted<C, S>,
    T: SE3<S>,
    V_i: Twist<S>,
    V: &[Twist<S>],
    carrier: &mut [[Twist<S>; 3]],
    i: usize,
) -> Twist<S> {
    if link.has_one_axis() {
        return V_i;
    }
    let parent = if link.is_next() { carrier[link.parent][0].w } else { V[link.parent].w };
    carrier[i][0] = Twist { w: T.R * parent, v: Vec3::zero() };
    if link.is_next() { carrier[i][0] } else { V_i }
}
