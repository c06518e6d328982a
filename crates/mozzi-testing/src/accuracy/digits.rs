//! Checks the references: the kernels on 71 digits against the second way on 71 digits, and on 31 against 71.

use crate::accuracy::reference::{Neighbours, applied, evaluate, widen};
use crate::accuracy::robot::Robot;
use crate::accuracy::states::States;
use crate::{Given, Octuple, second_way};
use mozzi::quantities::Memory;
use mozzi::{Environment, Real, Scalar};
use rayon::prelude::*;

/// The smallest number of digits, over all states, to which two computations agree, relative to the size of the terms.
#[derive(Clone, Copy, Debug)]
pub struct Digits {
    /// The kernel on 71 digits, and the second way.
    pub ways: f64,
    /// The kernel on 31 digits, and on 71.
    pub widths: f64,
}

impl Digits {
    fn fewer(self, other: Digits) -> Digits {
        Digits { ways: self.ways.min(other.ways), widths: self.widths.min(other.widths) }
    }
}

/// The agreement for a quantity, at this many first states.
pub fn of(robot: &Robot, states: &States, count: usize, quantity: usize) -> Option<Digits> {
    let query = robot.query(quantity);
    let first = states.inputs(&query, 0, 1);
    if robot.model.compute(query, &first, &robot.model.environment()).is_err() {
        return None;
    }
    let neighbours = Neighbours::new(&robot.double, robot.frame);
    let (description, model) = &robot.octuple;
    let at = |state: usize| {
        let given = states.inputs(&query, state, 1);
        let double = neighbours.at(&query, &given, state as u64, &mut neighbours.memory());
        let wide = widen::<Octuple>(&given);
        let kernel = evaluate(&query, model, robot.frame, &wide, &mut Memory::new(model));
        let applied = applied(&query, robot.frame);
        let inputs: Vec<&[Octuple]> = wide.iter().map(Vec::as_slice).collect();
        let environment = Environment { applied: &applied, ..model.environment() };
        let given = Given { robot: description, model, of: query.subject, inputs: &inputs, environment: &environment };
        let second = second_way(query.index(), given);
        let mut digits = Digits { ways: f64::INFINITY, widths: f64::INFINITY };
        for (k, values) in kernel.iter().enumerate() {
            let terms = double.units[k].iter().fold(0.0_f64, |m, x| m.max(*x)) / f64::EPSILON;
            let agree = |other: &mut dyn Iterator<Item = Octuple>| {
                let error = values.iter().zip(other).fold(Octuple::zero(), |m, (&a, b)| {
                    let error = (a - b).abs();
                    if error <= m { m } else { error }
                });
                let error = f64::from(error);
                if error == 0.0 { f64::INFINITY } else { -(error / terms).log10() }
            };
            let found = Digits {
                ways: agree(&mut second[k].iter().copied()),
                widths: agree(&mut double.values[k].iter().map(|&x| x.into())),
            };
            digits = digits.fewer(found);
        }
        digits
    };
    (0..count.min(states.len())).into_par_iter().map(at).reduce_with(Digits::fewer)
}
