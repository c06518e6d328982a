//! The explicit methods' steps.

use super::adjoint::{Adjoint, stages};
use super::dynamics::{Stage, StageDynamics};
use super::stepper::{Cotangents, Stepper};
use super::tape::Tape;
use crate::{Explicit, Motion};
use alloc::vec;
use mozzi::model::Model;

/// Explicit steps of h seconds, of one robot or of many of one model.
#[derive(Debug)]
pub struct ExplicitSteps<D> {
    /// The equation of motion.
    pub dynamics: D,
    method: Explicit,
    h: f64,
    motion: Motion,
    tape: Tape,
    adjoint: Adjoint,
}

impl<D: StageDynamics> ExplicitSteps<D> {
    /// Memory for this many robots.
    pub fn new(model: &Model, robots: usize, method: Explicit, h: f64, dynamics: D) -> Self {
        let (nq, n, space) = (model.nq() * robots, model.n() * robots, model.configuration_space());
        let start = Motion::start_many(space, robots, 0.0, &vec![0.0; nq], &vec![0.0; n], |_, _, _, _| Ok([]));
        let Ok(motion) = start.map_err(|never: core::convert::Infallible| match never {});
        let (tape, adjoint) = (Tape::new(nq, n), Adjoint::new(space, model.n(), robots));
        ExplicitSteps { dynamics, method, h, motion, tape, adjoint }
    }
}

impl<D: StageDynamics> Stepper for ExplicitSteps<D> {
    type Error = D::Error;

    fn taped(&self) -> usize {
        stages(self.method) * (self.motion.theta.len() + 2 * self.motion.dtheta.len())
    }

    fn set(&mut self, theta: &[f64], dtheta: &[f64]) {
        self.motion.theta.copy_from_slice(theta);
        self.motion.dtheta.copy_from_slice(dtheta);
    }

    fn state(&self) -> [&[f64]; 2] {
        [&self.motion.theta, &self.motion.dtheta]
    }

    fn clear(&mut self) {
        self.tape.clear();
    }

    fn step(&mut self, k: usize, tau: &[f64], is_taped: bool, needs_end: bool) -> Result<(), D::Error> {
        let ExplicitSteps { dynamics, motion, tape, h, method, .. } = self;
        // the last stage's θ̈ serves the end alone, and of the semi-implicit method the adjoint
        let skipped = !needs_end && *method != Explicit::SemiImplicitEuler;
        let needed = if skipped { stages(*method) - 1 } else { usize::MAX };
        let mut stage = 0;
        let mut F = |t: f64, theta: &[f64], dtheta: &[f64], ddtheta: &mut [f64]| {
            if stage < needed {
                dynamics.accelerations(Stage { step: k, t, theta, dtheta, tau }, ddtheta)?;
            }
            stage += 1;
            if is_taped {
                tape.push(theta, dtheta, ddtheta);
            }
            Ok([])
        };
        motion.t = k as f64 * *h;
        motion.find_rates(&mut F)?;
        motion.advance(*method, *h, (k + 1) as f64 * *h, &mut F)
    }

    fn start(&self, at: usize) -> [&[f64]; 2] {
        let [theta, dtheta, _] = self.tape.stage(stages(self.method) * at);
        [theta, dtheta]
    }

    fn step_back(&mut self, k: usize, at: usize, tau: &[f64], to: &mut Cotangents) -> Result<(), D::Error> {
        let ExplicitSteps { dynamics, adjoint, tape, h, method, .. } = self;
        let first = stages(*method) * at;
        adjoint.step((*method, *h), (k, k as f64 * *h, tau), (tape, first), dynamics, to)
    }
}
