//! The lines of a function: its steps.

use super::dialect::{Dialect, Emitted, Sines};
use crate::program::Function;
use crate::program::{Program, Step, Value};
use std::collections::BTreeMap;

/// Which steps the results need.
pub(super) fn needed(program: &Program) -> Vec<bool> {
    let mut is_needed = vec![false; program.steps.len()];
    program.outputs.iter().flat_map(|output| &output.values).for_each(|&value| is_needed[value as usize] = true);
    for (place, step) in program.steps.iter().enumerate().rev() {
        if is_needed[place] {
            step.operands().iter().for_each(|&operand| is_needed[operand as usize] = true);
        }
    }
    is_needed
}

/// Emits one line for each step, and each output entry as soon as it is known.
pub(super) fn lines(function: &Emitted, dialect: &dyn Dialect) -> Vec<String> {
    of_steps(function, dialect).into_iter().flatten().collect()
}

/// The lines of each step. A sine and a cosine of one angle are computed together, where the first of them is.
pub(super) fn of_steps(function: &Emitted, dialect: &dyn Dialect) -> Vec<Vec<String>> {
    let steps = &function.program.steps;
    let operand = |value: Value| match steps[value as usize] {
        Step::Constant(x) => dialect.literal(x),
        Step::Input(array, index) => dialect.entry(&function.inputs[array as usize].name, index as usize),
        Step::Apply(..) => format!("v{value}"),
    };
    let mut entries: Vec<Vec<(&str, usize)>> = vec![Vec::new(); steps.len()];
    for (output, argument) in function.program.outputs.iter().zip(&function.outputs) {
        for (index, value) in output.values.iter().enumerate() {
            entries[*value as usize].push((&argument.name, index));
        }
    }
    let is_needed = needed(function.program);
    // the steps of the sine and the cosine of each angle
    let mut angles: BTreeMap<Value, [Option<Value>; 2]> = BTreeMap::new();
    for (place, step) in (0..).zip(steps).filter(|(place, _)| is_needed[*place as usize]) {
        if let Step::Apply(function @ (Function::Sin | Function::Cos), [angle, ..]) = step {
            angles.entry(*angle).or_default()[usize::from(*function == Function::Cos)].get_or_insert(place);
        }
    }
    let is_step = |value: Value| matches!(steps[value as usize], Step::Apply(..));
    let mut all = vec![Vec::new(); steps.len()];
    for (place, step) in (0..).zip(steps).filter(|(place, _)| is_needed[*place as usize]) {
        let lines: &mut Vec<String> = &mut all[place as usize];
        if let Step::Apply(function, operands) = step {
            let name = format!("v{place}");
            let [a, b, c] =
                operands.map(|value| if (value as usize) < steps.len() { operand(value) } else { String::new() });
            let fused = |a: &str, b: &str, c: &str| format!("{}({a}, {b}, {c})", dialect.helper("mul_add"));
            let expression = match function {
                Function::Sin | Function::Cos => {
                    if angles.contains_key(&operands[0]) {
                        // all whose angles are known here, or this one
                        let is_next = |angle: &Value| {
                            let is_known = !is_step(*angle) || *angle < place;
                            *angle == operands[0] || is_known && dialect.has_sines_abreast()
                        };
                        let next = angles.extract_if(.., |angle, _| is_next(angle));
                        let sines = next.map(|(angle, places)| {
                            let [sin, cos] = places.map(|place| place.map(|place| format!("v{place}")));
                            Sines { angle: operand(angle), sin, cos }
                        });
                        lines.extend(dialect.bind_sines(&sines.collect::<Vec<_>>()));
                    }
                    None
                }
                Function::Add => Some(format!("{a} + {b}")),
                Function::Sub => Some(format!("{a} - {b}")),
                Function::Mul => Some(format!("{a} * {b}")),
                Function::Div => Some(dialect.quotient(&a, &b)),
                Function::Neg => Some(format!("-{a}")),
                Function::MulAdd => Some(fused(&a, &b, &c)),
                Function::MulSub => Some(fused(&a, &b, &format!("-{c}"))),
                Function::NegMulAdd => Some(fused(&format!("-{a}"), &b, &c)),
                Function::NegMulSub => Some(fused(&format!("-{a}"), &b, &format!("-{c}"))),
                Function::Sqrt | Function::Tanh | Function::Sgn => {
                    Some(format!("{}({a})", dialect.helper(function.name())))
                }
            };
            lines.extend(expression.map(|expression| dialect.bind(&name, &expression)));
        }
        let value = operand(place);
        lines.extend(entries[place as usize].iter().map(|&(array, index)| dialect.store(array, index, &value)));
    }
    all
}
