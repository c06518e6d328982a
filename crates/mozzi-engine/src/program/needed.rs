//! Orders of a program's steps by need. A kernel computes all its matrices at once, so that in the recorded order much
//! is alive at the same time; a program that finishes one entry after the other has a smaller frame and less code.

use crate::program::{Program, Step, Value};
use mozzi::quantities::{ForwardDynamicsDerivatives, Query};

/// Programs with more steps are ordered by pairs of joints.
const LONG: usize = 5000;

/// The program in the order that is fastest for this quantity (docs/performance-log.md): ∂θ̈, which multiplies whole
/// matrices, row by row; long programs of other matrices by pairs of joints, from the outermost inward.
pub(crate) fn ordered(program: Program, query: Query, n: usize) -> Program {
    if query == ForwardDynamicsDerivatives.into() {
        let rows: Vec<Value> = program.outputs.iter().flat_map(|output| output.values.iter().copied()).collect();
        return program.by_need(&rows);
    }
    match pairs(&program, n) {
        pairs if program.steps.len() > LONG && !pairs.is_empty() => program.by_need(&pairs),
        _ => program,
    }
}

/// The entries (i, j) and (j, i) of all outputs of n × n numbers, from the last pair to the first.
fn pairs(program: &Program, n: usize) -> Vec<Value> {
    let squares = || program.outputs.iter().filter(|output| output.values.len() == n * n);
    let entries = (0..n).rev().flat_map(|j| (0..n).rev().flat_map(move |i| [i * n + j, j * n + i]));
    entries.flat_map(|entry| squares().map(move |output| output.values[entry])).collect()
}

impl Program {
    /// Reorders the program. For each of these values in turn, the steps follow that it needs and no earlier value
    /// needed, in recorded order; then the other steps. If the values of the outputs are finished one by one, fewer
    /// values are alive at the same time.
    ///
    /// # Panics
    /// If a value is not of this program.
    pub fn by_need(&self, values: &[Value]) -> Program {
        const WAITS: u32 = u32::MAX;
        const FOUND: u32 = u32::MAX - 1;
        let steps = &self.steps;
        let mut place = vec![WAITS; steps.len()];
        let (mut order, mut open, mut needed) = (Vec::with_capacity(steps.len()), Vec::new(), Vec::new());
        for value in values.iter().copied().chain(0..steps.len() as Value) {
            open.push(value);
            while let Some(value) = open.pop() {
                if place[value as usize] == WAITS {
                    place[value as usize] = FOUND;
                    needed.push(value);
                    open.extend(steps[value as usize].operands());
                }
            }
            needed.sort_unstable();
            for value in needed.drain(..) {
                place[value as usize] = order.len() as u32;
                order.push(value);
            }
        }
        let moved = |&value: &Value| match steps[value as usize] {
            Step::Apply(function, mut operands) => {
                operands[..function.arity()].iter_mut().for_each(|operand| *operand = place[*operand as usize]);
                Step::Apply(function, operands)
            }
            step => step,
        };
        let mut outputs = self.outputs.clone();
        outputs.iter_mut().flat_map(|output| &mut output.values).for_each(|value| *value = place[*value as usize]);
        let steps = order.iter().map(moved).collect();
        let (name, inputs, asked) = (self.name.clone(), self.inputs.clone(), self.asked);
        Program { name, inputs, steps, outputs, asked }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_an_entry_needs_comes_right_before_it() {
        // two products, then two sums, and a matrix of both
        let program = crate::record("test", &[("x", 2)], |x| {
            let (p, q) = (x[0][0] * x[0][0], x[0][1] * x[0][1]);
            let (a, b) = (p + x[0][1], q - x[0][0]);
            vec![("A", vec![a, b, p * q, a * b])]
        })
        .expect("short");
        assert_eq!(pairs(&program, 2), [3, 3, 1, 2, 2, 1, 0, 0].map(|k: usize| program.outputs[0].values[k]));
        let input = [0.3, 0.7];
        for values in [program.outputs[0].values.clone(), pairs(&program, 2)] {
            let found = program.by_need(&values);
            assert_eq!(found.evaluate(&[&input]), program.evaluate(&[&input]));
            for (place, step) in found.steps.iter().enumerate() {
                assert!(step.operands().iter().all(|&operand| (operand as usize) < place));
            }
            assert_eq!(found.steps.len(), program.steps.len());
            assert!(found.outputs[0].values.iter().all(|&value| found.steps.len() > value as usize));
        }
        // rows: the first entry's steps are the first
        let rows = program.by_need(&program.outputs[0].values);
        assert_eq!(rows.outputs[0].values[0], 3, "x₀, x₁, p, a");
    }
}
