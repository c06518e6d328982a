//! A state with its rates, between two steps.

use crate::{Motion, Powers};
use alloc::vec::Vec;

/// A copy of the state of a [`Motion`] of one robot.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct State {
    pub t: f64,
    pub theta: Vec<f64>,
    pub dtheta: Vec<f64>,
    pub ddtheta: Vec<f64>,
    pub powers: Powers,
    /// ∫ of the powers.
    pub works: Powers,
}

impl State {
    pub fn of(motion: &Motion<f64, 3>) -> Self {
        let Motion { t, theta, dtheta, ddtheta, rates, integrals, .. } = motion.clone();
        State { t, theta, dtheta, ddtheta, powers: rates, works: integrals }
    }

    /// Copies the motion's state, without allocation.
    pub fn copy_from(&mut self, motion: &Motion<f64, 3>) {
        (self.t, self.powers, self.works) = (motion.t, motion.rates, motion.integrals);
        self.theta.copy_from_slice(&motion.theta);
        self.dtheta.copy_from_slice(&motion.dtheta);
        self.ddtheta.copy_from_slice(&motion.ddtheta);
    }

    /// Sets the motion to this state.
    pub fn copy_to(&self, motion: &mut Motion<f64, 3>) {
        (motion.t, motion.rates, motion.integrals) = (self.t, self.powers, self.works);
        motion.theta.copy_from_slice(&self.theta);
        motion.dtheta.copy_from_slice(&self.dtheta);
        motion.ddtheta.copy_from_slice(&self.ddtheta);
    }
}
