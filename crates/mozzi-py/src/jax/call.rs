//! One call of JAX: shapes are checked, then a batch computes values and derivatives of all states, derivatives in
//! `f64`.

use super::registry::{self, Batched, Entry};
use crate::failure::place;
use crate::numpy::Element;
use mozzi::Model;
use mozzi::quantities::{Of, Query};
use mozzi_engine::{BatchEnvironment, Product};
use std::borrow::Cow;

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

/// The kind, name and shape that an argument must have: the quantity's arguments, then a direction's changes, then w.
#[derive(Clone, Copy)]
struct Expected {
    kind: &'static str,
    name: &'static str,
    tail: [usize; MOST_AXES],
    rank: usize,
}

/// The most axes of a quantity at one state.
const MOST_AXES: usize = 3;

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
    match (attributes.along, attributes.wanted) {
        ([0, 0], 0) => value(entry, &query, attributes, arguments, results),
        _ => derivative(entry, &query, attributes, arguments, results, &lengths, states),
    }
    .map_err(|error| of_batch(error, &leading))
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

/// A batch's error in words, with the place of the state among the leading axes.
fn of_batch(error: mozzi_engine::Error, leading: &[usize]) -> String {
    match error {
        mozzi_engine::Error::State { source, .. } if leading.is_empty() => source.to_string(),
        mozzi_engine::Error::State { index, source } => format!("state [{}]: {source}", place(index, leading)),
        other => other.to_string(),
    }
}

fn value<T: Element + Batched>(
    entry: &Entry,
    query: &Query,
    attributes: &Attributes,
    arguments: &[Argument<T>],
    mut results: Vec<&mut [T]>,
) -> Result<(), mozzi_engine::Error> {
    let inputs: Vec<&[T]> = arguments.iter().map(|argument| argument.numbers).collect();
    let (inputs, parameters) = inputs.split_at(query.declaration().inputs.len());
    let own = BatchEnvironment::from(entry.model.environment());
    let environment = BatchEnvironment { parameters: parameters.first().copied(), ..own };
    entry.batch::<T>(attributes.threads as usize)?.compute(*query, inputs, &environment, &mut results)
}

/// A product of derivatives by the arrays' numbers.
fn derivative<T: Element + Batched>(
    entry: &Entry,
    query: &Query,
    attributes: &Attributes,
    arguments: &[Argument<T>],
    mut results: Vec<&mut [T]>,
    lengths: &[usize],
    states: usize,
) -> Result<(), mozzi_engine::Error> {
    let inputs = query.declaration().inputs.len();
    let set = |bits: i64| bits as u32;
    let along = attributes.along.map(set);
    let of = Product { along, gradient: set(attributes.wanted) };
    let own = inputs + usize::from(attributes.has_parameters);
    let (x, mut rest) = arguments.split_at(own);
    let mut further = Vec::with_capacity(3);
    for count in along.map(|set| set.count_ones() as usize).into_iter().filter(|&count| count > 0) {
        let (these, others) = rest.split_at(count);
        further.push(table(these, states));
        rest = others;
    }
    if of.gradient != 0 {
        further.push(table(rest, states));
    }
    let x: Vec<Cow<[f64]>> = x.iter().map(|x| table(std::slice::from_ref(x), states)).collect();
    let x: Vec<&[f64]> = x.iter().map(|x| &**x).collect();
    let further: Vec<&[f64]> = further.iter().map(|table| &**table).collect();
    let (x, parameters) = x.split_at(inputs);
    let around = BatchEnvironment::from(entry.model.environment());
    let environment = BatchEnvironment { parameters: parameters.first().copied(), ..around };
    let batch = entry.batch::<f64>(attributes.threads as usize)?;
    if let [result] = &mut results[..]
        && let Some(result) = T::as_f64_mut(result)
    {
        return batch.product(*query, x, of, &further, &environment, result);
    }
    let mut product = vec![0.0; results.iter().map(|result| result.len()).sum()];
    batch.product(*query, x, of, &further, &environment, &mut product)?;
    for (state, mut row) in product.chunks_exact(lengths.iter().sum()).enumerate() {
        for (result, &length) in results.iter_mut().zip(lengths) {
            let (these, others) = row.split_at(length);
            let places = result[state * length..][..length].iter_mut().zip(these);
            places.for_each(|(place, &x)| *place = T::from_f64(x));
            row = others;
        }
    }
    Ok(())
}

/// One table of `f64`, each row these arguments' rows one after the other.
fn table<'a, T: Element + Batched>(arguments: &[Argument<'a, T>], states: usize) -> Cow<'a, [f64]> {
    if let [one] = arguments {
        let converted = || one.numbers.iter().map(|x| x.to_f64()).collect();
        return T::as_f64(one.numbers).map_or_else(converted, Cow::Borrowed);
    }
    let mut table = Vec::with_capacity(arguments.iter().map(|argument| argument.numbers.len()).sum());
    for state in 0..states {
        for argument in arguments {
            let width = argument.numbers.len() / states;
            table.extend(argument.numbers[state * width..][..width].iter().map(|x| x.to_f64()));
        }
    }
    Cow::Owned(table)
}
