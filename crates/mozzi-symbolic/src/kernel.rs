//! A kernel on symbols: its program, in which the robot's numbers are inputs.

use crate::error::Error;
use crate::symbol::{Symbol, with_table};
use crate::table::Fault;
use mozzi::quantities::Query;
use mozzi::{FrameId, Model};
use mozzi_engine::{Program, TooLong, record_numbers};

/// Fails if an operation left the polynomials.
pub(crate) fn check_fault(quantity: &'static str) -> Result<(), Error> {
    match with_table(|table| table.fault.take()) {
        None => Ok(()),
        Some(Fault::Left(what)) => Err(Error::NotPolynomial { quantity, what }),
        Some(Fault::TooLong([terms, most])) => Err(Error::TooLong { quantity, terms, most }),
    }
}

/// A quantity of a robot in symbols.
pub(crate) struct Kernel {
    program: Program,
    /// The robot's.
    numbers: Vec<Symbol>,
    /// The quantity's inputs; a tip's wrench is one more.
    inputs: usize,
}

impl Kernel {
    pub fn new(query: &Query, model: &Model<Symbol>, tip: Option<FrameId>) -> Result<Self, Error> {
        let quantity = query.name();
        let most = TooLong::MOST_STEPS;
        let too_long = |TooLong| Error::TooLong { quantity, terms: most, most };
        let (program, numbers) = record_numbers(model, *query, tip.as_slice()).map_err(too_long)?;
        Ok(Kernel { program, numbers, inputs: query.declaration().inputs.len() })
    }

    /// The outputs; the last input is the wrench of the tip, if there is one.
    pub fn outputs(&self, inputs: &[Vec<Symbol>]) -> Vec<Vec<Symbol>> {
        self.outputs_with(&self.numbers, inputs)
    }

    /// The outputs of the robot whose numbers these expressions give for its own.
    pub fn outputs_at(&self, number: &dyn Fn(Symbol) -> Symbol, inputs: &[Vec<Symbol>]) -> Vec<Vec<Symbol>> {
        let numbers = self.numbers.iter().map(|&x| number(x)).collect();
        self.outputs_with(&numbers, inputs)
    }

    fn outputs_with(&self, numbers: &Vec<Symbol>, inputs: &[Vec<Symbol>]) -> Vec<Vec<Symbol>> {
        let (state, wrench) = inputs.split_at(self.inputs);
        let all = state.iter().chain([numbers]).chain(wrench);
        self.program.evaluate(&all.map(Vec::as_slice).collect::<Vec<_>>())
    }
}
