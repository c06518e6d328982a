//! The reference values, and the unit of an error.

use crate::Double;
use crate::accuracy::DRAWS;
use crate::accuracy::robot::is_of_wrenches;
use core::cell::RefCell;
use mozzi::quantities::{Memory, Query};
use mozzi::random::Random;
use mozzi::{Entry, Environment, FrameId, Model, Scalar, Wrench};

/// A quantity at one state, to 31 digits.
#[derive(Debug)]
pub struct Reference {
    /// Its outputs.
    pub values: Vec<Vec<Double>>,
    /// The unit of an error of each entry, for ε = 2⁻⁵².
    pub units: Vec<Vec<f64>>,
    /// The largest term of each output's formula, if [`terms`](crate::accuracy::terms) knows it.
    pub terms: Option<Vec<f64>>,
}

/// The wrench on the frame, for quantities that depend on wrenches only.
pub const PUSH: [f64; 6] = [0.5, -1.0, 2.0, 10.0, -4.0, 8.0];

/// 0, in 31 digits.
const NOTHING: f64 = 1e-26;

/// The wrenches used to measure a quantity: the wrench above for a quantity that depends on wrenches only, none for the
/// others.
pub fn applied<S: Scalar>(query: &Query, frame: FrameId) -> Vec<(FrameId, Wrench<S>)> {
    let push = (frame, Wrench::from_array(PUSH.map(S::from_f64)));
    is_of_wrenches(query).then_some(push).into_iter().collect()
}

/// The outputs in any number type.
pub fn evaluate<S: Entry>(
    query: &Query,
    model: &Model<S>,
    frame: FrameId,
    inputs: &[Vec<S>],
    memory: &mut Memory<S>,
) -> Vec<Vec<S>> {
    let applied = applied(query, frame);
    let environment = Environment { applied: &applied, ..model.environment() };
    let mut values: Vec<Vec<S>> =
        query.output_lengths(model).map(|length| vec![<S as Scalar>::zero(); length]).collect();
    let mut slices: Vec<&mut [S]> = values.iter_mut().map(Vec::as_mut_slice).collect();
    let inputs: Vec<&[S]> = inputs.iter().map(Vec::as_slice).collect();
    query.evaluate(model, &inputs, &environment, memory, &mut slices);
    values
}

/// Converts numbers to a wider type, exactly.
pub fn widen<S: Scalar>(inputs: &[&[f64]]) -> Vec<Vec<S>> {
    inputs.iter().map(|x| x.iter().map(|&x| S::from_f64(x)).collect()).collect()
}

/// A robot and perturbed copies, whose constants differ by ε.
#[derive(Debug)]
pub struct Neighbours {
    models: Vec<Model<Double>>,
    frame: FrameId,
}

impl Neighbours {
    /// The reference for this robot.
    pub fn new(model: &Model<Double>, frame: FrameId) -> Self {
        let neighbour = |seed| {
            let random = RefCell::new(Random(seed));
            model.map(|c| changed(c, &mut random.borrow_mut()))
        };
        let models = std::iter::once(model.clone()).chain((1..=DRAWS as u64).map(neighbour)).collect();
        Neighbours { models, frame }
    }

    /// Memory for [`at`](Self::at).
    pub fn memory(&self) -> Memory<Double> {
        Memory::new(&self.models[0])
    }

    /// The quantity at this state.
    pub fn at(&self, query: &Query, inputs: &[&[f64]], seed: u64, memory: &mut Memory<Double>) -> Reference {
        let exact = widen(inputs);
        let values = evaluate(query, &self.models[0], self.frame, &exact, memory);
        let mut units: Vec<Vec<f64>> =
            values.iter().map(|x| x.iter().map(|&x| f64::EPSILON * f64::from(x).abs()).collect()).collect();
        for (draw, model) in (0_u64..).zip(&self.models[1..]) {
            let mut random = Random(seed ^ (draw << 56));
            let mut changed_inputs = exact.clone();
            for (input, declared) in changed_inputs.iter_mut().zip(query.declaration().inputs) {
                let is_angle = declared.name == "theta";
                input
                    .iter_mut()
                    .for_each(|x| *x = if is_angle { turned(*x, &mut random) } else { changed(*x, &mut random) });
            }
            let other = evaluate(query, model, self.frame, &changed_inputs, memory);
            for ((units, other), values) in units.iter_mut().zip(&other).zip(&values) {
                for ((unit, &other), &value) in units.iter_mut().zip(other).zip(values) {
                    *unit = unit.max(f64::from(other - value).abs());
                }
            }
        }
        for (units, values) in units.iter_mut().zip(&values) {
            let largest = |x: &[f64]| x.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            // for an output that is 0 whatever the constants: ε of the inputs
            if values.iter().all(|&x| f64::from(x).abs() < NOTHING) && largest(units) < NOTHING {
                let given = inputs.iter().fold(largest(&PUSH), |m, x| m.max(largest(x)));
                units.fill(f64::EPSILON * given);
            }
        }
        Reference { values, units, terms: None }
    }
}

/// x (1 ± ε); 0 and ±1 are exact rather than measured, and stay.
fn changed(x: Double, random: &mut Random) -> Double {
    let size = f64::from(x);
    if size == 0.0 || size.abs() == 1.0 { x } else { x + x * epsilon(random) }
}

/// x ± ε: for an angle of any size, about the effect of rounding its sine and cosine.
fn turned(x: Double, random: &mut Random) -> Double {
    x + epsilon(random)
}

fn epsilon(random: &mut Random) -> Double {
    Double::from_f64(if random.next() < 0.0 { -f64::EPSILON } else { f64::EPSILON })
}
