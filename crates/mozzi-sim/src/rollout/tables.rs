//! The tables of a rollout, row by row: torques in; states, or gradients with respect to the torques, out.

use super::{RolloutStates, Tables};

/// Torques read, states written.
pub struct Record<'a> {
    pub n: usize,
    pub tau: &'a [f64],
    pub theta_table: &'a mut [f64],
    pub dtheta_table: &'a mut [f64],
}

impl Tables for Record<'_> {
    fn torque(&mut self, k: usize, tau: &mut [f64]) {
        tau.copy_from_slice(&self.tau[k * self.n..][..self.n]);
    }

    fn record(&mut self, k: usize, theta: &[f64], dtheta: &[f64]) {
        self.theta_table[k * theta.len()..][..theta.len()].copy_from_slice(theta);
        self.dtheta_table[k * dtheta.len()..][..dtheta.len()].copy_from_slice(dtheta);
    }

    fn cotangent(&mut self, _: usize, _: &[f64], _: &[f64], _: &mut [f64], _: &mut [f64]) {}

    fn take(&mut self, _: usize, _: &[f64]) {}
}

/// Torques read, their gradient written.
pub struct Gradient<'a, F> {
    pub n: usize,
    pub tau: &'a [f64],
    pub tau_bar: &'a mut [f64],
    pub states: Option<&'a RolloutStates>,
    pub loss: F,
}

impl<F: FnMut(usize, &[f64], &[f64], &mut [f64], &mut [f64])> Tables for Gradient<'_, F> {
    fn torque(&mut self, k: usize, tau: &mut [f64]) {
        tau.copy_from_slice(&self.tau[k * self.n..][..self.n]);
    }

    fn record(&mut self, _: usize, _: &[f64], _: &[f64]) {}

    fn cotangent(&mut self, k: usize, theta: &[f64], dtheta: &[f64], theta_bar: &mut [f64], dtheta_bar: &mut [f64]) {
        (self.loss)(k, theta, dtheta, theta_bar, dtheta_bar);
    }

    fn take(&mut self, k: usize, tau_bar: &[f64]) {
        self.tau_bar[k * self.n..][..self.n].copy_from_slice(tau_bar);
    }

    fn state(&self, k: usize) -> Option<[&[f64]; 2]> {
        let RolloutStates { theta, dtheta } = self.states?;
        let nq = theta.len() / (dtheta.len() / self.n.max(1)).max(1);
        Some([&theta[k * nq..][..nq], &dtheta[k * self.n..][..self.n]])
    }
}
