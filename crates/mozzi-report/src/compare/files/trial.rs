//! Makes the changes of the causes in the first robot: alone, all, and all but one.

use super::cause::{Cause, Change};
use super::forces::{Gaps, States, effect};
use crate::compare::terms::Numbers;
use mozzi::Description;

/// Gives each cause its effect, and removes those with which the forces agree less. Returns the differences that are
/// left.
pub fn tried(causes: &mut Vec<Cause>, states: &States, robot: &Description, [mine, theirs]: [&[Numbers]; 2]) -> Gaps {
    let changed = |causes: &mut dyn Iterator<Item = &Cause>| {
        let mut robot = robot.clone();
        causes.for_each(|cause| cause.change.apply(&mut robot));
        states.numbers(&robot)
    };
    // a robot that cannot be built explains nothing
    let left = |causes: &mut dyn Iterator<Item = &Cause>| match changed(causes) {
        Ok(numbers) => states.gaps(&numbers, theirs),
        Err(_) => states.gaps(mine, theirs),
    };
    let worst = |gaps: &Gaps| gaps.iter().map(|gap| gap.part).fold(0.0, f64::max);
    let mut after = left(&mut causes.iter());
    let mut k = 0;
    while worst(&after) > ROUNDING && k < causes.len() {
        let without = left(&mut causes.iter().enumerate().filter(|(other, _)| *other != k).map(|(_, cause)| cause));
        if !matches!(causes[k].change, Change::NoForce) && worst(&without) < 0.5 * worst(&after) {
            causes.remove(k);
            (after, k) = (without, 0);
        } else {
            k += 1;
        }
    }
    for cause in causes.iter_mut() {
        let Ok(changed) = changed(&mut std::iter::once(&*cause)) else { continue };
        cause.effect = effect(&states.gaps(mine, &changed));
    }
    after
}

/// Smaller parts of a number are rounding errors.
const ROUNDING: f64 = 1e-9;
