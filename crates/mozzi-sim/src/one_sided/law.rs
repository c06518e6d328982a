//! The laws of one-sided forces: admissible impulses, and the projection onto them.

use mozzi::scalar::Scalar;

/// A law between the impulse p that the robot applies and the velocity u of its surroundings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// One row of a constraint: u = 0, any p.
    Bilateral,
    /// A stop: 0 ≤ p ⊥ u ≥ 0.
    Stop,
    /// Dry friction of a joint: |p| ≤ `most`; u = 0, or p = −`most` sgn u.
    Dry {
        /// μ Δt, N s or N m s, at least 0.
        most: f64,
    },
    /// A point contact with Coulomb friction, rows (n, t₁, t₂), n into the surroundings: p is in the cone ‖p_t‖ ≤ μ
    /// p_n; p = 0 and u_n ≥ 0, or u = 0, or u_n = 0 and p_t = −μ p_n u_t/‖u_t‖.
    Contact {
        /// μ, at least 0.
        mu: f64,
    },
}

impl Law {
    /// The number of rows: 3 for a contact, else 1.
    pub fn rows(self) -> usize {
        if let Law::Contact { .. } = self { 3 } else { 1 }
    }

    /// The rows of friction, if its first row is this.
    pub(crate) fn tangential(self, first: usize) -> core::ops::Range<usize> {
        match self {
            Law::Bilateral | Law::Stop => first..first,
            Law::Dry { .. } => first..first + 1,
            Law::Contact { .. } => first + 1..first + 3,
        }
    }

    /// De Saxcé's term μ‖u_t‖, which makes Coulomb's law a cone complementarity between p and u + μ‖u_t‖e_n.
    pub(super) fn shift(self, u: &[f64]) -> f64 {
        if let Law::Contact { mu } = self { mu * norm(u[1], u[2]) } else { 0.0 }
    }

    /// The nearest admissible impulse.
    pub(super) fn project(self, x: &mut [f64]) {
        match self {
            Law::Bilateral => {}
            Law::Stop => x[0] = x[0].max(0.0),
            Law::Dry { most } => x[0] = x[0].clamp(-most, most),
            Law::Contact { mu } => {
                let (n, t) = (x[0], norm(x[1], x[2]));
                if t <= mu * n {
                    return;
                }
                if mu * t <= -n {
                    x.fill(0.0);
                    return;
                }
                let normal = (n + mu * t) / (1.0 + mu * mu);
                let scale = mu * normal / t;
                (x[0], x[1], x[2]) = (normal, scale * x[1], scale * x[2]);
            }
        }
    }
}

pub(super) fn norm(x: f64, y: f64) -> f64 {
    Scalar::sqrt(x * x + y * y)
}
