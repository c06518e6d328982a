//! Long programs in parts.
//!
//! The cache of a multiprocessor holds 128 KiB of instructions, 8192 of them. Warps that go through more load all of
//! them from memory, one line after the other, and wait for four of five cycles. So a long program is cut into parts
//! that fit. A thread goes through a part for several states before it begins the next, and keeps the few numbers that
//! later parts need in its local memory.

use super::super::body;
use crate::program::Function;
use crate::program::{Program, Step, Value};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// States of a thread for which a part is computed before the next part.
pub(super) const STATES: usize = 16;

/// Instructions that a multiprocessor's cache holds.
const CACHE: usize = 8192;
/// Instructions of a part, about: a cut may lie where few numbers are kept.
const LENGTH: usize = 5000;
/// Numbers of a state kept for later parts, at most: more take longer to store and load than the instructions.
const MOST: usize = 200;

/// A part of a program.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Part {
    pub steps: Range<usize>,
    /// The values of earlier parts that it uses, with their places in the thread's local memory.
    pub loads: Vec<(Value, usize)>,
    /// Its values that later parts use, with their places.
    pub stores: Vec<(Value, usize)>,
}

/// Whether the code is about as long as what a multiprocessor keeps, or longer.
pub(super) fn is_long(program: &Program) -> bool {
    4 * instructions(program).iter().sum::<usize>() > 3 * CACHE
}

/// The parts of a long program, and the numbers kept for a state; none if the program is short, or has to keep many.
pub(super) fn parts(program: &Program) -> Option<(Vec<Part>, usize)> {
    let instructions = instructions(program);
    let all: usize = instructions.iter().sum();
    if all <= CACHE {
        return None;
    }
    let values = values(program);
    let cuts = cuts(&instructions, &values, all.div_ceil(LENGTH));
    let ends = cuts.iter().copied().chain([program.steps.len()]);
    let ranges = [0].into_iter().chain(cuts.iter().copied()).zip(ends).map(|(start, end)| start..end);
    let mut parts: Vec<Part> = ranges.map(|steps| Part { steps, loads: Vec::new(), stores: Vec::new() }).collect();
    let part_of = |place: usize| cuts.partition_point(|&cut| cut <= place);
    let mut kept = 0;
    for (&value, known) in &values {
        let own = part_of(known.at);
        let mut users: Vec<usize> = known.uses.iter().map(|&place| part_of(place)).filter(|&part| part > own).collect();
        users.dedup();
        if !users.is_empty() {
            parts[own].stores.push((value, kept));
            users.iter().for_each(|&part| parts[part].loads.push((value, kept)));
            kept += 1;
        }
    }
    (kept <= MOST).then_some((parts, kept))
}

/// Where a value is computed, and the steps that use it, in order.
struct Known {
    at: usize,
    uses: Vec<usize>,
}

/// The values that are computed and needed.
fn values(program: &Program) -> BTreeMap<Value, Known> {
    let steps = &program.steps;
    let is_needed = body::needed(program);
    let results: BTreeSet<Value> = program.outputs.iter().flat_map(|output| output.values.iter().copied()).collect();
    let mut values: BTreeMap<Value, Known> = BTreeMap::new();
    let mut angles: BTreeMap<Value, usize> = BTreeMap::new();
    for (place, step) in steps.iter().enumerate().filter(|&(place, _)| is_needed[place]) {
        let Step::Apply(function, _) = step else { continue };
        for operand in step.operands() {
            if let Some(known) = values.get_mut(operand) {
                known.uses.push(place);
            }
        }
        let is_sine = matches!(function, Function::Sin | Function::Cos);
        let at = if is_sine { *angles.entry(step.operands()[0]).or_insert(place) } else { place };
        let uses = if results.contains(&(place as Value)) { vec![place] } else { Vec::new() };
        values.insert(place as Value, Known { at, uses });
    }
    values
}

/// Instructions of each step, about.
fn instructions(program: &Program) -> Vec<usize> {
    const SINE_AND_COSINE: usize = 33;
    const LOAD: usize = 3;
    const STORE: usize = 2;
    let is_needed = body::needed(program);
    let mut angles = Vec::new();
    let own = program.steps.iter().enumerate().map(|(place, step)| match step {
        _ if !is_needed[place] => 0,
        Step::Constant(_) => 0,
        Step::Input(..) => LOAD,
        Step::Apply(Function::Sin | Function::Cos, [angle, ..]) if angles.contains(angle) => 0,
        Step::Apply(Function::Sin | Function::Cos, [angle, ..]) => {
            angles.push(*angle);
            SINE_AND_COSINE
        }
        Step::Apply(..) => 1,
    });
    let mut instructions: Vec<usize> = own.collect();
    program.outputs.iter().flat_map(|output| &output.values).for_each(|&value| instructions[value as usize] += STORE);
    instructions
}

/// The first steps of all parts but the first: of those in the middle half of a part's length, where the fewest
/// values are alive.
fn cuts(instructions: &[usize], values: &BTreeMap<Value, Known>, count: usize) -> Vec<usize> {
    let steps = instructions.len();
    let (mut born, mut dead) = (vec![0; steps + 1], vec![0; steps + 1]);
    for known in values.values() {
        if let Some(&last) = known.uses.last() {
            born[known.at + 1] += 1;
            dead[last + 1] += 1;
        }
    }
    let all: usize = instructions.iter().sum();
    let mut cuts = Vec::new();
    for part in 1..count {
        let window = (4 * part - 1) * all / (4 * count)..=(4 * part + 1) * all / (4 * count);
        let (mut before, mut alive, mut best) = (0, 0, None);
        for place in 0..steps {
            alive = alive + born[place] - dead[place];
            if window.contains(&before) && best.is_none_or(|(fewest, _)| alive < fewest) {
                best = Some((alive, place));
            }
            before += instructions[place];
        }
        cuts.extend(best.map(|(_, place)| place));
    }
    cuts
}

#[cfg(test)]
mod tests {
    use super::*;
    use mozzi::Scalar;

    /// Sums that each need the one before, and all of them the first sine.
    fn chain(length: usize) -> Program {
        crate::record("chain", &[("x", 2)], |x| {
            let (sin, cos) = x[0][0].sin_cos();
            let last = (0..length).fold(x[0][1], |sum, _| sum * sin + cos);
            vec![("y", vec![last])]
        })
        .expect("short")
    }

    #[test]
    fn a_part_loads_what_earlier_parts_store() {
        assert_eq!(parts(&chain(4000)), None);
        let program = chain(12_000);
        let (parts, kept) = parts(&program).expect("long");
        assert_eq!((parts.len(), kept), (3, 4)); // sine, cosine, and a sum at either cut
        assert_eq!((parts[0].steps.start, parts[2].steps.end), (0, program.steps.len()));
        let mut stored = BTreeMap::new();
        for (part, next) in parts.iter().zip(parts[1..].iter().map(Some).chain([None])) {
            assert!(next.is_none_or(|next| part.steps.end == next.steps.start));
            for (value, place) in &part.loads {
                assert_eq!(stored.get(value), Some(place));
            }
            stored.extend(part.stores.iter().copied());
            for step in &program.steps[part.steps.clone()] {
                for &operand in step.operands() {
                    let is_own = part.steps.contains(&(operand as usize));
                    let is_computed = matches!(program.steps[operand as usize], Step::Apply(..));
                    let is_loaded = part.loads.iter().any(|(value, _)| *value == operand);
                    assert!(is_own || !is_computed || is_loaded);
                }
            }
        }
    }

    #[test]
    fn many_numbers_are_not_kept() {
        let program = crate::record("wide", &[("x", 300)], |x| {
            let squares: Vec<_> = x[0].iter().map(|x| *x * *x).collect();
            let sums = (0..40).map(|k| squares.iter().fold(x[0][k], |sum, x| sum * *x));
            vec![("y", sums.collect())]
        })
        .expect("short");
        assert!(is_long(&program) && parts(&program).is_none());
    }
}
