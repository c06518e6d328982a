//! Steps with dry friction, contacts and stops.

use crate::Error;
use crate::contacts::ContactEvent;
use crate::course::{Course, Integrator};
use crate::impulses::{Impulses, Key};
use crate::methods::moreau::Phase;
use alloc::vec::Vec;

/// At most this many events of contacts are recorded.
const MOST_EVENTS: usize = 10_000;

impl Course<'_> {
    /// θ̈ and the contact forces at the start: those of a first step that does not count.
    pub(crate) fn start_impulses(&mut self) -> Result<(), Error> {
        if self.impulses.is_none() || self.options.duration == 0.0 {
            return Ok(());
        }
        let start = self.motion.clone();
        self.impulses_over(self.options.step())?;
        let mean: Vec<f64> = self.motion.ddtheta.clone();
        self.motion = start;
        self.motion.ddtheta.copy_from_slice(&mean);
        if let Some(impulses) = &mut self.impulses {
            impulses.forget();
        }
        let crate::Motion { t, theta, dtheta, .. } = &self.motion;
        self.driven.equation.find_tau(*t, theta, dtheta)
    }

    /// A step of h seconds, which ends at a time.
    pub(crate) fn impulse_step(&mut self, h: f64, end: f64) -> Result<(), Error> {
        self.impulses_over(h)?;
        self.motion.t = end;
        let Some(impulses) = &mut self.impulses else { return Ok(()) };
        for (k, side) in impulses.memory.struck.drain(..) {
            self.stops.note_impulse(end, k, side);
        }
        let mut changes = core::mem::take(&mut impulses.memory.changes);
        changes.sort_by_key(|&(key, _)| key);
        for (key, change) in changes {
            let Key::Contact(point, plane) = key else { continue };
            if self.ending.contact_events.len() < MOST_EVENTS {
                let contact = impulses.contacts.name(point, plane);
                self.ending.contact_events.push(ContactEvent { t: end, contact, change });
            }
        }
        Ok(())
    }

    /// h seconds on. θ̈ becomes the mean acceleration.
    fn impulses_over(&mut self, h: f64) -> Result<(), Error> {
        let Course { impulses: Some(impulses), driven, motion, integrator, .. } = self else { return Ok(()) };
        let Integrator::MoreauJean(method) = integrator else { return Ok(()) };
        let (theta, dtheta) = (motion.theta.clone(), motion.dtheta.clone());
        let mut phase = Phase { t: motion.t, theta, dtheta, works: motion.integrals };
        impulses.forces.clear();
        method.step(driven, impulses, &mut phase, h)?;
        impulses.end_step(h);
        for (rate, (after, before)) in motion.ddtheta.iter_mut().zip(phase.dtheta.iter().zip(&motion.dtheta)) {
            *rate = (after - before) / h;
        }
        motion.theta.copy_from_slice(&phase.theta);
        motion.dtheta.copy_from_slice(&phase.dtheta);
        motion.integrals = phase.works;
        Ok(())
    }
}

impl Impulses<'_> {
    /// After a step that does not count: its forces are the guess of the first that does.
    fn forget(&mut self) {
        self.account = crate::OneSidedAccount::default();
        self.memory = core::mem::take(&mut self.memory).guess();
    }
}
