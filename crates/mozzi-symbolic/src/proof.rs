//! Every expression is compared with the kernel before it is printed: exactly, at random rational points, and in `f64`,
//! at a random state with the file's numbers.

use crate::atom::{Angle, Atom, Id};
use crate::derivation::{Derivation, Formula};
use crate::error::Error;
use crate::evaluate::{self, Numbers};
use crate::expression::Expression;
use crate::kernel::{Kernel, check_fault};
use crate::point::Point;
use crate::polynomial::Polynomial;
use crate::rational::Rational;
use crate::rounded::Rounded;
use crate::symbol::{Symbol, recount, set_point, with_table};
use mozzi::quantities::Query;
use mozzi::random::Random;
use mozzi::{Environment, FrameId, Freedom, Model, Scalar, Wrench};
use std::collections::HashMap;

fn constant(point: &Point, id: Id) -> Symbol {
    let atom = with_table(|table| table.atom(id).clone());
    match (point.value(&atom, id), atom) {
        (Some(x), _) => x.into(),
        (None, Atom::Sign(p)) => {
            let x = substituted(point, &p);
            if f64::from(x) > 0.0 { Symbol::one() } else { -Symbol::one() }
        }
        (None, Atom::Inverse(p)) => Symbol::one() / substituted(point, &p),
        (None, _) => Symbol::atom(id),
    }
}

fn substituted(point: &Point, p: &Polynomial) -> Symbol {
    let mut sum = Symbol::zero();
    for (monomial, x) in p.terms() {
        let start = Symbol::from(x.clone());
        sum += monomial.factors().fold(start, |product, (id, k)| product * evaluate::power(constant(point, id), k));
    }
    sum
}

/// The values of expressions at a point, with those of named sub-expressions.
pub(crate) fn value_at<'a>(point: &'a Point, names: &[Expression]) -> impl Fn(&Expression) -> Symbol + use<'a> {
    let (atom, plain) = (|id: Id| constant(point, id), |x: &Rational| Symbol::from(x.clone()));
    let mut values: Vec<Symbol> = Vec::new();
    for name in names {
        values.push(name.value(&atom, &plain, &values));
    }
    move |expression| expression.value(&atom, &plain, &values)
}

/// Calls a check with the outputs of kernels at random rational points: `outputs` gives them for the robot's numbers
/// and the inputs there.
pub(crate) fn at_points(
    quantity: &'static str,
    outputs: impl Fn(&dyn Fn(Symbol) -> Symbol, &[Vec<Symbol>]) -> Vec<Vec<Symbol>>,
    inputs: &[Vec<Symbol>],
    check: impl Fn(&Point, &[Vec<Symbol>]) -> Result<(), Error>,
) -> Result<(), Error> {
    let mut random = Random(0x6d6f_7a7a_6921);
    for _ in 0..2 {
        recount();
        let point = with_table(|table| Point::random(table, &mut random));
        let at = |x: Symbol| substituted(&point, &x.polynomial());
        // angles stay symbols, whose sines are numbers; other inputs are numbers
        let is_angle = |x: Symbol| {
            let Some(id) = x.single_atom() else { return false };
            let is_joint = |angle: &Angle| matches!(angle, Angle::Joint { position, .. } if *position == id);
            with_table(|table| table.groups.iter().any(|group| group.angles.iter().any(is_joint)))
        };
        let inputs: Vec<Vec<Symbol>> =
            inputs.iter().map(|input| input.iter().map(|&x| if is_angle(x) { x } else { at(x) }).collect()).collect();
        set_point(Some(point.clone()));
        let outputs = outputs(&at, &inputs);
        set_point(None);
        let outputs: Vec<Vec<Symbol>> = outputs.iter().map(|output| output.iter().map(|&x| at(x)).collect()).collect();
        check_fault(quantity)?;
        check(&point, &outputs)?;
        check_fault(quantity)?;
    }
    Ok(())
}

/// Compares formulas with the kernel at random rational points, exactly.
pub(crate) fn prove(
    quantity: &'static str,
    kernel: &Kernel,
    inputs: &[Vec<Symbol>],
    formulas: &[Formula],
    names: &[Expression],
) -> Result<(), Error> {
    at_points(
        quantity,
        |number, inputs| kernel.outputs_at(number, inputs),
        inputs,
        |point, outputs| {
            let value = value_at(point, names);
            for (formula, expected) in formulas.iter().zip(outputs) {
                let below = formula.denominator.as_ref().map_or(Symbol::one(), &value);
                for (entry, (expression, &expected)) in formula.entries.iter().zip(expected).enumerate() {
                    // multiplied by the denominator, so that only the kernel divides
                    let (found, expected) = (value(expression), below * expected);
                    if found != expected {
                        check_fault(quantity)?;
                        let [found, expected] = [found, expected].map(|x| f64::from(x) / f64::from(below));
                        let what = format!("{found} instead of {expected}");
                        return Err(Error::NotProven { quantity, entry, what });
                    }
                }
            }
            Ok(())
        },
    )
}

impl Derivation {
    /// The entries of a formula at a state, with the file's numbers, in any kind of number.
    pub fn evaluate<S: Scalar>(&self, inputs: &[&[S]], number: impl Fn(&Rational) -> S, pi: S) -> Vec<Vec<S>> {
        let state: HashMap<Id, S> =
            self.state_ids().into_iter().zip(inputs.iter().flat_map(|input| input.iter().copied())).collect();
        let numbers = Numbers {
            number: &number,
            position: &|id| state.get(&id).copied().unwrap_or(S::zero()),
            parameter: &|_, value| number(value),
            pi,
        };
        let atoms: Vec<S> = (0..self.table.len() as Id).map(|id| evaluate::atom(&self.table, id, &numbers)).collect();
        let (atom, mut values) = (|id: Id| atoms[id as usize], Vec::new());
        for name in &self.names {
            values.push(name.value(&atom, &number, &values));
        }
        let value = |expression: &Expression| expression.value(&atom, &number, &values);
        let entries = |formula: &Formula| {
            let below = formula.denominator.as_ref().map(value);
            let entry = |entry: &Expression| below.map_or(value(entry), |below| value(entry) / below);
            formula.entries.iter().map(entry).collect()
        };
        self.formulas.iter().map(entries).collect()
    }

    /// The numbers of the state in the order of the quantity's inputs.
    fn state_ids(&self) -> Vec<Id> {
        self.inputs.iter().flat_map(|(_, ids)| ids).copied().collect()
    }
}

/// How many bounds of a formula's rounding error it and the kernel may be apart.
pub(crate) const OF_BOUND: f64 = 16.0;

/// Compares a derivation with the model's own kernel in `f64`.
pub(crate) fn compare(
    derivation: &Derivation,
    query: &Query,
    model: &Model,
    tip: Option<FrameId>,
) -> Result<(), Error> {
    let mut random = Random(8);
    let inputs: Vec<Vec<f64>> = query
        .declaration()
        .inputs
        .iter()
        .zip(query.input_lengths(model))
        .map(|(input, length)| match input.name {
            "theta" => random_positions(model, &mut random),
            _ => random.vector(length, 1.0),
        })
        .collect();
    let slices: Vec<&[f64]> = inputs.iter().map(Vec::as_slice).collect();
    let F: [f64; 6] = random.array();
    let applied: Vec<(FrameId, Wrench)> = tip.into_iter().map(|tip| (tip, Wrench::from_array(F))).collect();
    let environment = Environment { applied: &applied, ..model.environment() };
    let expected = model.compute(*query, &slices, &environment)?;
    let wrench = tip.map(|_| &F[..]);
    let rounded = |slice: &[f64]| slice.iter().copied().map(Rounded::from).collect::<Vec<_>>();
    let inputs: Vec<Vec<Rounded>> = slices.into_iter().chain(wrench).map(rounded).collect();
    let slices: Vec<&[Rounded]> = inputs.iter().map(Vec::as_slice).collect();
    let found = derivation.evaluate(&slices, |x| x.to_f64().into(), std::f64::consts::PI.into());
    // angles that were read as multiples of π change what depends on them
    let snapped = derivation.angle_error;
    let noise = 1e-13 * model.mass().abs().max(1.0) * 100.0;
    for (found, expected) in found.iter().zip(&expected) {
        let size = expected.iter().fold(1e-300_f64, |size, x| size.max(x.abs()));
        for (entry, (found, expected)) in found.iter().zip(expected).enumerate() {
            // terms that cancel, and a small denominator, enlarge the rounding errors of both
            let rounding = OF_BOUND * found.error;
            if !((found.value - expected).abs() <= (1e-9 + 1e3 * snapped) * size + noise + rounding) {
                let what = format!("{} instead of {expected}", found.value);
                return Err(Error::NotProven { quantity: derivation.quantity, entry, what });
            }
        }
    }
    Ok(())
}

/// θ with unit quaternions.
pub(crate) fn random_positions(model: &Model, random: &mut Random) -> Vec<f64> {
    let mut theta = random.vector(model.nq(), 2.0);
    for place in model.configuration_space().places().iter().filter(|place| place.freedom != Freedom::One) {
        let quaternion = &mut theta[place.q..place.q + 4];
        let size = quaternion.iter().map(|x| x * x).sum::<f64>().sqrt();
        quaternion.iter_mut().for_each(|x| *x /= size);
    }
    theta
}
