//! The motion of one anchor of a constraint relative to the other.

use crate::lie::SE3;
use crate::linalg::Vec3;
use crate::model::{End, Model, Way};
use crate::scalar::Scalar;
use crate::spatial::{JointAxis, Twist};
use crate::workspace::{Recursion, Workspace};

/// The motion of {b} relative to {a}, in the axes of {a}, with rates taken in {a}.
pub(super) struct RelativeMotion<S> {
    /// T_ab.
    pub T: SE3<S>,
    /// ω and ṗ, with p the origin of {b}.
    pub V: Twist<S>,
    /// dω/dt and p̈ at θ̈ = 0.
    pub bias: Twist<S>,
    /// The Jacobian's columns of a floating base, if it carries only one of the anchors.
    pub by_base: Option<[Twist<S>; 6]>,
}

/// The twist of an anchor relative to a link on its way to the base, and its rate at θ̈ = 0, in the anchor's
/// coordinates: see [`frame_acceleration`](crate::kinematics::frame_acceleration).
struct Side<S> {
    /// The link seen from the anchor.
    T: SE3<S>,
    V: Twist<S>,
    /// V without the joint whose axes are being added.
    V_J: Twist<S>,
    dV: Twist<S>,
}

impl<S: Scalar> Side<S> {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn at(T: SE3<S>) -> Self {
        Side { T: T.inverse(), V: Twist::zero(), V_J: Twist::zero(), dV: Twist::zero() }
    }

    /// The acceleration of the anchor's origin, and its angular acceleration.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn classical(&self) -> Twist<S> {
        Twist { w: self.dV.w, v: self.dV.v + self.V.w.cross(self.V.v) }
    }
}

/// The motion of {b} relative to {a}. Each anchor is followed up to the link that carries both, so that link's own
/// motion does not enter.
///
/// `base` is the pose of the base, and T_{i,i−1}(θ) is required in the workspace. Afterwards its 𝒱 holds, for the slots
/// on the [`Way`] of the anchors, the columns of the Jacobian, (∂ω, ∂ṗ)/∂θ̇_j, in parts.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn relative_motion<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    base: SE3<S>,
    dtheta: &[S],
    [a, b]: [&End<C>; 2],
    workspace: &mut Workspace<S>,
) -> RelativeMotion<S> {
    let Workspace { recursion: Recursion { T, V: columns, .. }, .. } = workspace;
    let mut sides = [Side::at(a.T.map(S::from)), Side::at(b.T.map(S::from))];
    for (k, slot) in Way::new(&model.links, [a.slot, b.slot]) {
        let (side, link) = (&mut sides[k], model.link::<S>(slot));
        let J = seen(side.T, link.A());
        if link.is_last {
            side.V_J = side.V;
        }
        side.dV += J.ad() * side.V_J * dtheta[link.j];
        side.V += J * dtheta[link.j];
        side.T = side.T * T[slot];
        columns[slot] = J;
    }
    // from a floating base to {s}
    let mut carried = None;
    if let (true, Some(&V_0)) = (a.slot.is_none() != b.slot.is_none(), dtheta.first_chunk()) {
        let k = usize::from(a.slot.is_none());
        let side = &mut sides[k];
        carried = Some((k, side.T));
        let V_0 = side.T.Ad() * Twist::from_array(V_0);
        side.dV += V_0.ad() * side.V;
        side.V += V_0;
        side.T = side.T * base.inverse();
    }

    // both seen from {a}
    let [of_a, of_b] = &sides;
    let T_ab = of_a.T * of_b.T.inverse();
    let (R, p) = (T_ab.R, T_ab.p);
    for (k, slot) in Way::new(&model.links, [a.slot, b.slot]) {
        let J = columns[slot];
        columns[slot] = match k {
            0 => Twist { w: -J.w, v: -(J.v + J.w.cross(p)) },
            _ => Twist { w: R * J.w, v: R * J.v },
        };
    }
    let mut by_base = None;
    if let Some((k, T)) = carried {
        // Ad_T e: rotations (R e, p × R e), translations (0, R e), then as the columns above, which are linear
        let axes = T.R.inverse().matrix(); // R e_x, R e_y, R e_z
        let axes = [axes.x, axes.y, axes.z];
        let mut six = [Twist::zero(); 6];
        for j in 0..3 {
            let (z, p_0) = if k == 0 { (-axes[j], T.p - p) } else { (R * axes[j], R * T.p) };
            six[j] = Twist { w: z, v: p_0.cross(z) };
            six[j + 3] = Twist { w: Vec3::zero(), v: z };
        }
        by_base = Some(six);
    }
    let (w_a, w_b) = (of_a.V.w, R * of_b.V.w);
    let (A_a, A_b) = (of_a.classical(), of_b.classical());
    let V = Twist { w: w_b - w_a, v: R * of_b.V.v - of_a.V.v - w_a.cross(p) };
    let two = S::from_f64(2.0);
    let bias = Twist {
        w: R * A_b.w - A_a.w - w_a.cross(V.w),
        v: R * A_b.v - A_a.v - A_a.w.cross(p) - w_a.cross(w_a.cross(p) + V.v * two), // less the Coriolis acceleration
    };
    RelativeMotion { T: T_ab, V, bias, by_base }
}

/// Ad_T A for an axis (0, 0, a, 0, 0, b).
#[cfg_attr(not(debug_assertions), inline(always))]
fn seen<S: Scalar>(T: SE3<S>, A: JointAxis<S>) -> Twist<S> {
    let z = z_of(T);
    let w = z * A.a;
    Twist { w, v: T.p.cross(w) + z * A.b }
}

/// The third axis of a rotation's matrix: z of {b} in the axes of {a}.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn z_of<S: Scalar>(T: SE3<S>) -> Vec3<S> {
    let R = T.R.matrix();
    Vec3([R.x.0[2], R.y.0[2], R.z.0[2]])
}
