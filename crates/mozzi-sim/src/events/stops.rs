//! Stops: the joints' position limits along a motion.

use crate::Error;
use crate::events::{Direction, first_zero, parts};
use crate::methods::dense::Dense;
use crate::options::check;
use crate::state::State;
use crate::{Method, Policy};
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec;
use alloc::vec::Vec;
use core::f64::consts::PI;
use mozzi::model::{Bounds, Freedom, Model, Place};

/// A joint that reached a position limit.
#[derive(Clone, Debug, PartialEq)]
pub struct Stopped {
    /// The joint.
    pub joint: String,
    /// Its limit, rad or m.
    pub limit: f64,
    /// When it first reached the limit, s.
    pub first: f64,
    /// The largest excess beyond the limit, rad or m: 0 if limits are respected, unless a stop did not hold.
    pub beyond: f64,
    /// How often it reached the limit.
    pub times: usize,
}

/// A start may be beyond a limit by this much, rad or m: a run that ended at a stop can go on from its last state.
pub(crate) const NEAR: f64 = 1e-5;

/// The state of the joints' limits along a motion.
pub(crate) struct Stops {
    policy: Policy,
    /// True if the method stops joints itself, by impulses.
    by_impulses: bool,
    bounds: Bounds,
    /// Joint and side, lower (0) or upper (1), of every limit that can be reached.
    sides: Vec<(usize, usize)>,
    names: Vec<String>,
    /// Lower and upper, joint by joint.
    noted: Vec<[Option<Stopped>; 2]>,
    /// True if the joint is beyond this limit now.
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
            let fine = policy != Policy::Respect || (low - NEAR..=high + NEAR).contains(&q);
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

    /// True if limits are respected and the method has no stops.
    pub fn are_missed(&self) -> bool {
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

    /// Records joints beyond their limits, and beyond stops that should have held them by more than a start may be;
    /// states come in the order of time.
    pub fn report_at(&mut self, t: f64, theta: &[f64]) {
        let (least, counts) = match self.policy {
            Policy::Ignore => return,
            Policy::Report => (0.0, true),
            Policy::Respect => (2.0 * NEAR, false), // impulses are counted
        };
        for i in 0..self.sides.len() {
            let (k, side) = self.sides[i];
            let excess = self.excess(theta, k, side);
            if excess > least {
                let again = counts && !self.beyond[k][side];
                self.note(t, k, side, excess, again);
            }
            self.beyond[k][side] = excess > least;
        }
    }

    /// The first time within the step, up to `until`, at which a joint would go beyond its limit, with joint and side.
    fn first_impact(&self, model: &Model, dense: &Dense, until: f64) -> Option<(f64, usize, usize)> {
        let parts = parts(model, dense, until);
        let from = &parts[0].theta;
        let impacts = self.sides.iter().filter_map(|&(k, side)| {
            let excess = |state: &State| self.excess_from(from, &state.theta, k, side);
            let rounding = 1e-12;
            // from the limit itself there is no zero to be found
            let leaves = excess(&parts[0]) >= 0.0 && parts[1..].iter().any(|part| excess(part) > rounding);
            let t = if leaves { Some(dense.t) } else { first_zero(model, dense, &parts, Direction::Rising, excess) };
            t.map(|t| (t, k, side))
        });
        impacts.min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// For a smooth method, which has no stops: the time within the step at which one would act, and the error.
    pub fn acts(&self, model: &Model, dense: &Dense, until: f64, method: Method) -> Option<(f64, Error)> {
        let (time, k, side) = self.first_impact(model, dense, until)?;
        let (joint, limit) = (self.names[k].clone(), self.bounds.joints[k][side]);
        Some((time, Error::StopActs { joint, limit, time, method: method.name() }))
    }
}

/// The limits that can be reached; a ball's angle is from 0 to π.
pub(crate) fn sides(bounds: &Bounds) -> Vec<(usize, usize)> {
    let all = (0..bounds.joints.len()).flat_map(|k| [(k, 0), (k, 1)]);
    let is_reachable = |&(k, side): &(usize, usize)| {
        let (limit, is_ball) = (bounds.joints[k][side], bounds.places[k].freedom == Freedom::Ball);
        limit.is_finite() && !(is_ball && (side == 0 || limit >= PI))
    };
    all.filter(is_reachable).collect()
}
