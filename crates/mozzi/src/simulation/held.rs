//! Joints that rest against their stops.

use crate::linalg::Vec3;
use crate::model::{Bounds, Freedom, Place};
use crate::scalar::Scalar;

/// A joint at its limit: nᵀθ̇ = 0, and so nᵀθ̈ + ṅᵀθ̇ = 0, where n is the gradient of the value that the limit bounds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Held {
    pub place: Place,
    /// −1 at the lower limit, 1 at the upper one.
    pub side: f64,
    limit: f64,
}

impl Held {
    /// Joint k at its lower (0) or upper (1) limit.
    pub fn new(bounds: &Bounds, k: usize, side: usize) -> Self {
        Held { place: bounds.places[k], side: if side == 0 { -1.0 } else { 1.0 }, limit: bounds.joints[k][side] }
    }

    /// nᵀx.
    pub fn along(&self, theta: &[f64], x: &[f64]) -> f64 {
        let n = self.place.bounded_gradient(theta);
        x[self.place.velocities()].iter().zip(n).map(|(x, n)| x * n).sum()
    }

    /// x ← x + an.
    pub fn add(&self, theta: &[f64], a: f64, x: &mut [f64]) {
        let n = self.place.bounded_gradient(theta);
        x[self.place.velocities()].iter_mut().zip(n).for_each(|(x, n)| *x += a * n);
    }

    /// ṅᵀθ̇: 0 for a joint of one axis, ½ cot(‖φ‖/2) ‖n × ω‖² for a ball with the rotation vector φ.
    pub fn rate_along(&self, theta: &[f64], dtheta: &[f64]) -> f64 {
        if self.place.freedom != Freedom::Ball {
            return 0.0;
        }
        let (n, w) = (Vec3(self.place.bounded_gradient(theta)), &dtheta[self.place.velocities()]);
        let across = n.cross(Vec3([w[0], w[1], w[2]]));
        let (sine, cosine) = Scalar::sin_cos(0.5 * self.place.bounded_value(theta));
        0.5 * cosine / sine * across.dot(across)
    }

    /// Puts the joint onto its limit.
    pub fn project(&self, theta: &mut [f64]) {
        self.place.put_at_limit(theta, self.limit);
    }
}
