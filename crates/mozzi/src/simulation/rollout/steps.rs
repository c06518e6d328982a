//! The loop over the steps, forward, and backward by checkpoints.
//!
//! The stages of all steps would take memory O(N). Kept are the states at the beginning of segments of steps, and the
//! stages of one segment: they are computed anew when the segment's turn comes. With √N steps to a segment the memory
//! is O(√N), for one more forward pass. Stages that fit into [`TAPE`] numbers are all kept.

use super::adjoint::{Adjoint, stages};
use super::dynamics::{Stage, StageDynamics};
use super::tape::Tape;
use crate::model::Model;
use crate::simulation::{Explicit, Motion};
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

    /// Adds the loss's own gradient by state k, along the velocities and by θ̇. Called from k = N to 0.
    fn cotangent(&mut self, k: usize, theta: &[f64], dtheta: &[f64], theta_bar: &mut [f64], dtheta_bar: &mut [f64]);

    /// Takes the gradient by τ of step k.
    fn take(&mut self, k: usize, tau_bar: &[f64]);

    /// Are all states here already? Writes state k then.
    fn state(&self, k: usize, theta: &mut [f64], dtheta: &mut [f64]) -> bool {
        let _ = (k, theta, dtheta);
        false
    }
}

/// N explicit steps of h seconds, τ held over each, of one robot or of many of one model.
#[derive(Debug)]
pub struct Steps<D> {
    /// The equation of motion.
    pub dynamics: D,
    method: Explicit,
    h: f64,
    motion: Motion,
    tau: Vec<f64>,
    tape: Tape,
    checkpoints: Vec<[Vec<f64>; 2]>,
    adjoint: Adjoint,
    /// The parameters' number, of all robots.
    parameters: usize,
}

/// The gradient of a loss by the start of a rollout and by the parameters.
#[derive(Clone, Copy, Debug)]
pub struct StartGradient<'a> {
    /// Along the velocities, n numbers (of each robot).
    pub theta: &'a [f64],
    /// n numbers.
    pub dtheta: &'a [f64],
    /// p numbers; empty if not wanted.
    pub parameters: &'a [f64],
}

impl<D: StageDynamics> Steps<D> {
    /// Memory for this many robots.
    pub fn new(model: &Model, robots: usize, method: Explicit, h: f64, dynamics: D) -> Self {
        let (nq, n, space) = (model.nq() * robots, model.n() * robots, model.configuration_space());
        let start = Motion::start_many(space, robots, 0.0, &vec![0.0; nq], &vec![0.0; n], |_, _, _, _| Ok([]));
        let Ok(motion) = start.map_err(|never: core::convert::Infallible| match never {});
        Steps {
            dynamics,
            method,
            h,
            motion,
            tau: vec![0.0; n],
            tape: Tape::new(nq, n),
            checkpoints: Vec::new(),
            adjoint: Adjoint::new(space, model.n(), robots),
            parameters: model.parameter_count() * robots,
        }
    }

    /// The states of N steps.
    ///
    /// # Errors
    /// Those of the dynamics.
    pub fn run(&mut self, start: [&[f64]; 2], N: usize, tables: &mut impl Tables) -> Result<[&[f64]; 2], D::Error> {
        self.set(start);
        for k in 0..N {
            tables.record(k, &self.motion.theta, &self.motion.dtheta);
            tables.torque(k, &mut self.tau);
            self.step(k, false, usize::MAX)?;
        }
        tables.record(N, &self.motion.theta, &self.motion.dtheta);
        Ok([&self.motion.theta, &self.motion.dtheta])
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
    ) -> Result<StartGradient<'_>, D::Error> {
        let count = if wants_parameters { self.parameters } else { 0 };
        self.adjoint.parameters.clear();
        self.adjoint.parameters.resize(count, 0.0);
        self.adjoint.theta.fill(0.0);
        self.adjoint.dtheta.fill(0.0);
        if tables.state(N, &mut self.motion.theta, &mut self.motion.dtheta) {
            self.through_states(N, tables)?;
        } else {
            self.through_segments(start, N, segment, tables)?;
        }
        let Adjoint { theta, dtheta, parameters, .. } = &self.adjoint;
        Ok(StartGradient { theta, dtheta, parameters })
    }

    /// Backward through states that are there: each step's stages are computed once more.
    fn through_states(&mut self, N: usize, tables: &mut impl Tables) -> Result<(), D::Error> {
        self.loss(N, tables);
        for k in (0..N).rev() {
            tables.state(k, &mut self.motion.theta, &mut self.motion.dtheta);
            self.tape.clear();
            tables.torque(k, &mut self.tau);
            let needed = if self.adjoint.parameters.is_empty() { stages(self.method) - 1 } else { usize::MAX };
            self.step(k, true, needed)?;
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
    ) -> Result<(), D::Error> {
        let stages = stages(self.method);
        let row = stages * (self.motion.theta.len() + 2 * self.motion.dtheta.len()).max(1);
        let length = segment.unwrap_or(N.isqrt().max(TAPE / row)).max(1);
        self.checkpoints.resize_with(N.div_ceil(length), Default::default);
        self.set(start);
        for k in 0..N {
            if k % length == 0 {
                let Motion { theta, dtheta, .. } = &self.motion;
                for (kept, now) in self.checkpoints[k / length].iter_mut().zip([theta, dtheta]) {
                    kept.clone_from(now);
                }
                self.tape.clear();
            }
            tables.torque(k, &mut self.tau);
            self.step(k, true, usize::MAX)?;
        }
        self.loss(N, tables);
        for s in (0..self.checkpoints.len()).rev() {
            let steps = s * length..N.min((s + 1) * length);
            if steps.end < N {
                let [theta, dtheta] = &self.checkpoints[s];
                self.motion.theta.copy_from_slice(theta);
                self.motion.dtheta.copy_from_slice(dtheta);
                self.tape.clear();
                for k in steps.clone() {
                    tables.torque(k, &mut self.tau);
                    self.step(k, true, usize::MAX)?;
                }
            }
            for k in steps.clone().rev() {
                tables.torque(k, &mut self.tau);
                self.step_back(k, stages * (k - steps.start), tables)?;
            }
        }
        Ok(())
    }

    fn set(&mut self, [theta, dtheta]: [&[f64]; 2]) {
        self.motion.theta.copy_from_slice(theta);
        self.motion.dtheta.copy_from_slice(dtheta);
    }

    /// Adds the loss's gradient by the state in which the motion is.
    fn loss(&mut self, k: usize, tables: &mut impl Tables) {
        let (Motion { theta, dtheta, .. }, bars) = (&self.motion, &mut self.adjoint);
        tables.cotangent(k, theta, dtheta, &mut bars.theta, &mut bars.dtheta);
    }

    /// Step k, its stages on the tape; those from `needed` on without their θ̈, which only its end would need.
    fn step(&mut self, k: usize, is_taped: bool, needed: usize) -> Result<(), D::Error> {
        let Steps { dynamics, motion, tape, tau, h, method, .. } = self;
        let mut stage = 0;
        let needed = if *method == Explicit::SemiImplicitEuler { usize::MAX } else { needed };
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

    /// Back through step k, whose stages are on the tape from `first` on.
    fn step_back(&mut self, k: usize, first: usize, tables: &mut impl Tables) -> Result<(), D::Error> {
        let Steps { dynamics, adjoint, tape, tau, h, method, .. } = self;
        let t = k as f64 * *h;
        adjoint.step((*method, *h), (k, t, tau), (tape, first), dynamics)?;
        tables.take(k, &adjoint.tau);
        let [theta, dtheta, _] = tape.stage(first);
        tables.cotangent(k, theta, dtheta, &mut adjoint.theta, &mut adjoint.dtheta);
        Ok(())
    }
}
