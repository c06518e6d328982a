//! Gradients with respect to θ as nq numbers.
//!
//! A quantity depends on the rotation R of a quaternion q = (w, v), not on its length, and a change δq turns the body
//! by ω = 2 (q* δq)_vec / |q|² in its own axes, or
//!
//! > ω = 2 (w δv − v δw − v × δv) / |q|²
//!
//! A gradient g along ω is therefore the gradient 2 (−vᵀg, w g + v × g) / |q|² with respect to q, which is tangent to
//! the unit sphere. An origin p moves by ṗ = R v, so that its gradient is R g. `_tangent.py` has the same maps for
//! arrays.

use mozzi::model::Freedom;
use mozzi::{Model, SO3, Scalar, Vec3};

/// The gradient with respect to the nq positions, from the n derivatives along the velocities.
pub fn position_gradient<S: Scalar>(model: &Model, theta: &[S], along: &[S], out: &mut [S]) {
    for place in model.configuration_space().places() {
        let (q, g, out) = (&theta[place.positions()], &along[place.velocities()], &mut out[place.positions()]);
        if place.freedom == Freedom::One {
            out[0] = g[0];
            continue;
        }
        let (w, v, g_w) = (q[0], Vec3([q[1], q[2], q[3]]), Vec3([g[0], g[1], g[2]]));
        let scale = S::from_f64(2.0) / (w * w + v.dot(v));
        out[0] = -v.dot(g_w) * scale;
        out[1..4].copy_from_slice(&((g_w * w + v.cross(g_w)) * scale).0);
        if place.freedom == Freedom::Free {
            let R = SO3::from_quaternion(w, v);
            out[4..7].copy_from_slice(&(R * Vec3([g[3], g[4], g[5]])).0);
        }
    }
}
