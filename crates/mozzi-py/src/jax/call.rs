//! One call of JAX: shapes are checked, then values and gradients of all states are computed by a batch, other
//! derivatives state by state in `f64`.

use super::derivative::{Derivative, vjp_of};
use super::evaluate::Scratch;
use super::registry::{self, Batched, Entry};
use super::tangent::position_gradient;
use crate::failure::place;
use crate::numpy::Element;
use mozzi::Model;
use mozzi::quantities::{Of, Query};
use mozzi_batch::BatchEnvironment;
use rayon::prelude::*;

/// The constants of a call.
pub struct Attributes<'a> {
    /// The robot's number.
    pub model: i64,
    pub quantity: &'a str,
    /// A frame's name; empty if the quantity has none.
    pub frame: &'a str,
    /// Whether the inertial parameters are the last argument of the quantity.
    pub has_parameters: bool,
    /// For each direction, a bit for each argument that it changes; 0 for no direction.
    pub along: [i64; 2],
    /// A bit for each argument whose gradient is wanted; 0 if the quantity itself is.
    pub wanted: i64,
    /// The largest number of threads; 0 for all cores.
    pub threads: i64,
}

/// An array.
pub struct Argument<'a, T> {
    pub shape: &'a [i64],
    pub numbers: &'a [T],
}

/// What an argument must be: the arguments of the quantity, then a direction's changes, then w.
#[derive(Clone, Copy)]
struct Expected {
    kind: &'static str,
    name: &'static str,
    tail: [usize; MOST_AXES],
    rank: usize,
}

/// The most axes of a quantity at one state.
const MOST_AXES: usize = 3;
/// States from which on threads share the work of derivatives without a batch.
const FEW: usize = 8;

impl Expected {
    fn new(kind: &'static str, name: &'static str, shape: impl Iterator<Item = usize>) -> Self {
        let mut expected = Expected { kind, name, tail: [1; MOST_AXES], rank: 0 };
        for length in shape {
            expected.tail[expected.rank] = length;
            expected.rank += 1;
        }
        expected
    }

    fn length(&self) -> usize {
        self.tail.iter().product()
    }

    /// The leading axes.
    fn leading<'s>(&self, shape: &'s [i64]) -> Option<&'s [i64]> {
        let (leading, tail) = shape.split_at_checked(shape.len().checked_sub(self.rank)?)?;
        tail.iter().zip(&self.tail).all(|(&found, &length)| found == length as i64).then_some(leading)
    }
}

/// The quantity of this name, of this frame.
///
/// # Errors
/// If there is no such quantity or frame, or it needs a task or a point.
pub fn query(model: &Model, quantity: &str, frame: &str) -> Result<Query<'static>, String> {
    let query = Query::named(quantity).map_err(|error| error.to_string())?;
    match query.declaration().of {
        Of::Robot => Ok(query),
        Of::Frame => Ok(query.of(model.frame(frame).map_err(|error| error.to_string())?)),
        Of::Task | Of::Point => Err(format!("{quantity} is of a task or a point, which mozzi.jax does not have")),
    }
}

/// Fills the results.
///
/// # Errors
/// An unknown robot, quantity or frame, a wrong shape, a state that cannot be computed.
pub fn run<T: Element + Batched>(
    attributes: &Attributes,
    arguments: &[Argument<T>],
    results: Vec<&mut [T]>,
) -> Result<(), String> {
    let entry = &*registry::find(attributes.model)?;
    let query = query(&entry.model, attributes.quantity, attributes.frame)?;
    let expected = expected(&entry.model, &query, attributes);
    let leading = check(&expected, arguments)?;
    let states: usize = leading.iter().product();
    let derivative = Derivative { entry, query, has_parameters: attributes.has_parameters, wanted: attributes.wanted };
    let lengths: Vec<usize> = match attributes.wanted {
        0 => query.output_lengths(&entry.model).collect(),
        wanted => expected.iter().enumerate().filter(|(k, _)| wanted >> k & 1 == 1).map(|(_, x)| x.length()).collect(),
    };
    let found = results.iter().map(|result| result.len());
    if !found.eq(lengths.iter().map(|length| states * length)) {
        return Err(format!("the results of {} have wrong lengths", query.name()));
    }
    if states == 0 {
        return Ok(());
    }
    let is_plain = attributes.along == [0; 2];
    match (attributes.wanted, vjp_of(&query)) {
        (0, _) if is_plain => value(entry, &query, attributes, arguments, results, &leading),
        (_, Some(vjp)) if is_plain && !attributes.has_parameters => {
            gradient(entry, vjp, attributes, arguments, results, &leading)
        }
        _ => each_state(&derivative, attributes, &expected, arguments, results, &leading),
    }
}

/// The arguments of a call with these attributes.
fn expected(model: &Model, query: &Query, attributes: &Attributes) -> Vec<Expected> {
    let declaration = query.declaration();
    let mut all = Vec::with_capacity(16);
    let inputs = declaration.inputs.iter().zip(query.input_lengths(model));
    all.extend(inputs.map(|(input, length)| Expected::new("", input.name, std::iter::once(length))));
    if attributes.has_parameters {
        all.push(Expected::new("", "parameters", std::iter::once(model.parameter_count())));
    }
    let own = all.len();
    for mask in attributes.along {
        for k in (0..own).filter(|k| mask >> k & 1 == 1) {
            all.push(Expected { kind: "the tangent of ", ..all[k] });
        }
    }
    if attributes.wanted != 0 {
        let outputs = declaration.outputs.iter();
        all.extend(outputs.map(|o| Expected::new("the cotangent of ", o.name, o.shape(model, &query.subject))));
    }
    all
}

/// The leading axes, which all arguments must have.
fn check<T>(expected: &[Expected], arguments: &[Argument<T>]) -> Result<Vec<usize>, String> {
    let (Some(first), Some(argument)) = (expected.first(), arguments.first()) else {
        return Err("there are no arguments".into());
    };
    if expected.len() != arguments.len() {
        return Err(format!("there are {} arguments, expected {}", arguments.len(), expected.len()));
    }
    let leading = first.leading(argument.shape);
    for (expected, argument) in expected.iter().zip(arguments) {
        if leading.is_none() || expected.leading(argument.shape) != leading {
            let Expected { kind, name, tail, rank } = expected;
            let wanted = [&leading.map_or_else(|| vec!["...".into()], numbers)[..], &numbers(&tail[..*rank])].concat();
            let (found, wanted) = (numbers(argument.shape).join(", "), wanted.join(", "));
            return Err(format!("{kind}{name} has shape ({found}), expected ({wanted})"));
        }
    }
    Ok(leading.unwrap_or_default().iter().map(|&length| length as usize).collect())
}

fn numbers(shape: &[impl ToString]) -> Vec<String> {
    shape.iter().map(ToString::to_string).collect()
}

/// The error of one of many states.
fn of_state(index: usize, leading: &[usize], error: impl ToString) -> String {
    let error = error.to_string();
    if leading.is_empty() { error } else { format!("state [{}]: {error}", place(index, leading)) }
}

fn of_batch(error: mozzi_batch::Error, leading: &[usize]) -> String {
    match error {
        mozzi_batch::Error::State { index, source } => of_state(index, leading, source),
        other => other.to_string(),
    }
}

fn value<T: Element + Batched>(
    entry: &Entry,
    query: &Query,
    attributes: &Attributes,
    arguments: &[Argument<T>],
    mut results: Vec<&mut [T]>,
    leading: &[usize],
) -> Result<(), String> {
    let inputs: Vec<&[T]> = arguments.iter().map(|argument| argument.numbers).collect();
    let (inputs, parameters) = inputs.split_at(query.declaration().inputs.len());
    let own = BatchEnvironment::from(entry.model.environment());
    let environment = BatchEnvironment { parameters: parameters.first().copied(), ..own };
    let batch = entry.batch::<T>(attributes.threads as usize)?;
    batch.compute(*query, inputs, &environment, &mut results).map_err(|error| of_batch(error, leading))
}

/// wᵀ∂f by the quantity's own kernel.
fn gradient<T: Element + Batched>(
    entry: &Entry,
    vjp: Query,
    attributes: &Attributes,
    arguments: &[Argument<T>],
    results: Vec<&mut [T]>,
    leading: &[usize],
) -> Result<(), String> {
    let (model, states) = (&entry.model, leading.iter().product::<usize>());
    let is_flat = model.configuration_space().is_flat();
    let is_direct = |k: usize| attributes.wanted >> k & 1 == 1 && (k > 0 || is_flat);
    let mut further: [Vec<T>; 3] = Default::default();
    for (_, table) in further.iter_mut().enumerate().filter(|(k, _)| !is_direct(*k)) {
        table.resize(states * model.n(), T::default());
    }
    let mut results = results.into_iter();
    let mut by_positions = (attributes.wanted & 1 == 1 && !is_flat).then(|| results.next()).flatten();
    let mut tables: Vec<&mut [T]> = Vec::with_capacity(3);
    for (k, table) in further.iter_mut().enumerate() {
        match is_direct(k).then(|| results.next()).flatten() {
            Some(result) => tables.push(result),
            None => tables.push(table),
        }
    }
    let inputs: Vec<&[T]> = arguments.iter().map(|argument| argument.numbers).collect();
    let batch = entry.batch::<T>(attributes.threads as usize)?;
    let found = batch.compute(vjp, &inputs, &model.environment().into(), &mut tables);
    found.map_err(|error| of_batch(error, leading))?;
    if let Some(out) = &mut by_positions {
        let rows = inputs[0].chunks_exact(model.nq()).zip(tables[0].chunks_exact(model.n()));
        for ((theta, along), out) in rows.zip(out.chunks_exact_mut(model.nq())) {
            position_gradient(model, theta, along, out);
        }
    }
    Ok(())
}

/// State by state, in `f64`.
fn each_state<T: Element + Batched>(
    derivative: &Derivative,
    attributes: &Attributes,
    expected: &[Expected],
    arguments: &[Argument<T>],
    mut results: Vec<&mut [T]>,
    leading: &[usize],
) -> Result<(), String> {
    let states: usize = leading.iter().product();
    let own = derivative.query.declaration().inputs.len() + usize::from(attributes.has_parameters);
    let one = |scratch: &mut Scratch, state: usize| {
        let at = |k: usize| -> Vec<f64> {
            let length = expected[k].length();
            arguments[k].numbers[state * length..][..length].iter().map(|x| x.to_f64()).collect()
        };
        let x: Vec<Vec<f64>> = (0..own).map(at).collect();
        let mut next = own;
        let along = attributes.along.map(|mask| {
            let changed = |k: usize| {
                if mask >> k & 1 == 0 {
                    return vec![0.0; x[k].len()];
                }
                next += 1;
                at(next - 1)
            };
            (mask != 0).then(|| (0..own).map(changed).collect())
        });
        let w: Vec<Vec<f64>> = (next..arguments.len()).map(at).collect();
        derivative.at(&x, along, &w, scratch).map_err(|error| of_state(state, leading, error))
    };
    let found: Vec<Result<Vec<Vec<f64>>, String>> = if attributes.threads == 1 || states < FEW {
        let mut scratch = Scratch::default();
        (0..states).map(|state| one(&mut scratch, state)).collect()
    } else {
        (0..states).into_par_iter().map_init(Scratch::default, one).collect()
    };
    for (state, found) in found.into_iter().enumerate() {
        for (result, found) in results.iter_mut().zip(found?) {
            let length = found.len();
            let numbers = result[state * length..][..length].iter_mut().zip(found);
            numbers.for_each(|(place, x)| *place = T::from_f64(x));
        }
    }
    Ok(())
}
