//! A robot, its input and its constraints.

use crate::Error;
use crate::closing::Closer;
use crate::factored_mass::FactoredMass;
use crate::state::State;
use crate::{Closing, Energy, Equation, Input, Powers};
use mozzi::model::Model;

/// The equation of motion of a robot under its input, and what keeps its constraints.
pub(crate) struct Driven<'m, I = &'m mut (dyn Input + 'm)> {
    pub model: &'m Model,
    pub equation: Equation<'m, I>,
    /// M of the last factorization.
    pub mass: FactoredMass<'m>,
    closer: Option<Closer>,
}

impl<'m, I: Input> Driven<'m, I> {
    pub fn new(equation: Equation<'m, I>) -> Self {
        let model = equation.model();
        Driven { model, equation, mass: FactoredMass::new(model), closer: Closer::new(model) }
    }

    /// Sets the step that errors report.
    pub fn at_step(&mut self, step: usize, step_size: f64) {
        self.equation.at_step(step, step_size);
    }

    pub fn tau(&self) -> &[f64] {
        self.equation.tau()
    }

    /// θ̈ and the powers.
    pub fn evaluate(&mut self, t: f64, theta: &[f64], dtheta: &[f64], ddtheta: &mut [f64]) -> Result<Powers, Error> {
        self.equation.evaluate(t, theta, dtheta, ddtheta)
    }

    /// True if the robot has constraints.
    pub fn has_constraints(&self) -> bool {
        self.closer.is_some()
    }

    /// Checks that the start satisfies the constraints, then brings it onto them.
    pub fn close_start(&mut self, theta: &mut [f64], dtheta: &mut [f64]) -> Result<(), Error> {
        let Some(closer) = &mut self.closer else { return Ok(()) };
        closer.check_start(self.model, theta, dtheta)?;
        closer.close(self.model, 0.0, theta, dtheta)
    }

    /// Brings positions and velocities back onto the constraints.
    pub fn close(&mut self, t: f64, theta: &mut [f64], dtheta: &mut [f64]) -> Result<(), Error> {
        match &mut self.closer {
            Some(closer) => closer.close(self.model, t, theta, dtheta),
            None => Ok(()),
        }
    }

    /// The largest violation of the constraints so far.
    pub fn closing(&self) -> Closing {
        self.closer.as_ref().map_or(Closing::default(), |closer| closer.account)
    }

    /// Fills in θ̈ and the powers of a state.
    pub fn complete(&mut self, state: &mut State) -> Result<(), Error> {
        let State { t, theta, dtheta, ddtheta, powers, .. } = state;
        *powers = self.evaluate(*t, theta, dtheta, ddtheta)?;
        Ok(())
    }

    pub fn energy(&mut self, theta: &[f64], dtheta: &[f64], works: Powers) -> Energy {
        self.equation.energy(theta, dtheta, works)
    }
}
