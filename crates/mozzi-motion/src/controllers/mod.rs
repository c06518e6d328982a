//! Controllers: motors that follow a [`Reference`](crate::trajectories::Reference) (Modern Robotics, chapter 11). Each
//! is an [`Input`](mozzi_sim::Input) of a simulation, and has a model of its own, which may differ from the
//! simulated robot.
//!
//! | | τ | the error if the model is exact |
//! |---|---|---|
//! | [`PdGravity`] | g(θ) + K_p e + K_d ė | goes to 0 if the reference rests |
//! | [`ComputedTorque`] | M(θ)(θ̈_d + K_d ė + K_p e) + h(θ, θ̇) | ë + K_d ė + K_p e = 0 |
//! | [`TaskSpace`], accelerations | Jᵀ(Λ(a + K_d 𝒱_e + K_p X_e) + η) | 𝒱̇_e + K_d 𝒱_e + K_p X_e = 0 |
//! | [`TaskSpace`], impedance | Jᵀ(Λa + η + B𝒱_e + KX_e) | Λ𝒱̇_e + B𝒱_e + KX_e = 𝓕, applied to the environment |
//! | `Standing`, feature `standing` | Mθ̈ + h + Jᵀf, f within the feet's friction cones | goes to 0 while the cones allow it |
//!
//! with e = θ_d ⊖ θ, X_e = log(T⁻¹T_d), 𝒱_e = `[Ad_T⁻¹T_d]`𝒱_d − 𝒱. The second to fourth add the forces of friction and
//! springs, which h and η lack, the first those of springs. [`Saturated`] wraps any of them.

mod computed_torque;
mod pd_gravity;
mod saturation;
#[cfg(feature = "standing")]
mod standing;
mod task_space;
mod tracking;

pub use computed_torque::ComputedTorque;
pub use pd_gravity::PdGravity;
pub use saturation::{Overload, Saturated};
#[cfg(feature = "standing")]
pub use standing::Standing;
pub use task_space::{Law, TaskSpace};
pub use tracking::{Tracking, TrackingError, tracking_error, tracking_error_of_rows};

use crate::Error;
use crate::error::check;
use crate::trajectories::Desired;
use mozzi::Model;
use mozzi::model::difference;

/// Gains of each of the n velocities; those of a floating base, which has no motors, are not used.
#[derive(Clone, Debug, PartialEq)]
pub struct Gains {
    /// K_p, diagonal.
    pub p: Vec<f64>,
    /// K_d, diagonal.
    pub d: Vec<f64>,
}

impl Gains {
    /// Equal gains for all n velocities.
    pub fn uniform(n: usize, p: f64, d: f64) -> Self {
        Gains { p: vec![p; n], d: vec![d; n] }
    }

    /// K_p = ω², K_d = 2ω: critical damping for gains on accelerations. The error falls as fast as it can without
    /// overshoot.
    pub fn critical(n: usize, omega: f64) -> Self {
        Self::uniform(n, omega * omega, 2.0 * omega)
    }

    fn check(&self, model: &Model) -> Result<(), Error> {
        for (what, list) in [("K_p", &self.p), ("K_d", &self.d)] {
            if list.len() != model.n() {
                return Err(mozzi::Error::WrongLength { what, found: list.len(), expected: model.n() }.into());
            }
            let fine = list.iter().all(|x| *x >= 0.0 && x.is_finite());
            check(fine, what, format!("{list:?}"), "finite numbers that are not negative")?;
        }
        Ok(())
    }
}

/// e = θ_d ⊖ θ and ė = θ̇_d − θ̇.
fn errors(model: &Model, desired: &Desired, theta: &[f64], dtheta: &[f64]) -> Result<[Vec<f64>; 2], mozzi::Error> {
    model.check_lengths(theta, [("dtheta", dtheta)])?;
    model.check_lengths(&desired.theta, [("the reference's dtheta", &desired.dtheta)])?;
    let mut e = vec![0.0; model.n()];
    difference(model, theta, &desired.theta, &mut e);
    Ok([e, desired.dtheta.iter().zip(dtheta).map(|(d, x)| d - x).collect()])
}

#[cfg(test)]
mod tests;
