//! PD control with gravity compensation (Modern Robotics, section 11.4.2; Takegaki and Arimoto 1981).

use super::{Gains, errors};
use crate::Error;
use crate::trajectories::Reference;
use mozzi::simulation::Input;
use mozzi::{Freedom, Model, Place, Workspace, gravity_forces, spring_forces};

/// τ = g(θ) + k(θ − θ₀) + K_p e + K_d ė: gravity and the robot's own springs are held, with K_p in N m/rad or N/m.
/// Along a moving reference it lags: it knows of no accelerations. A floating base and a free joint have no
/// motors.
pub struct PdGravity<'m, R> {
    model: &'m Model,
    /// What is followed.
    pub reference: R,
    gains: Gains,
    workspace: Workspace,
    g: Vec<f64>,
    springs: Vec<f64>,
}

impl<'m, R: Reference> PdGravity<'m, R> {
    /// For a robot that this model describes, rightly or not.
    ///
    /// # Errors
    /// [`mozzi::Error::WrongLength`], [`mozzi::Error::BadArgument`] for gains that are negative or not finite.
    pub fn new(model: &'m Model, reference: R, gains: Gains) -> Result<Self, Error> {
        gains.check(model)?;
        let [g, springs] = [(); 2].map(|()| vec![0.0; model.n()]);
        Ok(PdGravity { model, reference, gains, workspace: Workspace::new(model), g, springs })
    }
}

impl<R: Reference> Input for PdGravity<'_, R> {
    fn torque(&mut self, t: f64, theta: &[f64], dtheta: &[f64], tau: &mut [f64]) -> Result<(), mozzi::Error> {
        let [e, de] = errors(self.model, &self.reference.at(t), theta, dtheta)?;
        gravity_forces(self.model, theta, self.model.gravity(), &mut self.workspace, &mut self.g);
        spring_forces(self.model, theta, &mut self.springs);
        for j in self.model.places().iter().filter(|place| place.freedom != Freedom::Free).flat_map(Place::velocities) {
            tau[j] += self.g[j] + self.springs[j] + self.gains.p[j] * e[j] + self.gains.d[j] * de[j];
        }
        Ok(())
    }
}
