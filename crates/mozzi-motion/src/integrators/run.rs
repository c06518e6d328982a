//! The simulation: steps, what happens on the way, and what is recorded.

use super::dense::Dense;
use super::dormand_prince::DormandPrince;
use super::driven::Driven;
use super::events::{Event, Occurrence, first_zero};
use super::midpoint::Midpoint;
use super::stops::{Stopped, Stops};
use super::{Integrator, State, step_to};
use crate::error::check;
use crate::{Error, Policy};
use mozzi::simulation::{Equation, ForwardDynamics, Friction, Input, Method, Motion, Options, Sample};
use mozzi::{Model, Trajectory, Vec3};
use std::ops::ControlFlow;

/// How a motion is simulated. Start from [`new`](Self::new) and change what differs.
pub struct Simulation<'a> {
    /// How time passes; Dormand-Prince to 10⁻⁹.
    pub integrator: Integrator,
    /// t_f, s; the motion starts at 0.
    pub duration: f64,
    /// Seconds between two rows of the answer, which are at equal times, the end beside them; a hundredth of the duration. Of a fixed step
    /// the nearest number of steps, where neither events nor stops are looked for within them.
    pub record: f64,
    /// Gravity in {s} coordinates, m/s², in place of the model's own.
    pub gravity: Option<Vec3>,
    /// Coulomb friction as in the model.
    pub friction: Friction,
    /// What is made of the joints' limits of position; they are reported.
    pub stops: Policy,
    /// What is looked for on the way.
    pub events: Vec<Event<'a>>,
    /// θ̈ by machine code, such as `mozzi_codegen::Compiled::simulator` answers with, in place of the kernels.
    pub forward_dynamics: Option<&'a dyn ForwardDynamics>,
}

/// A simulated motion, and what happened on the way.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Rows at equal times, and at the end.
    pub motion: Trajectory,
    /// In the order of time.
    pub events: Vec<Occurrence>,
    /// Joints that came to their limits; none where those are ignored.
    pub stops: Vec<Stopped>,
}

/// A step of any integrator.
enum Stepper {
    Fixed(Method, f64),
    DormandPrince(Box<DormandPrince>),
    Midpoint(Box<Midpoint>),
}

impl Stepper {
    fn step<I: Input>(&mut self, from: &State, until: f64, driven: &mut Driven<I>) -> Result<(State, Dense), Error> {
        let model = driven.model;
        let to = match self {
            Stepper::DormandPrince(method) => return method.step(from, until, driven),
            Stepper::Midpoint(method) => method.step(from, until, driven)?,
            Stepper::Fixed(method, step) => {
                let (h, next) = step_to(*step, from.t, until);
                let known = from.ddtheta.clone();
                let State { t, theta, dtheta, powers, .. } = from;
                let mut motion: Motion<f64, 3> =
                    Motion::start(model.configuration_space(), *t, theta, dtheta, |_, _, _, ddtheta| {
                        ddtheta.copy_from_slice(&known);
                        Ok::<_, mozzi::Error>(*powers)
                    })?;
                motion.integrals = from.works;
                motion.step(*method, h, next, |t, q, dq, ddq| driven.evaluate(t, q, dq, ddq))?;
                let Motion { t, theta, dtheta, ddtheta, rates, integrals, .. } = motion;
                State { t, theta, dtheta, ddtheta, powers: rates, works: integrals }
            }
        };
        let dense = Dense::hermite(model, from, &to);
        Ok((to, dense))
    }
}

impl<'a> Simulation<'a> {
    /// By Dormand-Prince to 10⁻⁹, with a hundred rows, limits reported.
    pub fn new(duration: f64) -> Self {
        Simulation {
            integrator: Integrator::DormandPrince { tolerance: 1e-9 },
            duration,
            record: duration / 100.0,
            gravity: None,
            friction: Friction::Coulomb,
            stops: Policy::Report,
            events: Vec::new(),
            forward_dynamics: None,
        }
    }

    /// The motion from (θ(0), θ̇(0)) under an input.
    ///
    /// # Errors
    /// [`mozzi::Error`]s as of [`Model::simulate`]; [`Error::TooStiff`], [`Error::NoConvergence`].
    pub fn run(&self, model: &Model, theta: &[f64], dtheta: &[f64], input: impl Input) -> Result<Run, Error> {
        self.run_with_progress(model, theta, dtheta, input, |_| ControlFlow::Continue(()))
    }

    /// As [`run`](Self::run), telling the time after each step. `ControlFlow::Break(())` stops the simulation: the motion so far is the
    /// answer, not [`complete`](Trajectory::complete).
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn run_with_progress(
        &self,
        model: &Model,
        theta: &[f64],
        dtheta: &[f64],
        input: impl Input,
        mut progress: impl FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Run, Error> {
        let mut stepper = self.check(model, theta, dtheta)?;
        if let (Stepper::Fixed(method, step), true) =
            (&stepper, self.events.is_empty() && self.stops != Policy::Respect)
        {
            return self.run_plainly(model, [theta, dtheta], input, *method, *step, progress);
        }
        let options = Options { gravity: self.gravity, friction: self.friction, ..Options::new(self.duration, 1) };
        let mut driven =
            Driven::new(Equation::new(model, input, &options).with_forward_dynamics(self.forward_dynamics)?);
        let mut stops = Stops::new(model, self.stops, theta)?;
        let n = model.n();
        let mut state = State {
            t: 0.0,
            theta: theta.to_vec(),
            dtheta: dtheta.to_vec(),
            ddtheta: vec![0.0; n],
            powers: [0.0; 3],
            works: [0.0; 3],
        };
        driven.complete(&mut state)?;
        stops.report_at(0.0, theta);
        let mut run = Run { motion: Trajectory::new(model), events: Vec::new(), stops: Vec::new() };
        record(&mut run.motion, &state, &mut driven);
        let mut next = self.record;
        let mut over = self.duration == 0.0;
        while !over {
            let from = state.clone();
            driven.at_step(run.motion.steps + 1, self.duration.min(self.step_size()));
            let (to, dense) = stepper.step(&from, self.duration, &mut driven)?;
            run.motion.steps += 1;
            state = to;
            let impact =
                if stops.are_respected() { stops.first_impact(model, &dense, state.t, &driven.held) } else { None };
            let mut end = impact.map_or(state.t, |(t, ..)| t);
            let reached = if impact.is_some() { dense.at(model, end) } else { state.clone() };
            let release = stops.first_release(&dense, &reached, &mut driven)?;
            let impact = impact.filter(|_| release.is_none());
            end = release.unwrap_or(end);
            let stop = self.events_until(model, &dense, &mut end, &mut run.events);
            // rows before the end of what counts of the step
            while next < end - 1e-12 * self.duration && next < self.duration {
                let mut row = dense.at(model, next);
                driven.complete(&mut row)?;
                record(&mut run.motion, &row, &mut driven);
                next += self.record;
            }
            if end < state.t || impact.is_some() || release.is_some() {
                state = dense.at(model, end);
                driven.complete(&mut state)?;
            }
            if let Some((_, k, side)) = impact.filter(|(t, ..)| *t <= end) {
                stops.impact(&mut state, k, side, &mut driven)?;
            } else {
                driven.release(&mut state)?;
            }
            if end != dense.t + dense.h || impact.is_some() || release.is_some() {
                stepper.restart();
            }
            stops.report_at(state.t, &state.theta);
            let stopped = progress(state.t).is_break();
            run.motion.complete = state.t >= self.duration;
            over = run.motion.complete || stop || stopped;
            if over || (next - state.t).abs() <= 1e-12 * self.duration {
                driven.complete(&mut state)?; // τ is that of the row
                record(&mut run.motion, &state, &mut driven);
                next += self.record;
            }
        }
        run.motion.complete |= self.duration == 0.0;
        run.stops = stops.noted();
        Ok(run)
    }

    /// Nothing can happen within a step: steps of equal length, as [`Model::simulate`] takes them, and rows at their ends.
    fn run_plainly(
        &self,
        model: &Model,
        [theta, dtheta]: [&[f64]; 2],
        input: impl Input,
        method: Method,
        step: f64,
        mut progress: impl FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Run, Error> {
        let options =
            Options { gravity: self.gravity, friction: self.friction, ..Options::with_step(self.duration, step)? };
        let (steps, h) = (options.steps, options.step());
        let every = if h > 0.0 { (self.record / h).round().clamp(1.0, 1e15) as usize } else { 1 };
        let mut equation = Equation::new(model, input, &options).with_forward_dynamics(self.forward_dynamics)?;
        let mut stops = Stops::new(model, self.stops, theta)?;
        let mut motion: Motion<f64, 3> =
            Motion::start(model.configuration_space(), 0.0, theta, dtheta, |t, q, dq, ddq| {
                equation.evaluate(t, q, dq, ddq)
            })?;
        let mut run = Run { motion: Trajectory::new(model), events: Vec::new(), stops: Vec::new() };
        let mut row = |motion: &Motion<f64, 3>, equation: &mut Equation<_>| {
            let energy = equation.energy(&motion.theta, &motion.dtheta, motion.integrals);
            let Motion { t, theta, dtheta, ddtheta, .. } = motion;
            run.motion.record(Sample { t: *t, theta, dtheta, ddtheta, tau: equation.tau(), energy });
        };
        row(&motion, &mut equation);
        stops.report_at(0.0, theta);
        let mut done = 0;
        while done < steps {
            done += 1;
            equation.at_step(done, h);
            let t = if done == steps { self.duration } else { done as f64 * h };
            motion.step(method, h, t, |t, q, dq, ddq| equation.evaluate(t, q, dq, ddq))?;
            stops.report_at(t, &motion.theta);
            let stop = progress(t).is_break();
            if done % every == 0 || done == steps || stop {
                row(&motion, &mut equation);
            }
            if stop {
                break;
            }
        }
        (run.motion.steps, run.motion.complete, run.stops) = (done, done == steps, stops.noted());
        Ok(run)
    }

    /// Events within the step; where one of them ends the simulation, that is the end, and the answer is true.
    fn events_until(&self, model: &Model, dense: &Dense, end: &mut f64, events: &mut Vec<Occurrence>) -> bool {
        let mut found = Vec::new();
        for (k, event) in self.events.iter().enumerate() {
            let f = |state: &State| (event.function)(state.t, &state.theta, &state.dtheta);
            found.extend(first_zero(model, dense, *end, event.direction, f).map(|t| (t, k)));
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (t, k) in found {
            let State { theta, dtheta, .. } = dense.at(model, t);
            let Event { name, stop, .. } = &self.events[k];
            events.push(Occurrence { name: name.clone(), t, theta, dtheta, stop: *stop });
            if *stop {
                *end = t;
                return true;
            }
        }
        false
    }

    fn step_size(&self) -> f64 {
        match self.integrator {
            Integrator::Fixed(_, step) | Integrator::Midpoint { step } => step,
            Integrator::DormandPrince { .. } => self.duration,
        }
    }

    fn check(&self, model: &Model, theta: &[f64], dtheta: &[f64]) -> Result<Stepper, Error> {
        model.check_configuration(theta)?;
        model.check_lengths(theta, [("dtheta", dtheta)])?;
        for (what, values) in [("theta", theta), ("dtheta", dtheta)] {
            check(values.iter().all(|x| x.is_finite()), what, format!("{values:?}"), "finite numbers")?;
        }
        let fine = self.duration >= 0.0 && self.duration.is_finite();
        check(fine, "duration", self.duration, "a finite number of seconds, at least 0")?;
        let fine = self.record > 0.0 || self.duration == 0.0;
        check(fine, "the time between two rows", self.record, "a positive number of seconds")?;
        let positive = |what, x: f64| check(x > 0.0 && x.is_finite(), what, x, "a positive, finite number");
        if let Friction::Smooth { slip_speed } = self.friction {
            positive("slip_speed", slip_speed)?;
        }
        match self.integrator {
            Integrator::Fixed(method, step) => positive("step", step).map(|()| Stepper::Fixed(method, step)),
            Integrator::Midpoint { step } => {
                positive("step", step).map(|()| Stepper::Midpoint(Box::new(Midpoint::new(model, step))))
            }
            Integrator::DormandPrince { tolerance } => {
                positive("tolerance", tolerance)?;
                Ok(Stepper::DormandPrince(Box::new(DormandPrince::new(model.n(), model.nq(), tolerance))))
            }
        }
    }
}

impl Stepper {
    fn restart(&mut self) {
        if let Stepper::Midpoint(method) = self {
            method.restart();
        }
    }
}

fn record<I: Input>(motion: &mut Trajectory, state: &State, driven: &mut Driven<I>) {
    let energy = driven.energy(state);
    let State { t, theta, dtheta, ddtheta, .. } = state;
    motion.record(Sample { t: *t, theta, dtheta, ddtheta, tau: driven.tau(), energy });
}
