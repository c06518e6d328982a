//! Steps with dry friction, contacts and stops.

use super::Explicit;
use super::contact::{ContactChange, ContactEvent};
use super::course::{Course, Integrator};
use super::driven::Driven;
use super::impulses::{Choice, Impulses, Key, System};
use super::moreau::Phase;
use super::state::State;
use crate::kinematics::{difference, integrate};
use crate::model::Error;
use alloc::vec;
use alloc::vec::Vec;
use nalgebra::DVector;

/// Steps of another method than Moreau and Jean's are repeated at most this often, until the impulses agree.
const ROUNDS: usize = 8;
/// At most this many events of contacts are recorded.
const MOST_EVENTS: usize = 10_000;
/// Impulses agree if the velocities that they produce differ by this much, relative to 1 + the largest.
const AGREES: f64 = 1e-14;

impl Course<'_> {
    /// θ̈ and the contact forces at the start: those of a first step that does not count.
    pub(super) fn start_impulses(&mut self) -> Result<(), Error> {
        if self.driven.modes.is_some() {
            let mut state = State::of(&self.motion);
            self.switch(&mut state)?;
            state.copy_to(&mut self.motion);
        }
        if self.impulses.is_none() || self.options.duration == 0.0 {
            return Ok(());
        }
        let (start, step) = (self.motion.clone(), self.options.step());
        self.free_step(step, step)?;
        let mean: Vec<f64> = self.motion.ddtheta.clone();
        self.motion = start;
        self.motion.ddtheta.copy_from_slice(&mean);
        if let Some(impulses) = &mut self.impulses {
            impulses.forget();
        }
        let super::Motion { t, theta, dtheta, .. } = &self.motion;
        self.driven.equation.find_tau(*t, theta, dtheta)
    }

    /// Jumps of velocities and new modes, at an event.
    pub(super) fn switch(&mut self, state: &mut State) -> Result<(), Error> {
        self.driven.switch(state)?;
        let Some(modes) = &mut self.driven.modes else { return Ok(()) };
        for (k, side) in modes.impulses.struck.drain(..) {
            self.stops.note_impulse(state.t, k, side);
        }
        self.note_contacts(state.t);
        Ok(())
    }

    /// Records which contacts have begun or ceased to carry or to slide.
    fn note_contacts(&mut self, t: f64) {
        let modes = self.driven.modes.as_ref().map(|modes| &modes.impulses);
        let Some(impulses) = self.impulses.as_deref().or(modes) else { return };
        let mut now: Vec<(Key, bool)> = Vec::new();
        now.extend(impulses.carrying.iter().filter(|(key, _)| matches!(key, Key::Contact(..))));
        if now == self.touching {
            return;
        }
        let state = |list: &[(Key, bool)], key: Key| list.iter().find(|(other, _)| *other == key).map(|(_, s)| *s);
        let mut keys: Vec<Key> = now.iter().chain(&self.touching).map(|(key, _)| *key).collect();
        keys.sort_unstable();
        keys.dedup();
        for key in keys {
            let change = match (state(&self.touching, key), state(&now, key)) {
                (None, Some(_)) => ContactChange::TouchDown,
                (Some(_), None) => ContactChange::LiftOff,
                (Some(false), Some(true)) => ContactChange::Sticks,
                (Some(true), Some(false)) => ContactChange::Slides,
                _ => continue,
            };
            let Key::Contact(point, plane) = key else { continue };
            let contact = impulses.contacts.name(point, plane);
            if self.ending.contact_events.len() < MOST_EVENTS {
                self.ending.contact_events.push(ContactEvent { t, contact, change });
            }
        }
        self.touching = now;
    }

    /// The account of one-sided forces.
    pub(super) fn account(&self) -> Option<super::OneSidedAccount> {
        let modes = self.driven.modes.as_ref().map(|modes| modes.impulses.account);
        self.impulses.as_ref().map(|impulses| impulses.account).or(modes)
    }

    /// A step of h seconds, which ends at a time.
    pub(super) fn impulse_step(&mut self, h: f64, end: f64) -> Result<(), Error> {
        self.free_step(h, end)?;
        self.motion.t = end;
        let Some(impulses) = &mut self.impulses else { return Ok(()) };
        impulses.correct(end, &mut self.motion.theta, h)?;
        for (k, side) in impulses.struck.drain(..) {
            self.stops.note_impulse(end, k, side);
        }
        self.note_contacts(end);
        self.close()
    }

    /// The step without its correction of positions. θ̈ becomes the mean acceleration.
    fn free_step(&mut self, h: f64, end: f64) -> Result<(), Error> {
        let before = self.motion.dtheta.clone();
        let Course { impulses: Some(impulses), driven, motion, integrator, .. } = self else { return Ok(()) };
        if let Integrator::MoreauJean(method) = integrator {
            let mut phase = Phase {
                t: motion.t,
                theta: motion.theta.clone(),
                dtheta: motion.dtheta.clone(),
                works: motion.integrals,
            };
            method.step(&mut driven.equation, impulses, &mut phase, h)?;
            motion.theta.copy_from_slice(&phase.theta);
            motion.dtheta.copy_from_slice(&phase.dtheta);
            motion.integrals = phase.works;
        } else {
            self.step_with_constant_forces(h, end)?;
        }
        for (rate, (after, before)) in self.motion.ddtheta.iter_mut().zip(self.motion.dtheta.iter().zip(&before)) {
            *rate = (after - before) / h;
        }
        Ok(())
    }

    /// A step of another method, in which −Jᵀp/Δt acts as a constant force. It is repeated until the velocities at its
    /// end satisfy the laws; order 1.
    fn step_with_constant_forces(&mut self, h: f64, end: f64) -> Result<(), Error> {
        let Course { impulses: Some(impulses), driven, motion, integrator, .. } = self else { return Ok(()) };
        let (model, start) = (driven.model, motion.clone());
        let mut theta = start.theta.clone();
        integrate(model, &mut theta, &start.dtheta, 0.5 * h);
        let mut system = impulses.system(start.t + 0.5 * h, &theta, h, &vec![0.0; model.n()], Choice::Near(&[]))?;
        let before = impulses.relative_at(&system, start.t, &start.theta, &start.dtheta);
        let mut p = impulses.guess(&system, h);
        for round in 1..=ROUNDS {
            (0..model.constraint_rows()).for_each(|r| p[r] = 0.0); // forward dynamics finds their forces
            push(driven, &system, &p, h);
            motion.clone_from(&start);
            motion.find_rates(|t, q, dq, ddq| driven.evaluate(t, q, dq, ddq))?;
            match integrator {
                Integrator::Explicit(method) => {
                    motion.advance(*method, h, end, |t, q, dq, ddq| driven.evaluate(t, q, dq, ddq))?;
                }
                Integrator::Midpoint(method) => {
                    method.restart();
                    method.step(&State::of(motion), h, end, driven)?.copy_to(motion);
                }
                Integrator::DormandPrince(_) | Integrator::MoreauJean(_) => {}
            }
            let b = impulses.relative_at(&system, end, &motion.theta, &motion.dtheta) - &system.G * &p;
            let solved = impulses.solve(&mut system, b, &before, &p);
            let change = &solved.p - &p;
            let size = if change.is_empty() { 0.0 } else { (&system.G * &change).amax() };
            impulses.apply(&system, &change, &mut motion.dtheta);
            p.copy_from(&solved.p);
            if size <= AGREES * (1.0 + before.iter().fold(0.0_f64, |most, x| most.max(x.abs()))) || round == ROUNDS {
                let works = match integrator {
                    Integrator::Explicit(Explicit::RungeKutta4) | Integrator::Midpoint(_) => {
                        // a constant force, along the way
                        let mut way = vec![0.0; model.n()];
                        difference(model, &start.theta, &motion.theta, &mut way);
                        let given = solved.p.dot(&system.w);
                        [solved.p.dot(&(&system.J * DVector::from_vec(way))) / h - given, given]
                    }
                    _ => solved.works(&system, &before),
                };
                motion.integrals[1] += works[0];
                motion.integrals[2] += works[1];
                impulses.keep(&system, &solved, h);
                break;
            }
        }
        Ok(())
    }
}

/// Sets the constant forces of a step.
fn push(driven: &mut Driven, system: &System, p: &DVector<f64>, h: f64) {
    let force = system.J.tr_mul(p);
    driven.equation.extra.iter_mut().zip(force.iter()).for_each(|(extra, force)| *extra = -force / h);
}

impl Impulses<'_> {
    /// After a step that does not count.
    fn forget(&mut self) {
        self.account = super::OneSidedAccount::default();
        self.struck.clear();
    }
}
