//! Interpreter for programs without machine code: executes the steps one after the other, each on registers of 32
//! states.

use crate::lanes::Lane;
use mozzi_codegen::{Function, Program, Step};
use std::collections::HashSet;

/// A step's operation with its slots. A slot holds a value until the last step that needs it.
#[derive(Clone, Copy, Debug)]
enum Do {
    Constant(f64, u32),
    /// Reads a column of the inputs.
    Input(u32, u32),
    Apply(Function, [u32; 3], u32),
    /// Writes a slot to a column of the outputs.
    Output(u32, u32),
    /// Writes the smaller of a slot and an output column to that column; if the flag is set, writes the slot.
    Least(u32, u32, bool),
    /// The same for the sum.
    Sum(u32, u32, bool),
}

/// A program as steps on slots.
#[derive(Debug)]
pub(crate) struct Interpreter {
    steps: Vec<Do>,
    slots: usize,
}

impl Interpreter {
    /// Outputs from index `own` on are replaced by their smallest entry and their sum.
    pub fn new(program: &Program, own: usize) -> Self {
        let columns: Vec<u32> = program
            .inputs()
            .iter()
            .scan(0, |next, input| Some(std::mem::replace(next, *next + input.length as u32)))
            .collect();
        // the output columns of each value, and the last step that needs it
        let mut goes: Vec<Vec<(u32, bool)>> = vec![Vec::new(); program.steps().len()];
        let mut column = 0;
        for (k, output) in program.outputs().iter().enumerate() {
            for &value in &output.values {
                goes[value as usize].push((column, k >= own));
                column += u32::from(k < own);
            }
            column += if k < own { 0 } else { 2 };
        }
        let mut last: Vec<usize> = (0..goes.len()).collect();
        for (place, step) in program.steps().iter().enumerate() {
            step.operands().iter().for_each(|&operand| last[operand as usize] = place);
        }
        let (mut steps, mut free, mut slots) = (Vec::new(), Vec::new(), 0);
        let (mut slot_of, mut begun) = (vec![0; goes.len()], HashSet::new());
        for (place, step) in program.steps().iter().enumerate() {
            let ended = |operand: &u32| last[*operand as usize] == place;
            let operands: Vec<u32> = step.operands().to_vec();
            let given: [u32; 3] =
                std::array::from_fn(|k| operands.get(k).map_or(0, |&operand| slot_of[operand as usize]));
            let mut ending: Vec<u32> =
                operands.iter().filter(|operand| ended(operand)).map(|&operand| slot_of[operand as usize]).collect();
            ending.sort_unstable();
            ending.dedup();
            free.extend(ending);
            let slot = free.pop().unwrap_or_else(|| {
                slots += 1;
                slots - 1
            });
            slot_of[place] = slot;
            steps.push(match *step {
                Step::Constant(x) => Do::Constant(x, slot),
                Step::Input(array, index) => Do::Input(columns[array as usize] + index, slot),
                Step::Apply(function, _) => Do::Apply(function, given, slot),
            });
            for &(column, is_condensed) in &goes[place] {
                match is_condensed {
                    false => steps.push(Do::Output(slot, column)),
                    true => {
                        // the first value of the column sets it
                        let is_first = begun.insert(column);
                        steps.extend([Do::Least(slot, column, is_first), Do::Sum(slot, column + 1, is_first)]);
                    }
                }
            }
            if last[place] == place {
                free.push(slot);
            }
        }
        Interpreter { steps, slots: slots as usize }
    }

    /// Computes the outputs; every column is `abreast` registers side by side.
    #[inline(always)]
    pub fn run<L: Lane>(&self, abreast: usize, input: &[L], values: &mut Vec<L>, output: &mut [L]) {
        values.resize((self.slots * abreast).max(values.len()), L::zero());
        for &step in &self.steps {
            match step {
                Do::Constant(x, to) => values[to as usize * abreast..][..abreast].fill(L::from_f64(x)),
                Do::Input(column, to) => {
                    values[to as usize * abreast..][..abreast]
                        .copy_from_slice(&input[column as usize * abreast..][..abreast]);
                }
                Do::Apply(function, of, to) => {
                    let [a, b, c] = of.map(|slot| slot as usize * abreast);
                    let to = to as usize * abreast;
                    for r in 0..abreast {
                        values[to + r] = function.apply([values[a + r], values[b + r], values[c + r]]);
                    }
                }
                Do::Output(from, column) => {
                    output[column as usize * abreast..][..abreast]
                        .copy_from_slice(&values[from as usize * abreast..][..abreast]);
                }
                Do::Least(from, column, is_first) => {
                    for r in 0..abreast {
                        let (x, place) = (values[from as usize * abreast + r], column as usize * abreast + r);
                        output[place] = if is_first { x } else { output[place].min(x) };
                    }
                }
                Do::Sum(from, column, is_first) => {
                    for r in 0..abreast {
                        let (x, place) = (values[from as usize * abreast + r], column as usize * abreast + r);
                        output[place] = if is_first { x } else { output[place] + x };
                    }
                }
            }
        }
    }
}
