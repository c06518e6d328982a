//! Events that follow each other so closely that an adaptive method would hardly advance: modes that alternate, or
//! steps whose error no length makes small. A step of Moreau and Jean's method, for which events need not be separated,
//! goes across; while it does not help, the next one is twice as long, up to the time between two rows.

use super::course::{Course, Integrator, step_to};
use super::dense::Dense;
use super::driven::Driven;
use super::equation::Equation;
use super::modes::{Modes, REACH};
use super::moreau::Phase;
use super::state::State;
use super::{Input, Options, Powers};
use crate::model::Error;

/// What is counted is counted over this time, s.
const WINDOW: f64 = 1e-4;
/// Steps within a window, and those for each pair of a contact point and a plane.
const MOST: usize = 400;
const MOST_OF_PAIR: usize = 40;
/// An event counts as many steps.
const EVENT: usize = 10;
/// The first step across, s.
const SHORTEST: f64 = 1e-6;
/// After this many of its lengths without a crowd, a step across begins short again.
const CALM: f64 = 100.0;

#[derive(Clone, Debug)]
pub(super) struct Crowd {
    most: usize,
    longest: f64,
    /// When the window began, and what it counts.
    since: f64,
    count: usize,
    /// The length of the last step across, and its end.
    h: f64,
    end: f64,
}

impl Crowd {
    pub fn new(options: &Options, pairs: usize) -> Self {
        let longest = options.step().max(SHORTEST);
        Crowd { most: MOST + MOST_OF_PAIR * pairs, longest, since: 0.0, count: 0, h: 0.0, end: f64::NEG_INFINITY }
    }

    /// Counts a step that ends at a time, by an event or not. Is a step across needed?
    pub fn note(&mut self, t: f64, is_event: bool) -> bool {
        if t - self.since > WINDOW {
            (self.since, self.count) = (t, 0);
        }
        self.count += if is_event { EVENT } else { 1 };
        self.count > self.most
    }

    /// The length of a step across from a time.
    pub fn step(&mut self, t: f64) -> f64 {
        let is_calm = t - self.end > (CALM * self.h).max(WINDOW);
        self.h = if is_calm { SHORTEST } else { (2.0 * self.h).min(self.longest) };
        self.end = t + self.h;
        (self.since, self.count) = (self.end, 0);
        self.h
    }
}

impl Course<'_> {
    /// A step across events that follow each other too closely, from `from`. Does the simulation end there?
    pub(super) fn step_across(&mut self) -> Result<bool, Error> {
        let (model, duration) = (self.driven.model, self.options.duration);
        let mut state = self.from.clone();
        let (h, end) = step_to(self.crowd.step(state.t), state.t, duration);
        self.driven.step_across(&mut state, h)?;
        state.t = end;
        let dense = Dense::hermite(model, &self.from, &state);
        let mut end = end;
        let over = self.events_until(&dense, &mut end);
        self.rows_until(&dense, end)?;
        if over {
            state = dense.at(model, end);
        }
        self.driven.close(state.t, &mut state.theta, &mut state.dtheta)?;
        self.switch(&mut state)?;
        state.copy_to(&mut self.motion);
        if let Integrator::DormandPrince(method) = &mut self.integrator {
            method.restart(h);
        }
        Ok(over)
    }
}

impl<I: Input> Driven<'_, I> {
    /// A step of h seconds across events that cannot be separated. New modes are to be found at its end.
    pub fn step_across(&mut self, state: &mut State, h: f64) -> Result<(), Error> {
        let Some(mut modes) = self.modes.take() else { return Ok(()) };
        let result = modes.step_across(&mut self.equation, state, h);
        self.modes = Some(modes);
        result
    }
}

impl Modes<'_> {
    fn step_across<I: Input>(
        &mut self,
        equation: &mut Equation<'_, I>,
        state: &mut State,
        h: f64,
    ) -> Result<(), Error> {
        let mut phase =
            Phase { t: state.t, theta: state.theta.clone(), dtheta: state.dtheta.clone(), works: state.works };
        self.impulses.reach = (self.gravity * h * h).max(REACH);
        let result = self.moreau.step(equation, &mut self.impulses, &mut phase, h);
        self.impulses.reach = REACH;
        result?;
        self.impulses.correct(phase.t, &mut phase.theta, h)?;
        self.impulses.account.steps_across += 1;
        for (rate, (after, before)) in state.ddtheta.iter_mut().zip(phase.dtheta.iter().zip(&state.dtheta)) {
            *rate = (after - before) / h;
        }
        (state.t, state.works, state.powers) = (phase.t, phase.works, Powers::default());
        (state.theta, state.dtheta) = (phase.theta, phase.dtheta);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_across_grow_until_it_is_calm() {
        let mut crowd = Crowd::new(&Options::new(1.0, 1000), 0);
        let counts = |crowd: &mut Crowd, t: f64| (1..1000).find(|_| crowd.note(t, true)).expect("a crowd");
        assert_eq!(counts(&mut crowd, 0.5), MOST / EVENT + 1);
        let steps = [0.5, 0.500001, 0.500002, 0.500003].map(|t| crowd.step(t));
        assert_eq!(steps, [1e-6, 2e-6, 4e-6, 8e-6]);
        (0..20).for_each(|_| {
            crowd.step(0.6);
        });
        assert_eq!(crowd.step(0.6), 1e-3);
        assert_eq!(crowd.step(0.8), SHORTEST);
        // events that are spread out are no crowd
        assert!((0..1000).all(|k| !crowd.note(0.9 + 1e-5 * k as f64, true)));
    }
}
