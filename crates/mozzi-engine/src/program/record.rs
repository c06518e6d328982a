//! From a tape to a program.

use crate::program::Function;
use crate::program::Traced;
use crate::program::tape::{self, Node, Tape};
use crate::program::too_long::TooLong;
use crate::program::{Array, Output, Program, Step, Value};

/// Records the program that `body` executes on these input arrays (name and length); it returns named output arrays.
/// The kernels of `mozzi` run in it unchanged: see [`Program`](crate::Program).
///
/// # Errors
/// [`TooLong`].
pub fn record<'n>(
    name: &str,
    inputs: &[(&str, usize)],
    body: impl FnOnce(&[Vec<Traced>]) -> Vec<(&'n str, Vec<Traced>)>,
) -> Result<Program, TooLong> {
    let outer = tape::replace(Tape::default());
    let arrays: Vec<Vec<Traced>> = (0..)
        .zip(inputs)
        .map(|(array, &(_, length))| tape::with(|tape| (0..length as u32).map(|k| tape.input(array, k)).collect()))
        .collect();
    let outputs = body(&arrays);
    let tape = tape::replace(outer);
    if tape.is_full() {
        return Err(TooLong);
    }
    let inputs = inputs.iter().map(|&(name, length)| Array { name: name.to_string(), length }).collect();
    let asked = Some(tape.asked);
    let (steps, outputs) = finish(tape, &outputs);
    Ok(Program { name: name.to_string(), inputs, steps, outputs, asked })
}

/// The steps that the outputs need, in the order of the tape: products are fused with sums, and the sign is computed if
/// an output is the negative of a node.
fn finish(tape: Tape, outputs: &[(&str, Vec<Traced>)]) -> (Vec<Step>, Vec<Output>) {
    let mut steps: Vec<Step> = tape
        .nodes
        .into_iter()
        .map(|node| match node {
            Node::Constant(bits) => Step::Constant(f64::from_bits(bits)),
            Node::Input(array, index) => Step::Input(array, index),
            Node::Apply(function, operands) => Step::Apply(function, operands),
        })
        .collect();
    let roots = || outputs.iter().flat_map(|(_, values)| values.iter());
    let uses = uses(&steps, roots().map(|x| x.node()));
    fuse(&mut steps, &uses);
    // a node that is used only as a negated output is computed with its sign changed; else the negation is a step of
    // its own
    let mut negated: Vec<Option<Value>> = vec![None; steps.len()];
    for x in roots().filter(|x| x.is_negative()) {
        let node = x.node() as usize;
        if negated[node].is_none() {
            let goes_out = roots().filter(|y| *y == x).count() as u32;
            negated[node] = Some(match negative(steps[node]) {
                Some(step) if uses[node] == goes_out => {
                    steps[node] = step;
                    x.node()
                }
                _ => {
                    steps.push(Step::Apply(Function::Neg, [x.node(), 0, 0]));
                    (steps.len() - 1) as u32
                }
            });
        }
    }
    let place = |x: &Traced| if x.is_negative() { negated[x.node() as usize].unwrap_or_default() } else { x.node() };
    let outputs = outputs
        .iter()
        .map(|(name, values)| Output { name: name.to_string(), values: values.iter().map(place).collect() })
        .collect();
    sweep(steps, outputs)
}

/// How often each step is used, by steps that are themselves used and by the roots.
fn uses(steps: &[Step], roots: impl Iterator<Item = Value>) -> Vec<u32> {
    let mut uses = vec![0; steps.len()];
    roots.for_each(|root| uses[root as usize] += 1);
    for place in (0..steps.len()).rev() {
        if uses[place] > 0 {
            steps[place].operands().iter().for_each(|&operand| uses[operand as usize] += 1);
        }
    }
    uses
}

/// Fuses products into sums. A sum first takes a product that only it uses (if there are two, the one recorded last),
/// then a product that only sums use, if each of them can take it.
fn fuse(steps: &mut [Step], uses: &[u32]) {
    for place in 0..steps.len() {
        let single = |x: Value| uses[x as usize] == 1;
        if let Some((_, fused)) = fused(steps, place, single) {
            steps[place] = fused;
        }
    }
    let mut by_sums = vec![0; steps.len()];
    for place in (0..steps.len()).filter(|&place| uses[place] > 0) {
        if let Some((product, _)) = fused(steps, place, |_| true) {
            by_sums[product as usize] += 1;
        }
    }
    let only_by_sums: Vec<bool> = by_sums.iter().zip(uses).map(|(sums, uses)| sums == uses).collect();
    for place in (0..steps.len()).filter(|&place| uses[place] > 0) {
        match fused(steps, place, |_| true) {
            Some((product, fused)) if only_by_sums[product as usize] => steps[place] = fused,
            _ => {}
        }
    }
}

/// Among the products that `may_be` allows, the last recorded one that this sum can take, and the fused step.
fn fused(steps: &[Step], place: usize, may_be: impl Fn(Value) -> bool) -> Option<(Value, Step)> {
    let Step::Apply(function @ (Function::Add | Function::Sub), [a, b, _]) = steps[place] else { return None };
    let (of_a, of_b) = match function {
        Function::Add => (Function::MulAdd, Function::MulAdd),
        _ => (Function::MulSub, Function::NegMulAdd),
    };
    let last_first = if a > b { [(of_a, a, b), (of_b, b, a)] } else { [(of_b, b, a), (of_a, a, b)] };
    last_first.into_iter().filter(|&(_, x, rest)| x != rest && may_be(x)).find_map(|(function, x, rest)| {
        match steps[x as usize] {
            Step::Apply(Function::Mul, [p, q, _]) => Some((x, Step::Apply(function, [p, q, rest]))),
            _ => None,
        }
    })
}

/// The step that computes the negative at no extra cost.
fn negative(step: Step) -> Option<Step> {
    let Step::Apply(function, [a, b, c]) = step else { return None };
    let (function, operands) = match function {
        Function::Sub => (Function::Sub, [b, a, c]),
        Function::MulAdd => (Function::NegMulSub, [a, b, c]),
        Function::MulSub => (Function::NegMulAdd, [a, b, c]),
        Function::NegMulAdd => (Function::MulSub, [a, b, c]),
        Function::NegMulSub => (Function::MulAdd, [a, b, c]),
        _ => return None,
    };
    Some(Step::Apply(function, operands))
}

/// The steps that the outputs need, renumbered.
fn sweep(steps: Vec<Step>, mut outputs: Vec<Output>) -> (Vec<Step>, Vec<Output>) {
    let uses = uses(&steps, outputs.iter().flat_map(|output| output.values.iter().copied()));
    let (mut kept, mut place) = (Vec::new(), vec![0; steps.len()]);
    for (k, mut step) in steps.into_iter().enumerate().filter(|(k, _)| uses[*k] > 0) {
        if let Step::Apply(function, operands) = &mut step {
            operands[..function.arity()].iter_mut().for_each(|operand| *operand = place[*operand as usize]);
        }
        place[k] = kept.len() as u32;
        kept.push(step);
    }
    outputs.iter_mut().flat_map(|output| &mut output.values).for_each(|value| *value = place[*value as usize]);
    (kept, outputs)
}
