//! Stops: the joints' position limits along a motion.

use super::Policy;
use super::dense::Dense;
use super::driven::Driven;
use super::events::{Direction, first_zero, parts};
use super::held::Held;
use super::options::check;
use super::state::State;
use crate::model::{Bounds, Error, Freedom, Model, Place};
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec;
use alloc::vec::Vec;
use core::f64::consts::PI;

/// A joint that reached a position limit.
#[derive(Clone, Debug, PartialEq)]
pub struct Stopped {
    /// The joint.
    pub joint: String,
    /// Its limit, rad or m.
    pub limit: f64,
    /// When it first reached the limit, s.
    pub first: f64,
    /// The largest excess beyond the limit, rad or m: 0 if limits are respected.
    pub beyond: f64,
    /// How often it reached the limit.
    pub times: usize,
}

/// The state of the joints' limits along a motion.
pub(super) struct Stops {
    policy: Policy,
    /// Do the steps stop the joints themselves, by impulses?
    by_impulses: bool,
    bounds: Bounds,
    /// Joint and side, lower (0) or upper (1), of every limit that can be reached.
    sides: Vec<(usize, usize)>,
    names: Vec<String>,
    /// Lower and upper, joint by joint.
    noted: Vec<[Option<Stopped>; 2]>,
    /// Is the joint beyond it now?
    beyond: Vec<[bool; 2]>,
}

impl Stops {
    pub fn new(model: &Model, policy: Policy, start: &[f64], by_impulses: bool) -> Result<Self, Error> {
        let bounds = Bounds::of(model);
        let names: Vec<String> = model.joint_names().map(ToString::to_string).collect();
        for ((k, &[low, high]), name) in bounds.joints.iter().enumerate().zip(&names) {
            let q = bounds.value(start, k);
            let is_ball = bounds.places[k].freedom == Freedom::Ball;
            check(
                policy != Policy::Respect || !is_ball || high > 0.0,
                "limits to respect",
                format!("that of `{name}`, a ball that may not turn at all"),
                "an angle above 0, or a fixed joint",
            )?;
            // a quaternion gives the angle to rounding only
            let rounding = if is_ball { 1e-12 } else { 0.0 };
            let fine = policy != Policy::Respect || (low..=high + rounding).contains(&q);
            check(
                fine,
                "the start",
                format!("{q} of joint `{name}`, beyond its limits {low} … {high}"),
                "joints within their limits, which are respected",
            )?;
        }
        Ok(Stops {
            policy,
            by_impulses,
            noted: vec![[None, None]; names.len()],
            beyond: vec![[false; 2]; names.len()],
            sides: sides(&bounds),
            bounds,
            names,
        })
    }

    /// In the order of time.
    pub fn noted(self) -> Vec<Stopped> {
        let mut all: Vec<Stopped> = self.noted.into_iter().flatten().flatten().collect();
        all.sort_by(|a, b| a.first.total_cmp(&b.first));
        all
    }

    /// Are joints stopped at the times at which they reach their limits?
    pub fn are_located(&self) -> bool {
        self.policy == Policy::Respect && !self.by_impulses
    }

    /// Records a joint that an impulse stopped.
    pub fn note_impulse(&mut self, t: f64, k: usize, side: usize) {
        self.note(t, k, side, 0.0, true);
    }

    /// How far joint k is beyond its lower (0) or upper (1) bound.
    fn excess(&self, theta: &[f64], k: usize, side: usize) -> f64 {
        let ([low, high], q) = (self.bounds.joints[k], self.bounds.value(theta, k));
        if side == 0 { low - q } else { q - high }
    }

    /// As [`excess`](Self::excess), along a motion from θ₀: a ball's angle continues beyond π, so that it does not
    /// re-enter its limit from the other side.
    fn excess_from(&self, from: &[f64], theta: &[f64], k: usize, side: usize) -> f64 {
        let (Place { freedom, q, .. }, excess) = (self.bounds.places[k], self.excess(theta, k, side));
        if freedom == Freedom::Ball && from[q] * theta[q] < 0.0 {
            let [_, limit] = self.bounds.joints[k];
            return 2.0 * (PI - limit) - excess; // 2π − ‖φ‖ − limit
        }
        excess
    }

    fn note(&mut self, t: f64, k: usize, side: usize, beyond: f64, again: bool) {
        let (joint, limit) = (self.names[k].clone(), self.bounds.joints[k][side]);
        let first = Stopped { joint, limit, first: t, beyond, times: 0 };
        let note = self.noted[k][side].get_or_insert(first);
        note.beyond = note.beyond.max(beyond);
        note.times += usize::from(again);
    }

    /// Records joints beyond their limits; states come in the order of time.
    pub fn report_at(&mut self, t: f64, theta: &[f64]) {
        if self.policy != Policy::Report {
            return;
        }
        for i in 0..self.sides.len() {
            let (k, side) = self.sides[i];
            let excess = self.excess(theta, k, side);
            if excess > 0.0 {
                let again = !self.beyond[k][side];
                self.note(t, k, side, excess, again);
            }
            self.beyond[k][side] = excess > 0.0;
        }
    }

    /// The first time within the step, up to `until`, at which a joint that is not held reaches a stop.
    pub fn first_impact(&self, model: &Model, dense: &Dense, until: f64, held: &[Held]) -> Option<(f64, usize, usize)> {
        let parts = parts(model, dense, until);
        let from = &parts[0].theta;
        let free = self.sides.iter().copied().filter(|&(k, _)| !is_held(self.bounds.places[k], held));
        let impacts = free.filter_map(|(k, side)| {
            let excess = |state: &State| self.excess_from(from, &state.theta, k, side);
            first_zero(model, dense, &parts, Direction::Rising, excess).map(|t| (t, k, side))
        });
        impacts.min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// The time within the step, after its beginning, from which a stop would have to pull; by bisection.
    pub fn first_release(&self, dense: &Dense, until: &State, driven: &mut Driven) -> Result<Option<f64>, Error> {
        if driven.pull(until)? <= 0.0 {
            return Ok(None);
        }
        let (mut a, mut b) = (dense.t, until.t);
        while b - a > 1e-14 * b.max(1e-3) && (a + b) * 0.5 > a && (a + b) * 0.5 < b {
            let middle = 0.5 * (a + b);
            *(if driven.pull(&dense.at(driven.model, middle))? > 0.0 { &mut b } else { &mut a }) = middle;
        }
        Ok(Some(b))
    }

    /// Stops the joints at a limit that move towards it, or are at rest and accelerate towards it: those that start
    /// there, those that arrive there at the same time as another, those that another stop releases.
    pub fn stop_at_limits(&mut self, state: &mut State, driven: &mut Driven) -> Result<(), Error> {
        for i in 0..self.sides.len() {
            let (k, side) = self.sides[i];
            let held = Held::new(&self.bounds, k, side);
            let rounding = if held.place.freedom == Freedom::Ball { 1e-12 } else { 0.0 };
            let is_there = self.excess(&state.theta, k, side) >= -rounding && !is_held(held.place, &driven.held);
            if is_there && held.along(&state.theta, &state.dtheta) * held.side >= 0.0 {
                self.stop(state, k, side, driven)?;
            }
        }
        Ok(())
    }

    /// Brings the joint to rest at its limit, without a rebound, together with all joints held at stops; the energy
    /// lost in the impact is counted as friction.
    pub fn stop(&mut self, state: &mut State, k: usize, side: usize, driven: &mut Driven) -> Result<(), Error> {
        let held = Held::new(&self.bounds, k, side);
        held.project(&mut state.theta);
        let comes = held.along(&state.theta, &state.dtheta) * held.side > 0.0;
        let before = driven.energy(&state.theta, &state.dtheta, state.works).kinetic;
        driven.held.push(held);
        driven.factor(&state.theta)?;
        driven.let_go(&state.theta, None, &state.dtheta.clone());
        driven.bring_to_rest(&state.theta, None, &mut state.dtheta);
        state.works[1] += before - driven.energy(&state.theta, &state.dtheta, state.works).kinetic;
        driven.complete(state)?;
        driven.release(state)?;
        if comes || is_held(held.place, &driven.held) {
            self.note(state.t, k, side, 0.0, true);
        }
        Ok(())
    }
}

/// The limits that can be reached; a ball's angle is from 0 to π.
pub(super) fn sides(bounds: &Bounds) -> Vec<(usize, usize)> {
    let all = (0..bounds.joints.len()).flat_map(|k| [(k, 0), (k, 1)]);
    let is_reachable = |&(k, side): &(usize, usize)| {
        let (limit, is_ball) = (bounds.joints[k][side], bounds.places[k].freedom == Freedom::Ball);
        limit.is_finite() && !(is_ball && (side == 0 || limit >= PI))
    };
    all.filter(is_reachable).collect()
}

fn is_held(place: Place, held: &[Held]) -> bool {
    held.iter().any(|held| held.place == place)
}
