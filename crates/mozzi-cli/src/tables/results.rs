//! The results of a quantity at all states, and their output files.

use super::array::Array;
use super::format::Format;
use super::precision::Precision;
use super::states::States;
use super::{npy, npz};
use crate::columns::{Columns, names, save};
use crate::failure::Result;
use crate::numbers::WRENCH;
use mozzi::Model;
use mozzi::quantities::{Dim, Output, Query};

/// An array (N, …) of zeros for each output.
pub fn arrays<T: Precision>(query: Query, model: &Model, states: usize) -> Vec<Array<T>> {
    let zeros = |(output, at_one): (&Output, Vec<usize>)| {
        let shape = [vec![states], at_one].concat();
        let count = shape.iter().product();
        Array::new(output.name, shape, vec![T::zero(); count])
    };
    query.declaration().outputs.iter().zip(query.shapes(model)).map(zeros).collect()
}

/// The number of states in which a result is NaN.
pub fn nan<T: Precision>(results: &[Array<T>], states: usize) -> usize {
    let is_nan = |array: &Array<T>, state: usize| {
        let width = array.width();
        array.values[state * width..][..width].iter().any(|&x| Into::<f64>::into(x).is_nan())
    };
    (0..states).filter(|&state| results.iter().any(|array| is_nan(array, state))).count()
}

/// Writes to the file; for "-", returns the text of the CSV.
pub fn write<T: Precision>(
    file: &str,
    query: Query,
    model: &Model,
    states: &States<T>,
    results: &[Array<T>],
) -> Result<String> {
    match Format::of_results(file, query)? {
        Format::Npz => npz::write(file, results)?,
        #[cfg(feature = "arrow")]
        Format::Arrow => super::arrow::write(file, columns(query, model, results))?,
        Format::Npy => {
            for array in results {
                save(file, npy::bytes(array))?;
            }
        }
        _ => {
            let text = csv(query, model, states, results);
            if file == "-" {
                return Ok(text);
            }
            save(file, text)?;
        }
    }
    Ok(String::new())
}

/// Vectors over the joints come after the columns that they follow from, so that other subcommands can read the table.
fn csv<T: Precision>(query: Query, model: &Model, states: &States<T>, results: &[Array<T>]) -> String {
    let declaration = query.declaration();
    let mut table = Columns::default();
    if declaration.outputs.iter().all(|output| output.dims == [Dim::N]) {
        let count = results.first().map_or(0, |array| array.shape[0]);
        if let Some(t) = &states.samples.t {
            table.add("t", t[..count].to_vec());
        }
        let mut add = |names: Vec<String>, values: &[T]| {
            let done = &values[..count * names.len()];
            by_columns(names, done).into_iter().for_each(|(name, column)| table.add(name, to_f64(column)));
        };
        for (input, values) in declaration.inputs.iter().zip(&states.inputs) {
            add(names(model, input.name), values);
        }
        for (frame, values) in &states.wrenches {
            if model.end_effector().is_ok_and(|tip| tip == *frame) {
                add(WRENCH.map(String::from).to_vec(), values);
            }
        }
    }
    for (name, column) in columns(query, model, results) {
        table.add(name, to_f64(column));
    }
    table.text()
}

/// The columns of all results, each with its name.
fn columns<T: Precision>(query: Query, model: &Model, results: &[Array<T>]) -> Vec<(String, Vec<T>)> {
    let outputs = query.declaration().outputs.iter().zip(query.shapes(model)).zip(results);
    outputs.flat_map(|((output, shape), array)| by_columns(labels(model, output, &shape), &array.values)).collect()
}

/// `tau_1` …, `M_1_1`, `M_1_2` …; with a floating base, velocities by the names of their entries; frames by theirs.
fn labels(model: &Model, output: &Output, shape: &[usize]) -> Vec<String> {
    output.dims.iter().zip(shape).fold(vec![output.name.to_string()], |labels, (dim, &size)| {
        let entries = match dim {
            Dim::N => names(model, ""),
            Dim::Frames => model.frames().map(|(_, name)| format!("_{name}")).collect(),
            _ => (1..=size).map(|k| format!("_{k}")).collect(),
        };
        labels.iter().flat_map(|label| entries.iter().map(move |entry| format!("{label}{entry}"))).collect()
    })
}

/// The columns of a table by rows.
fn by_columns<T: Copy>(names: Vec<String>, values: &[T]) -> Vec<(String, Vec<T>)> {
    let width = names.len();
    let column = |(c, name)| (name, values.iter().skip(c).step_by(width).copied().collect());
    names.into_iter().enumerate().map(column).collect()
}

fn to_f64<T: Precision>(column: Vec<T>) -> Vec<f64> {
    column.into_iter().map(T::into).collect()
}
