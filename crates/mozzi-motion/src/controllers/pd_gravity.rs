//! PD control with gravity compensation (Modern Robotics, section 11.4.2; Takegaki and Arimoto 1981).

use super::{Gains, errors};
use crate::Error;
use crate::trajectories::Reference;
use mozzi::{Freedom, Model};
use mozzi_sim::{GravityCompensation, Input};

/// τ = g(θ) + k(θ − θ₀) + K_p e + K_d ė: compensates gravity and the robot's own springs; K_p in N m/rad or N/m. It
/// lags behind a moving reference, because it does not use accelerations. A floating base and a free joint have no
/// motors; in a robot with constraints, only the [motors](Model::motors) that exist act.
pub struct PdGravity<'m, R> {
    model: &'m Model,
    /// The reference to follow.
    pub reference: R,
    gains: Gains,
    gravity: GravityCompensation<'m>,
}

impl<'m, R: Reference> PdGravity<'m, R> {
    /// With this model of the robot, which need not be exact.
    ///
    /// # Errors
    /// [`mozzi::Error::WrongLength`], [`mozzi::Error::BadArgument`] for gains that are negative or not finite.
    pub fn new(model: &'m Model, reference: R, gains: Gains) -> Result<Self, Error> {
        gains.check(model)?;
        Ok(PdGravity { model, reference, gains, gravity: GravityCompensation::new(model) })
    }
}

impl<R: Reference> Input for PdGravity<'_, R> {
    fn torque(&mut self, t: f64, theta: &[f64], dtheta: &[f64], tau: &mut [f64]) -> Result<(), mozzi_sim::Error> {
        let [e, de] = errors(self.model, &self.reference.at(t), theta, dtheta)?;
        self.gravity.torque(t, theta, dtheta, tau)?;
        let is_free =
            |j: &usize| self.model.places().iter().any(|at| at.freedom == Freedom::Free && at.velocities().contains(j));
        for j in self.model.motors().into_iter().filter(|j| !is_free(j)) {
            tau[j] += self.gains.p[j] * e[j] + self.gains.d[j] * de[j];
        }
        Ok(())
    }

    fn gains(&self, stiffness: &mut [f64], damping: &mut [f64]) {
        let driven = self.model.places().iter().filter(|place| place.freedom == Freedom::One);
        let motors = self.model.motors();
        for j in driven.flat_map(|place| place.velocities()).filter(|j| motors.contains(j)) {
            stiffness[j] += self.gains.p[j];
            damping[j] += self.gains.d[j];
        }
    }
}
