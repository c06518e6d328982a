//! The motion of one anchor of a constraint relative to the other.

use crate::kinematics::base_pose;
use crate::lie::SE3;
use crate::linalg::Vec3;
use crate::model::{End, Model, Workspace};
use crate::scalar::Scalar;
use crate::spatial::{JointAxis, Twist};

/// The motion of {b} relative to {a}, in the axes of {a}, as an observer on {a} sees it.
pub(super) struct RelativeMotion<S> {
    /// T_ab.
    pub T: SE3<S>,
    /// ω and ṗ, with p the origin of {b}.
    pub V: Twist<S>,
    /// dω/dt and p̈ at θ̈ = 0.
    pub bias: Twist<S>,
}

/// The twist of an anchor relative to a link on its way to the base, and its rate at θ̈ = 0, in the anchor's
/// coordinates: see [`frame_acceleration`](crate::frame_acceleration).
struct Side<S> {
    /// The link seen from the anchor.
    T: SE3<S>,
    V: Twist<S>,
    /// V without the joint whose axes are being added.
    V_J: Twist<S>,
    dV: Twist<S>,
}

impl<S: Scalar> Side<S> {
    fn at(T: SE3<S>) -> Self {
        Side { T: T.inverse(), V: Twist::zero(), V_J: Twist::zero(), dV: Twist::zero() }
    }

    /// The acceleration of the anchor's origin, and its angular acceleration.
    fn classical(&self) -> Twist<S> {
        Twist { w: self.dV.w, v: self.dV.v + self.V.w.cross(self.V.v) }
    }
}

/// The motion of {b} relative to {a}. Both are followed to the link that carries them both, so that what moves this
/// link does not enter. `add(j, J)` gets each column of the Jacobian, (∂ω, ∂ṗ)/∂θ̇_j, in parts.
///
/// The workspace holds T_{i,i−1}(θ). Afterwards its 𝒱 holds the columns as the anchors see them.
#[inline(always)]
pub(super) fn relative_motion<S: Scalar + From<C>, C: Scalar>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    [a, b]: [&End<C>; 2],
    workspace: &mut Workspace<S>,
    mut add: impl FnMut(usize, Twist<S>),
) -> RelativeMotion<S> {
    let Workspace { T, V: columns, .. } = workspace;
    let mut sides = [a, b].map(|end| Side::at(end.T.map(S::from)));
    let mut slots = [a, b].map(|end| end.slot.unwrap_or(0));
    while slots[0] != slots[1] {
        let k = usize::from(slots[1] > slots[0]); // the one that is further from the base
        let (side, link) = (&mut sides[k], model.link::<S>(slots[k]));
        let J = seen(side.T, link.A());
        if link.is_last {
            side.V_J = side.V;
        }
        side.dV += J.ad() * side.V_J * dtheta[link.j];
        side.V += J * dtheta[link.j];
        side.T = side.T * T[slots[k]];
        columns[slots[k]] = J;
        slots[k] = link.parent;
    }
    // from a floating base to {s}
    let by_base = (a.slot.is_none() != b.slot.is_none()).then_some(usize::from(a.slot.is_none()));
    let mut base = None;
    if let (Some(k), Some(&V_0)) = (by_base, dtheta.first_chunk()) {
        let side = &mut sides[k];
        base = Some((k, side.T));
        let V_0 = side.T.Ad() * Twist::from_array(V_0);
        side.dV += V_0.ad() * side.V;
        side.V += V_0;
        side.T = side.T * base_pose(model, theta).inverse();
    }

    // both seen from {a}
    let [of_a, of_b] = &sides;
    let T_ab = of_a.T * of_b.T.inverse();
    let (R, p) = (T_ab.R, T_ab.p);
    let column = |k: usize, J: Twist<S>| match k {
        0 => Twist { w: -J.w, v: -(J.v + J.w.cross(p)) },
        _ => Twist { w: R * J.w, v: R * J.v },
    };
    let mut slots = [a, b].map(|end| end.slot.unwrap_or(0));
    while slots[0] != slots[1] {
        let k = usize::from(slots[1] > slots[0]);
        let link = model.link::<S>(slots[k]);
        add(link.j, column(k, columns[slots[k]]));
        slots[k] = link.parent;
    }
    if let Some((k, T)) = base {
        // Ad_T e: turns (R e, p × R e), slides (0, R e), then as `column`, which is linear, has it
        let axes = T.R.inverse().matrix(); // R e_x, R e_y, R e_z
        for (j, z) in [axes.x, axes.y, axes.z].into_iter().enumerate() {
            let (z, p_0) = if k == 0 { (-z, T.p - p) } else { (R * z, R * T.p) };
            add(j, Twist { w: z, v: p_0.cross(z) });
            add(j + 3, Twist { w: Vec3::zero(), v: z });
        }
    }
    let (w_a, w_b) = (of_a.V.w, R * of_b.V.w);
    let (A_a, A_b) = (of_a.classical(), of_b.classical());
    let V = Twist { w: w_b - w_a, v: R * of_b.V.v - of_a.V.v - w_a.cross(p) };
    let two = S::from_f64(2.0);
    let bias = Twist {
        w: R * A_b.w - A_a.w - w_a.cross(V.w),
        v: R * A_b.v - A_a.v - A_a.w.cross(p) - w_a.cross(w_a.cross(p) + V.v * two), // less the Coriolis acceleration
    };
    RelativeMotion { T: T_ab, V, bias }
}

/// Ad_T A for an axis (0, 0, a, 0, 0, b).
#[inline(always)]
fn seen<S: Scalar>(T: SE3<S>, A: JointAxis<S>) -> Twist<S> {
    let z = z_of(T);
    let w = z * A.a;
    Twist { w, v: T.p.cross(w) + z * A.b }
}

/// The third axis of a rotation's matrix: z of {b} in the axes of {a}.
#[inline(always)]
pub(super) fn z_of<S: Scalar>(T: SE3<S>) -> Vec3<S> {
    let R = T.R.matrix();
    Vec3([R.x.0[2], R.y.0[2], R.z.0[2]])
}
