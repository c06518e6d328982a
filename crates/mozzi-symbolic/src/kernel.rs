//! A kernel on symbols.

use crate::error::Error;
use crate::symbol::{Symbol, with_table};
use crate::table::Fault;
use mozzi::quantities::{Memory, Query};
use mozzi::{Environment, FrameId, Model, Scalar, Wrench};

/// Fails if an operation left the polynomials.
pub(crate) fn check_fault(quantity: &'static str) -> Result<(), Error> {
    match with_table(|table| table.fault.take()) {
        None => Ok(()),
        Some(Fault::Left(what)) => Err(Error::NotPolynomial { quantity, what }),
        Some(Fault::TooLong(terms)) => Err(Error::TooLong { quantity, terms }),
    }
}

/// The quantity's outputs on symbols; the last input is the wrench of the tip, if there is one.
pub(crate) fn kernel(
    query: &Query,
    model: &Model<Symbol>,
    inputs: &[Vec<Symbol>],
    tip: Option<FrameId>,
) -> Vec<Vec<Symbol>> {
    let mut outputs: Vec<Vec<Symbol>> =
        query.output_lengths(model).map(|length| vec![Symbol::zero(); length]).collect();
    let mut slices: Vec<&mut [Symbol]> = outputs.iter_mut().map(Vec::as_mut_slice).collect();
    let (inputs, wrench) = inputs.split_at(query.declaration().inputs.len());
    let applied: Vec<(FrameId, Wrench<Symbol>)> =
        tip.into_iter().zip(wrench).map(|(tip, F)| (tip, Wrench::from_array(std::array::from_fn(|k| F[k])))).collect();
    let environment = Environment { applied: &applied, ..model.environment() };
    let inputs: Vec<&[Symbol]> = inputs.iter().map(Vec::as_slice).collect();
    query.evaluate(model, &inputs, &environment, &mut Memory::new(model), &mut slices);
    outputs
}
