//! The simulation loop: steps, events and stops within them, and recorded rows.

use crate::Error;
use crate::contacts::{ContactForce, Contacts};
use crate::drift::Drift;
use crate::driven::Driven;
use crate::events::stops::Stops;
use crate::events::{Event, Occurrence, first_zero, parts};
use crate::impulses::Impulses;
use crate::methods::dense::Dense;
use crate::methods::dormand_prince::DormandPrince;
use crate::methods::midpoint::Midpoint;
use crate::methods::moreau::Moreau;
use crate::options::check;
use crate::stall::{Stall, Trouble};
use crate::state::State;
use crate::{Ending, Equation, Explicit, Friction, Input, Method, Motion, Options, Recorder, Sample, Simulation};
use alloc::boxed::Box;
use alloc::format;
use alloc::vec::Vec;
use core::ops::ControlFlow;
use mozzi::model::Model;

/// The integrator, with its memory.
pub(crate) enum Integrator {
    Explicit(Explicit),
    DormandPrince(Box<DormandPrince>),
    Midpoint(Box<Midpoint>),
    MoreauJean(Box<Moreau>),
}

impl Integrator {
    fn new(method: Method, model: &Model) -> Result<Self, Error> {
        Ok(match method {
            Method::DormandPrince { tolerance } => {
                Integrator::DormandPrince(Box::new(DormandPrince::new(model.n(), model.nq(), tolerance)))
            }
            Method::Midpoint => Integrator::Midpoint(Box::new(Midpoint::new(model))),
            Method::MoreauJean => Integrator::MoreauJean(Box::new(Moreau::new(model))),
            method => Integrator::Explicit(method.explicit()?),
        })
    }

    /// The causes of short steps, if the method knows them.
    fn trouble(&mut self) -> Option<&mut Trouble> {
        if let Integrator::DormandPrince(method) = self { Some(&mut method.trouble) } else { None }
    }

    /// Restarts the method after the state was changed from outside.
    fn restart(&mut self) {
        if let Integrator::Midpoint(method) = self {
            method.restart();
        }
    }
}

/// A running simulation.
pub(crate) struct Course<'r> {
    pub(crate) options: Options,
    events: &'r [Event<'r>],
    pub(crate) integrator: Integrator,
    pub driven: Driven<'r>,
    /// Dry friction, contacts, and stops next to them.
    pub impulses: Option<Box<Impulses<'r>>>,
    pub stops: Stops,
    stall: Stall,
    pub(crate) motion: Motion<f64, 3>,
    /// The state at the beginning of the step; kept only if something may happen within it.
    pub(crate) from: State,
    /// True if events, stops or rows can lie within a step.
    is_watched: bool,
    /// The step number of the next row, if steps are watched.
    next: usize,
    recorder: &'r mut dyn Recorder,
    drift: Option<Drift>,
    /// True once the recorder has ended the simulation.
    is_closed: bool,
    pub ending: Ending,
}

impl<'r> Course<'r> {
    pub fn new(
        simulation: &'r Simulation<'_>,
        model: &'r Model,
        [theta, dtheta]: [&[f64]; 2],
        input: &'r mut (dyn Input + 'r),
        recorder: &'r mut dyn Recorder,
    ) -> Result<Self, Error> {
        let mut options = simulation.options;
        model.check_lengths(theta, [("dtheta", dtheta)])?;
        for (what, values) in [("theta", theta), ("dtheta", dtheta)] {
            let finite = values.iter().all(|x| x.is_finite());
            check(finite, what, format!("{values:?}"), "finite numbers")?;
        }
        options.check()?;
        let contacts = &simulation.contacts;
        let is_forced = options.method == Method::MoreauJean;
        let impulses = Impulses::new(model, contacts, &options, is_forced)?;
        options.method = options.method.resolved(impulses.is_some());
        let impulses = impulses.filter(|_| options.method == Method::MoreauJean).map(Box::new);
        if impulses.is_none() {
            refuse_one_sided(model, contacts, &options)?;
        }
        let equation = Equation::new(model, input, &options).with_forward_dynamics(simulation.forward_dynamics)?;
        let mut driven = Driven::new(equation);
        let has_impulses = impulses.is_some();
        driven.equation.has_impulses = has_impulses;
        let (mut theta, mut dtheta) = (theta.to_vec(), dtheta.to_vec());
        driven.close_start(&mut theta, &mut dtheta)?;
        let (theta, dtheta) = (&theta[..], &dtheta[..]);
        contacts.check_start(model, theta)?;
        let integrator = Integrator::new(options.method, model)?;
        let stops = Stops::new(model, options.joint_limits, theta, has_impulses)?;
        let motion = Motion::start(model.configuration_space(), 0.0, theta, dtheta, |t, q, dq, ddq| {
            driven.evaluate(t, q, dq, ddq)
        })?;
        let takes_equal_steps = match &integrator {
            Integrator::Explicit(_) | Integrator::MoreauJean(_) => true,
            Integrator::Midpoint(_) | Integrator::DormandPrince(_) => false,
        };
        let mut course = Course {
            is_watched: !takes_equal_steps || !simulation.events.is_empty() || stops.are_missed(),
            ending: Ending::new(options.method),
            options,
            events: &simulation.events,
            integrator,
            driven,
            impulses,
            stops,
            stall: Stall::new(&options),
            from: State::of(&motion),
            motion,
            next: options.record_every,
            recorder,
            drift: Drift::of(model, options.method),
            is_closed: false,
        };
        course.start_impulses()?;
        Ok(course)
    }

    pub fn run(&mut self, progress: &mut dyn FnMut(f64) -> ControlFlow<()>) -> Result<(), Error> {
        let Options { steps, duration, .. } = self.options;
        self.stops.report_at(0.0, &self.motion.theta);
        self.record();
        if duration == 0.0 {
            self.ending.complete = true;
            return Ok(());
        }
        let mut over = false;
        while !over && !self.is_closed {
            let done = self.ending.steps + 1;
            let is_due = if self.is_watched {
                over = self.watched_step(done)?;
                self.is_near_next()
            } else {
                self.plain_step(done)?;
                self.options.is_recorded(done)
            };
            let t = self.motion.t;
            self.stops.report_at(t, &self.motion.theta);
            self.ending.complete = if self.is_watched { t >= duration } else { done == steps };
            over |= progress(t).is_break() | self.ending.complete;
            if (is_due || over) && !self.is_closed {
                if self.is_watched {
                    self.complete()?; // τ is that of the row
                    self.next += self.options.record_every;
                }
                self.record();
            }
        }
        let check = |drift: &Drift| drift.check(self.driven.model, self.motion.t, self.options.step());
        self.drift.as_ref().map_or(Ok(()), check)
    }

    /// Nothing can happen within a step: steps of equal length, which end at their own times.
    fn plain_step(&mut self, done: usize) -> Result<(), Error> {
        let (h, end) = (self.options.step(), self.options.time(done));
        self.driven.at_step(done, h);
        if self.impulses.is_some() {
            self.impulse_step(h, end)?;
            if self.options.is_recorded(done) {
                self.complete()?;
            }
            self.ending.steps = done;
            return Ok(());
        }
        if let Integrator::Explicit(method) = self.integrator {
            let driven = &mut self.driven;
            self.motion.advance(method, h, end, |t, q, dq, ddq| driven.evaluate(t, q, dq, ddq))?;
            self.close()?;
            self.complete()?;
        }
        self.ending.steps = done;
        Ok(())
    }

    /// Takes a step up to the next event or stop, and records the rows before it. True if the simulation ends there.
    fn watched_step(&mut self, done: usize) -> Result<bool, Error> {
        let Options { duration, method, .. } = self.options;
        let (model, step) = (self.driven.model, self.options.step());
        self.from.copy_from(&self.motion);
        self.driven.at_step(done, if method.is_adaptive() { duration } else { step });
        self.ending.steps = done;
        let dense = self.step(step)?;
        let reached = self.motion.t;
        let stop = if self.stops.are_missed() { self.stops.acts(model, &dense, reached, method) } else { None };
        let mut end = stop.as_ref().map_or(reached, |(t, _)| *t);
        let over = self.events_until(&dense, &mut end);
        self.rows_until(&dense, end)?;
        if let (Some((_, error)), false) = (stop, over) {
            return Err(error);
        }
        if end < reached {
            let mut there = dense.at(model, end);
            there.ddtheta.copy_from_slice(&self.motion.ddtheta);
            there.copy_to(&mut self.motion);
            self.close()?;
            self.complete()?;
        }
        self.stall.check(model, self.motion.t, self.integrator.trouble())?;
        if end != dense.t + dense.h {
            self.integrator.restart();
        }
        Ok(over)
    }

    /// A whole step, with its dense output.
    fn step(&mut self, step: f64) -> Result<Dense, Error> {
        let Course { options: Options { duration, .. }, integrator, driven, motion, from, .. } = self;
        let (h, end) = step_to(step, from.t, *duration);
        if self.impulses.is_some() {
            self.impulse_step(h, end)?;
            // the powers are those of the step as a whole
            let (mut from, mut to) = (self.from.clone(), State::of(&self.motion));
            from.powers = core::array::from_fn(|k| (to.works[k] - from.works[k]) / (to.t - from.t));
            to.powers = from.powers;
            return Ok(Dense::hermite(self.driven.model, &from, &to));
        }
        match integrator {
            Integrator::MoreauJean(_) => {} // which always has impulses
            Integrator::Explicit(method) => {
                motion.advance(*method, h, end, |t, q, dq, ddq| driven.evaluate(t, q, dq, ddq))?;
                self.close()?;
                self.complete()?;
            }
            Integrator::Midpoint(method) => {
                method.step(from, h, end, driven)?.copy_to(motion);
            }
            Integrator::DormandPrince(method) => {
                let (to, dense) = method.step(from, *duration, driven)?;
                to.copy_to(motion);
                self.close_again()?;
                return Ok(dense);
            }
        }
        let Course { driven, motion, from, .. } = self;
        Ok(Dense::hermite(driven.model, from, &State::of(motion)))
    }

    /// Records the events within the step. If one of them ends the simulation, `end` becomes its time and the result is
    /// true.
    pub(crate) fn events_until(&mut self, dense: &Dense, end: &mut f64) -> bool {
        let model = self.driven.model;
        let parts = if self.events.is_empty() { return false } else { parts(model, dense, *end) };
        let mut found = Vec::new();
        for (k, event) in self.events.iter().enumerate() {
            let f = |state: &State| (event.function)(state.t, &state.theta, &state.dtheta);
            found.extend(first_zero(model, dense, &parts, event.direction, f).map(|t| (t, k)));
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (t, k) in found {
            let State { theta, dtheta, .. } = dense.at(model, t);
            let Event { name, stop, .. } = &self.events[k];
            self.ending.events.push(Occurrence { name: name.clone(), t, theta, dtheta, stop: *stop });
            if *stop {
                *end = t;
                return true;
            }
        }
        false
    }

    /// Records the rows before `end`, up to which the step counts.
    pub(crate) fn rows_until(&mut self, dense: &Dense, end: f64) -> Result<(), Error> {
        let end = end - self.tolerance();
        while !self.is_closed && self.next < self.options.steps && self.options.time(self.next) < end {
            let mut row = dense.at(self.driven.model, self.options.time(self.next));
            self.driven.close(row.t, &mut row.theta, &mut row.dtheta)?;
            self.stops.report_at(row.t, &row.theta); // adaptive steps go to a limit and back
            match &self.impulses {
                Some(_) => {
                    row.ddtheta.copy_from_slice(&self.motion.ddtheta);
                    self.driven.equation.find_tau(row.t, &row.theta, &row.dtheta)?;
                }
                None => self.driven.complete(&mut row)?,
            }
            self.next += self.options.record_every;
            let energy = self.driven.energy(&row.theta, &row.dtheta, row.works);
            let State { t, theta, dtheta, ddtheta, .. } = &row;
            let contact_forces = forces(&self.impulses);
            let row = Sample { t: *t, theta, dtheta, ddtheta, tau: self.driven.tau(), energy, contact_forces };
            self.is_closed = self.recorder.take(&row).is_break();
            self.drift.iter_mut().for_each(|drift| drift.add(&row));
        }
        Ok(())
    }

    /// Times closer than this are equal.
    fn tolerance(&self) -> f64 {
        1e-12 * self.options.duration
    }

    /// True if the step ends at the time of the next row, within the tolerance.
    fn is_near_next(&self) -> bool {
        let next = self.options.time(self.next.min(self.options.steps));
        (next - self.motion.t).abs() <= self.tolerance()
    }

    /// Brings the state back onto the constraints.
    pub(crate) fn close(&mut self) -> Result<(), Error> {
        let Motion { t, theta, dtheta, .. } = &mut self.motion;
        self.driven.close(*t, theta, dtheta)
    }

    /// As [`close`](Self::close), for a state whose rates are known: computes them again and restarts the integrator.
    fn close_again(&mut self) -> Result<(), Error> {
        if !self.driven.has_constraints() {
            return Ok(());
        }
        self.close()?;
        self.complete()?;
        self.integrator.restart();
        Ok(())
    }

    /// Fills in θ̈ and the powers.
    fn complete(&mut self) -> Result<(), Error> {
        let Motion { t, theta, dtheta, ddtheta, rates, .. } = &mut self.motion;
        if self.impulses.is_some() {
            return self.driven.equation.find_tau(*t, theta, dtheta); // θ̈ is the mean of the step
        }
        *rates = self.driven.evaluate(*t, theta, dtheta, ddtheta)?;
        Ok(())
    }

    /// The state as a row.
    fn record(&mut self) {
        let Motion { t, theta, dtheta, ddtheta, integrals, .. } = &self.motion;
        let energy = self.driven.energy(theta, dtheta, *integrals);
        let contact_forces = forces(&self.impulses);
        let row = Sample { t: *t, theta, dtheta, ddtheta, tau: self.driven.tau(), energy, contact_forces };
        self.is_closed = self.recorder.take(&row).is_break();
        self.drift.iter_mut().for_each(|drift| drift.add(&row));
    }
}

/// The contact forces.
fn forces<'a>(impulses: &'a Option<Box<Impulses>>) -> &'a [ContactForce] {
    impulses.as_ref().map_or(&[], |impulses| &impulses.forces)
}

/// A smooth method has no dry friction and no contacts.
fn refuse_one_sided(model: &Model, contacts: &Contacts, options: &Options) -> Result<(), Error> {
    let is_dry = |j: &usize| options.friction == Friction::Coulomb && model.friction()[*j] > 0.0;
    let joint = (0..model.n()).find(is_dry).and_then(|j| model.velocity_names().nth(j));
    let (what, remedy) = match joint {
        Some(joint) => {
            (format!("dry friction of `{joint}`"), "`moreau` or `auto` for dry friction, or friction that is smooth")
        }
        None => (format!("{} contact points", contacts.points.len()), "`moreau` or `auto` for contacts"),
    };
    let found = || format!("{}, which cannot compute the robot's {what}", options.method.name());
    if joint.is_none() && contacts.is_empty() { Ok(()) } else { check(false, "the method", found(), remedy) }
}

/// A step from t, and its end: the full length, or to `until` if at most a rounding error would be left for a last
/// step.
pub(crate) fn step_to(step: f64, t: f64, until: f64) -> (f64, f64) {
    if t + 1.001 * step >= until { (until - t, until) } else { (step, t + step) }
}
