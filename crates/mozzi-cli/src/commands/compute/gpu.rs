//! The states of a file on a GPU.

use crate::failure::{Failure, Result};
use crate::interrupt;
use crate::progress::Progress;
use crate::quantity::hyphenated;
use crate::tables::array::Array;
use crate::tables::precision::Precision;
use crate::tables::results;
use crate::tables::states::States;
use mozzi::Model;
use mozzi::quantities::Query;
use mozzi_gpu::{Device, Form, Kernel, Source};
use std::time::Instant;

/// States that are on the GPU at the same time.
const PIECE: usize = 1 << 20;

/// The kernel of this quantity on the first GPU.
pub fn kernel<T: Precision>(query: Query, model: &Model) -> Result<Kernel> {
    let form = Form { precision: T::PRECISION, ..Form::default() };
    let device = Device::first()?;
    Ok(device.kernel(&Source::new(model, query, form)?)?)
}

/// The results and the computing time in seconds, transfers included; after Ctrl-C, of the states computed so far.
pub fn compute<T: Precision>(
    kernel: &Kernel,
    query: Query,
    model: &Model,
    states: &States<T>,
) -> Result<(Vec<Array<T>>, f64)> {
    let other = [
        (!states.wrenches.is_empty(), "wrenches"),
        (states.gravity.is_some(), "gravity"),
        (states.parameters.is_some(), "inertial parameters"),
    ];
    if let Some((_, what)) = other.into_iter().find(|(is_given, _)| *is_given) {
        let file = &states.samples.file;
        return Err(Failure::wrong(format!("--gpu: {file} has {what} for each state, expected the robot's own alone")));
    }
    check_orientations(model, states)?;
    let count = states.samples.count;
    let mut results = results::arrays::<T>(query, model, count);
    interrupt::listen();
    let (progress, start) = (Progress::new(hyphenated(query.name()), count, "states"), Instant::now());
    let mut first = 0;
    while first < count && !interrupt::is_requested() {
        let these = PIECE.min(count - first);
        let part = |table: &'_ Vec<T>| {
            let width = table.len() / count;
            first * width..(first + these) * width
        };
        let inputs: Vec<&[T]> = states.inputs.iter().map(|table| &table[part(table)]).collect();
        for (array, found) in results.iter_mut().zip(kernel.compute(&inputs)?) {
            let width = array.width();
            array.values[first * width..][..these * width].copy_from_slice(&found);
        }
        for state in first..first + these {
            recheck(query, model, states, &mut results, state)?;
        }
        first += these;
        progress.at(first);
    }
    let seconds = start.elapsed().as_secs_f64();
    results.iter_mut().for_each(|array| array.truncate(first));
    Ok((results, seconds))
}

/// The kernel takes each quaternion for one of length 1.
fn check_orientations<T: Precision>(model: &Model, states: &States<T>) -> Result<()> {
    let nq = model.nq();
    if nq == model.n() {
        return Ok(());
    }
    for (state, row) in states.inputs[0].chunks_exact(nq).enumerate() {
        let theta: Vec<f64> = row.iter().map(|&x| x.into()).collect();
        let at = |error| Failure::wrong(format!("{}: {error}", states.samples.place(state)));
        model.check_configuration(&theta).map_err(at)?;
    }
    Ok(())
}

/// A state that gave NaN, although it has none, is computed again by the CPU, whose error names the joint.
fn recheck<T: Precision>(
    query: Query,
    model: &Model,
    states: &States<T>,
    results: &mut [Array<T>],
    state: usize,
) -> Result<()> {
    let row =
        |values: &[T], width: usize| values[state * width..][..width].iter().map(|&x| x.into()).collect::<Vec<f64>>();
    let is_nan = |array: &Array<T>| row(&array.values, array.width()).iter().any(|x: &f64| x.is_nan());
    if !results.iter().any(is_nan) {
        return Ok(());
    }
    let inputs = states.inputs.iter().map(|table| row(table, table.len() / states.samples.count));
    let inputs: Vec<Vec<f64>> = inputs.collect();
    if inputs.iter().flatten().any(|x| !x.is_finite()) {
        return Ok(());
    }
    let slices: Vec<&[f64]> = inputs.iter().map(Vec::as_slice).collect();
    let found = model
        .compute(query, &slices, &model.environment())
        .map_err(|error| Failure::wrong(format!("{}: {error}", states.samples.place(state))))?;
    for (array, found) in results.iter_mut().zip(found) {
        let width = array.width();
        let to = array.values[state * width..][..width].iter_mut();
        to.zip(found).for_each(|(to, x)| *to = T::from_f64(x));
    }
    Ok(())
}
