//! Events: zeros of functions along a motion.

use super::dense::Dense;
use super::state::State;
use crate::model::{Bounds, Freedom, Model};
use alloc::boxed::Box;
use alloc::format;
use alloc::rc::Rc;
use alloc::string::String;
use alloc::vec::Vec;

/// Which zeros of an event's function count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// All.
    Any,
    /// From below 0 to above.
    Rising,
    /// From above 0 to below.
    Falling,
}

/// A function of (t, θ, θ̇) whose zeros are located. Two zeros within a quarter of a step can be missed.
pub struct Event<'a> {
    /// The name in the results.
    pub name: String,
    /// Which zeros count.
    pub direction: Direction,
    /// Does the simulation end there?
    pub stop: bool,
    /// The function.
    pub function: EventFunction<'a>,
}

/// Of (t, θ, θ̇).
pub type EventFunction<'a> = Box<dyn Fn(f64, &[f64], &[f64]) -> f64 + 'a>;

impl<'a> Event<'a> {
    /// All zeros of a function; the simulation goes on.
    pub fn new(name: impl Into<String>, function: impl Fn(f64, &[f64], &[f64]) -> f64 + 'a) -> Self {
        Event { name: name.into(), direction: Direction::Any, stop: false, function: Box::new(function) }
    }

    /// Events of joints that reach a position limit from within: one for each limit, called `lower limit of shoulder`.
    /// A mimic joint's limits also restrict its source joint.
    pub fn joint_limits(model: &Model) -> Vec<Self> {
        let all = Rc::new(Bounds::of(model));
        let mut events = Vec::new();
        for (k, (bounds, joint)) in all.joints.iter().zip(model.joint_names()).enumerate() {
            let is_ball = all.places[k].freedom == Freedom::Ball; // whose angle cannot be below 0
            for (limit, side, sign) in [(bounds[0], "lower", -1.0), (bounds[1], "upper", 1.0)] {
                if is_ball && side == "lower" {
                    continue;
                }
                let all = Rc::clone(&all);
                let beyond = move |_: f64, theta: &[f64], _: &[f64]| sign * (all.value(theta, k) - limit);
                let event = Event::new(format!("{side} limit of {joint}"), beyond);
                events.extend(limit.is_finite().then_some(Event { direction: Direction::Rising, ..event }));
            }
        }
        events
    }
}

/// An event that happened.
#[derive(Clone, Debug, PartialEq)]
pub struct Occurrence {
    /// The event's.
    pub name: String,
    /// Seconds.
    pub t: f64,
    /// θ there.
    pub theta: Vec<f64>,
    /// θ̇ there; if the joint comes to rest at its limit there, θ̇ before the impact.
    pub dtheta: Vec<f64>,
    /// Did the simulation end there?
    pub stop: bool,
}

/// Parts of a step at whose ends signs are compared.
const PARTS: usize = 4;

/// The states at the ends of the parts of a step up to `until`, for the zeros of any number of functions.
pub(super) fn parts(model: &Model, dense: &Dense, until: f64) -> [State; PARTS + 1] {
    let time = |k: usize| if k == PARTS { until } else { dense.t + (until - dense.t) * k as f64 / PARTS as f64 };
    core::array::from_fn(|k| dense.at(model, time(k)))
}

/// The first zero of f within [`parts`], after their beginning, with this direction: a time just after the sign change,
/// to rounding.
pub(super) fn first_zero(
    model: &Model,
    dense: &Dense,
    parts: &[State; PARTS + 1],
    direction: Direction,
    f: impl Fn(&State) -> f64,
) -> Option<f64> {
    let at = |t: f64| f(&dense.at(model, t));
    let mut before = (parts[0].t, f(&parts[0]));
    for part in &parts[1..] {
        let after = (part.t, f(part));
        let rises = before.1 < 0.0 && after.1 >= 0.0;
        let falls = before.1 > 0.0 && after.1 <= 0.0;
        if (rises && direction != Direction::Falling) || (falls && direction != Direction::Rising) {
            return Some(bisect(at, before, after));
        }
        before = after;
    }
    None
}

/// The Illinois method: chords, with a halved weight of the end that stays, which always bracket the zero.
pub(super) fn bisect(mut f: impl FnMut(f64) -> f64, mut a: (f64, f64), mut b: (f64, f64)) -> f64 {
    let side = |x: f64, rises: bool| if rises { x >= 0.0 } else { x <= 0.0 };
    let rises = a.1 < 0.0;
    for k in 0..200 {
        if b.0 - a.0 <= 4.0 * f64::EPSILON * b.0.abs() || a.1 == b.1 {
            break;
        }
        let chord = b.0 - b.1 * (b.0 - a.0) / (b.1 - a.1);
        // every third step bisects, so that a function that is not smooth converges, too
        let t = if k % 3 == 2 || !(chord > a.0 && chord < b.0) { 0.5 * (a.0 + b.0) } else { chord };
        let value = f(t);
        if side(value, rises) {
            b = (t, value);
            a.1 *= 0.5;
        } else {
            a = (t, value);
            b.1 *= 0.5;
        }
    }
    b.0
}
