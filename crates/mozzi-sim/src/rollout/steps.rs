//! The loop over the steps, forward, and backward by checkpoints.
//!
//! The stages of all steps would take memory O(N). Kept are the states at the beginning of segments of steps, and the
//! stages of one segment: they are computed anew when the segment's turn comes. With √N steps to a segment the memory
//! is O(√N), for one more forward pass. Stages that fit into [`TAPE`] numbers are all kept.

use super::stepper::{Cotangents, Stepper};
use alloc::vec;
use alloc::vec::Vec;

/// The numbers that a segment's stages may take, whatever N is: 1 MB, about a core's cache.
const TAPE: usize = 1 << 17;

/// The tables of a rollout, by step.
pub trait Tables {
    /// Writes τ of step k.
    fn torque(&mut self, k: usize, tau: &mut [f64]);

    /// Takes state k, from 0 to N.
    fn record(&mut self, k: usize, theta: &[f64], dtheta: &[f64]);

    /// Adds the loss's own gradient with respect to state k: θ (along the velocities) and θ̇. Called from k = N to 0.
    fn cotangent(&mut self, k: usize, theta: &[f64], dtheta: &[f64], theta_bar: &mut [f64], dtheta_bar: &mut [f64]);

    /// Takes the gradient with respect to τ of step k.
    fn take(&mut self, k: usize, tau_bar: &[f64]);

    /// θ and θ̇ of state k if all states are there already.
    fn state(&self, k: usize) -> Option<[&[f64]; 2]> {
        let _ = k;
        None
    }
}

/// N steps of one robot or of many of one model, τ held over each.
#[derive(Debug)]
pub struct Steps<S> {
    /// The integrator.
    pub stepper: S,
    tau: Vec<f64>,
    checkpoints: Vec<[Vec<f64>; 2]>,
    cotangents: Cotangents,
    /// The parameters' number, of all robots.
    parameters: usize,
}

/// The gradient of a loss with respect to the start of a rollout and the parameters.
#[derive(Clone, Copy, Debug)]
pub struct StartGradient<'a> {
    /// Along the velocities, n numbers (of each robot).
    pub theta: &'a [f64],
    /// n numbers.
    pub dtheta: &'a [f64],
    /// p numbers; empty if not wanted.
    pub parameters: &'a [f64],
}

impl<S: Stepper> Steps<S> {
    /// For n velocities and p parameters, of all robots together.
    pub fn new(stepper: S, n: usize, p: usize) -> Self {
        let (tau, cotangents) = (vec![0.0; n], Cotangents::new(n));
        Steps { stepper, tau, checkpoints: Vec::new(), cotangents, parameters: p }
    }

    /// The states of N steps.
    ///
    /// # Errors
    /// Those of the dynamics.
    pub fn run(&mut self, start: [&[f64]; 2], N: usize, tables: &mut impl Tables) -> Result<[&[f64]; 2], S::Error> {
        self.stepper.set(start[0], start[1]);
        for k in 0..N {
            self.record(k, tables);
            tables.torque(k, &mut self.tau);
            self.stepper.step(k, &self.tau, false, true)?;
        }
        self.record(N, tables);
        Ok(self.stepper.state())
    }

    fn record(&self, k: usize, tables: &mut impl Tables) {
        let [theta, dtheta] = self.stepper.state();
        tables.record(k, theta, dtheta);
    }

    /// The gradient of a loss of the states, by the torques into the tables, by the start and the parameters here.
    ///
    /// # Errors
    /// Those of the dynamics.
    pub fn gradient(
        &mut self,
        start: [&[f64]; 2],
        N: usize,
        segment: Option<usize>,
        wants_parameters: bool,
        tables: &mut impl Tables,
    ) -> Result<StartGradient<'_>, S::Error> {
        let count = if wants_parameters { self.parameters } else { 0 };
        self.cotangents.parameters.clear();
        self.cotangents.parameters.resize(count, 0.0);
        self.cotangents.theta.fill(0.0);
        self.cotangents.dtheta.fill(0.0);
        if tables.state(N).is_some() {
            self.through_states(N, tables)?;
        } else {
            self.through_segments(start, N, segment, tables)?;
        }
        let Cotangents { theta, dtheta, parameters, .. } = &self.cotangents;
        Ok(StartGradient { theta, dtheta, parameters })
    }

    /// Backward through states that are there: each step is taken once more.
    fn through_states(&mut self, N: usize, tables: &mut impl Tables) -> Result<(), S::Error> {
        let Some([theta, dtheta]) = tables.state(N) else { return Ok(()) };
        self.stepper.set(theta, dtheta);
        self.loss(N, tables);
        for k in (0..N).rev() {
            let Some([theta, dtheta]) = tables.state(k) else { return Ok(()) };
            self.stepper.set(theta, dtheta);
            self.stepper.clear();
            tables.torque(k, &mut self.tau);
            let needs_end = !self.cotangents.parameters.is_empty();
            self.stepper.step(k, &self.tau, true, needs_end)?;
            self.step_back(k, 0, tables)?;
        }
        Ok(())
    }

    /// Forward, then backward segment by segment.
    fn through_segments(
        &mut self,
        start: [&[f64]; 2],
        N: usize,
        segment: Option<usize>,
        tables: &mut impl Tables,
    ) -> Result<(), S::Error> {
        let length = segment.unwrap_or(N.isqrt().max(TAPE / self.stepper.taped().max(1))).max(1);
        self.checkpoints.resize_with(N.div_ceil(length), Default::default);
        self.stepper.set(start[0], start[1]);
        for k in 0..N {
            if k % length == 0 {
                for (kept, now) in self.checkpoints[k / length].iter_mut().zip(self.stepper.state()) {
                    kept.clear();
                    kept.extend_from_slice(now);
                }
                self.stepper.clear();
            }
            tables.torque(k, &mut self.tau);
            self.stepper.step(k, &self.tau, true, true)?;
        }
        self.loss(N, tables);
        for s in (0..self.checkpoints.len()).rev() {
            let steps = s * length..N.min((s + 1) * length);
            if steps.end < N {
                let [theta, dtheta] = &self.checkpoints[s];
                self.stepper.set(theta, dtheta);
                self.stepper.clear();
                for k in steps.clone() {
                    tables.torque(k, &mut self.tau);
                    let needs_end = k + 1 < steps.end || !self.cotangents.parameters.is_empty();
                    self.stepper.step(k, &self.tau, true, needs_end)?;
                }
            }
            for k in steps.clone().rev() {
                tables.torque(k, &mut self.tau);
                self.step_back(k, k - steps.start, tables)?;
            }
        }
        Ok(())
    }

    /// Adds the loss's gradient with respect to the present state.
    fn loss(&mut self, k: usize, tables: &mut impl Tables) {
        let ([theta, dtheta], to) = (self.stepper.state(), &mut self.cotangents);
        tables.cotangent(k, theta, dtheta, &mut to.theta, &mut to.dtheta);
    }

    /// Back through step k, the tape's step `at`.
    fn step_back(&mut self, k: usize, at: usize, tables: &mut impl Tables) -> Result<(), S::Error> {
        let to = &mut self.cotangents;
        self.stepper.step_back(k, at, &self.tau, to)?;
        tables.take(k, &to.tau);
        let [theta, dtheta] = self.stepper.start(at);
        tables.cotangent(k, theta, dtheta, &mut to.theta, &mut to.dtheta);
        Ok(())
    }
}
