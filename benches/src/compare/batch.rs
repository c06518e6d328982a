//! mozzi at many states at once, on one thread: tables in rows, as callers have them, or in blocks.

use crate::compiled;
use crate::contestant::Contestant;
use crate::quantity::{self, Outputs, compared};
use mozzi::Model;
use mozzi::quantities::Query;
use mozzi_batch::{Batch, Error, InstructionSet, Layout};
use mozzi_benches::{States, inputs};
use std::hint::black_box;

/// All states in one call.
pub struct Batched {
    batch: Batch,
    /// With the flops of their programs, if they have any.
    quantities: Vec<(Query<'static>, Option<usize>)>,
    /// θ, θ̇, θ̈, τ.
    tables: [Vec<f64>; 4],
    outputs: Outputs,
}

impl Batched {
    /// By the kernels, or by machine code; none if the machine has no such registers.
    pub fn new(model: &Model, states: &States, set: InstructionSet, layout: Layout, is_compiled: bool) -> Option<Self> {
        let batch = Batch::new(model).with_instruction_set(set).and_then(|batch| batch.with_threads(1)).ok()?;
        let mut batch = batch.with_layout(layout);
        let mut quantities: Vec<_> = quantity::of(model).map(|query| (query, None)).collect();
        if is_compiled {
            batch = batch.compile(&quantity::of(model).collect::<Vec<_>>()).ok()?;
            quantities = compiled::quantities(model, |query| batch.engine(query));
        }
        let mut tables: [Vec<f64>; 4] = Default::default();
        for state in states.iter() {
            for (table, row) in tables.iter_mut().zip(state) {
                table.extend(row);
            }
        }
        if layout == Layout::Blocks {
            let widths = [model.nq(), model.n(), model.n(), model.n()];
            tables.iter_mut().zip(widths).for_each(|(table, width)| *table = batch.to_blocks(table, width));
        }
        let outputs = Outputs::new(model, states.count());
        Some(Batched { batch, quantities, tables, outputs })
    }

    fn evaluate(&mut self, query: Query) -> Result<(), Error> {
        let model = self.batch.model();
        let inputs = inputs(query, self.tables.each_ref().map(|table| black_box(&table[..])));
        let mut outputs = self.outputs.of(query, model);
        self.batch.compute(query, &inputs, &model.environment().into(), &mut outputs)
    }
}

impl Contestant for Batched {
    fn algorithms(&self) -> Vec<(Query<'static>, String)> {
        self.quantities.iter().map(|&(query, _)| (query, String::new())).collect()
    }

    fn flops(&self, algorithm: usize) -> Option<usize> {
        self.quantities[algorithm].1
    }

    fn run(&mut self, algorithm: usize) {
        let result = self.evaluate(self.quantities[algorithm].0);
        black_box(&mut self.outputs);
        result.expect("states that were computed before"); // `result` checked them for errors
    }

    fn result(&mut self, algorithm: usize, state: usize) -> Result<Vec<f64>, String> {
        let query = self.quantities[algorithm].0;
        if state == 0 {
            self.evaluate(query).map_err(|error| error.to_string())?; // of all states
        }
        let (batch, lanes) = (&self.batch, self.batch.lanes());
        let widths: Vec<usize> = query.output_lengths(batch.model()).collect();
        let tables = self.outputs.of(query, batch.model());
        let part = |place: usize| {
            let (table, width) = (&tables[place], widths[place]);
            match batch.layout() {
                Layout::Rows => table[state * width..][..width].to_vec(),
                Layout::Blocks => batch.to_rows(&table[state / lanes * lanes * width..], width, lanes)
                    [state % lanes * width..][..width]
                    .to_vec(),
            }
        };
        Ok(compared(query).flat_map(part).collect())
    }
}
