//! Coulomb friction that is smooth, on any number type.

use crate::Friction;
use mozzi::model::Model;
use mozzi::scalar::{Real, Scalar};

impl Friction {
    /// Writes the force for kernels that subtract μ sgn θ̇ themselves: τ, plus the difference of the two laws.
    pub(crate) fn force<S: Real + From<C>, C: Scalar>(
        self,
        model: &Model<C>,
        tau: &[S],
        dtheta: &[S],
        force: &mut [S],
    ) {
        force.copy_from_slice(tau);
        if let Friction::Smooth { slip_speed } = self {
            for (j, &rate) in dtheta.iter().enumerate() {
                let law = (rate / S::from_f64(slip_speed)).tanh();
                force[j] = tau[j] + S::from(model.friction()[j]) * (rate.sgn() - law);
            }
        }
    }
}
