//! Events: zeros of functions along a motion.

mod condition;
mod policy;
pub(crate) mod stops;

pub use policy::Policy;
pub use stops::Stopped;

use crate::methods::dense::Dense;
use crate::state::State;
use alloc::boxed::Box;
use alloc::format;
use alloc::rc::Rc;
use alloc::string::String;
use alloc::vec::Vec;
use mozzi::model::{Bounds, Freedom, Model};

/// Which zeros of an event's function count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// All zeros.
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
    /// True if the simulation ends at the event.
    pub stop: bool,
    /// The function. NaN has no sign: next to it no zero is found.
    pub function: EventFunction<'a>,
}

/// A function of t (s), θ and θ̇.
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
    /// True if the simulation ended there.
    pub stop: bool,
}

/// Parts of a step at whose ends signs are compared.
const PARTS: usize = 4;

/// The states at the ends of the parts of a step up to `until`, for the zeros of any number of functions.
pub(crate) fn parts(model: &Model, dense: &Dense, until: f64) -> [State; PARTS + 1] {
    let time = |k: usize| if k == PARTS { until } else { dense.t + (until - dense.t) * k as f64 / PARTS as f64 };
    core::array::from_fn(|k| dense.at(model, time(k)))
}

/// The first zero of f within [`parts`], after their beginning, with this direction: a time just after the sign change,
/// to rounding.
pub(crate) fn first_zero(
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

/// A zero of f between a and b, where f has different signs: to rounding, on the side of b.
pub(crate) fn bisect(f: impl FnMut(f64) -> f64, a: (f64, f64), b: (f64, f64)) -> f64 {
    bisect_until([0.0; 2], f, a, b)
}

/// As [`bisect`], until |f| < `enough` or the zero is known to `width`. Chandrupatla's method (1997): the parabola t(f)
/// through the last three points where it is monotonic, else bisection, so that jumps are found as well.
pub(crate) fn bisect_until(
    [enough, width]: [f64; 2],
    mut f: impl FnMut(f64) -> f64,
    a: (f64, f64),
    b: (f64, f64),
) -> f64 {
    let rises = a.1 < 0.0;
    let beyond = |value: f64| if rises { value >= 0.0 } else { value <= 0.0 };
    // the zero is between the newest point and `other`
    let (mut newest, mut other, mut part) = (b, a, b.1 / (b.1 - a.1));
    for _ in 0..200 {
        let least = width.max(4.0 * f64::EPSILON * newest.0.abs().max(other.0.abs())) / (newest.0 - other.0).abs();
        if least >= 1.0 {
            break;
        }
        let t = newest.0 + part.max(0.5 * least).min(1.0 - 0.5 * least) * (other.0 - newest.0);
        let value = f(t);
        if value.abs() < enough {
            return t;
        }
        let last = if beyond(value) == beyond(newest.1) { newest } else { other };
        if last == other {
            other = newest;
        }
        newest = (t, value);
        let xi = (newest.0 - other.0) / (last.0 - other.0);
        let phi = (newest.1 - other.1) / (last.1 - other.1);
        part = if phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi {
            let to_other = newest.1 / (other.1 - newest.1) * last.1 / (other.1 - last.1);
            let slope = (last.0 - newest.0) / (other.0 - newest.0);
            to_other + slope * newest.1 / (last.1 - newest.1) * other.1 / (last.1 - other.1)
        } else {
            0.5
        };
    }
    if beyond(newest.1) { newest.0 } else { other.0 }
}

#[cfg(test)]
mod tests {
    use super::bisect_until;

    /// The zero and the number of evaluations.
    fn zero(ends: [f64; 2], tolerances: [f64; 2], f: impl Fn(f64) -> f64) -> (f64, usize) {
        let (mut count, [a, b]) = (0, ends);
        let counted = |t: f64| {
            count += 1;
            f(t)
        };
        (bisect_until(tolerances, counted, (a, f(a)), (b, f(b))), count)
    }

    #[test]
    fn zeros_of_smooth_functions_take_few_steps() {
        let (t, steps) = zero([0.0, 1.0], [0.0; 2], |t| 0.3 - t);
        assert!((t - 0.3).abs() < 1e-15 && steps < 6, "{t} {steps}");
        let (t, steps) = zero([0.0, 2.0], [0.0; 2], |t| t * t * t - 2.0);
        assert!((t - 2.0_f64.cbrt()).abs() < 2e-15 && t * t * t >= 2.0 && steps < 12, "{t} {steps}");
        let (t, steps) = zero([0.0, 2.0], [1e-9, 0.0], |t| 2.0 - t * t * t);
        assert!((t - 2.0_f64.cbrt()).abs() < 1e-9 && steps < 9, "{t} {steps}");
        // a triple zero
        let (t, steps) = zero([0.0, 1.0], [0.0; 2], |t| (t - 0.7) * (t - 0.7) * (t - 0.7));
        assert!((t - 0.7).abs() < 1e-15 && steps < 100, "{t} {steps}");
    }

    #[test]
    fn jumps_and_flat_zeros_are_bisected() {
        let jump = |t: f64| if t < 0.1 { 5.0 - t } else { -1.0 };
        let (t, steps) = zero([0.0, 1.0], [0.0; 2], jump);
        assert!((0.0..1e-15).contains(&(t - 0.1)) && steps < 60, "{t} {steps}");
        let (t, steps) = zero([0.0, 1.0], [1e-9, 1e-9], jump);
        assert!((0.0..1e-9).contains(&(t - 0.1)) && steps < 35, "{t} {steps}");
        // 0 from 0.2 on: the beginning is found
        let (t, steps) = zero([0.0, 1.0], [0.0; 2], |t| (0.2 - t).max(0.0));
        assert!((0.0..1e-15).contains(&(t - 0.2)) && steps < 70, "{t} {steps}");
    }
}
