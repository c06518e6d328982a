//! mozzi at many states at once, on one thread.

use crate::compiled;
use crate::contestant::Contestant;
use crate::quantity::{self, Outputs, compared};
use crate::states::{States, inputs};
use mozzi::Model;
use mozzi::quantities::Query;
use mozzi_engine::{Batch, Error, Shape};
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
    /// By machine code of this shape; none if the machine cannot run it.
    pub fn new(model: &Model, states: &States, shape: Shape) -> Option<Self> {
        let batch = Batch::new(model).with_shape(shape).and_then(|batch| batch.with_threads(1)).ok()?;
        let batch = batch.compile(&quantity::of(model).collect::<Vec<_>>()).ok()?;
        let quantities = compiled::quantities(model, |query| batch.engine(query));
        let mut tables: [Vec<f64>; 4] = Default::default();
        for state in states.iter() {
            for (table, row) in tables.iter_mut().zip(state) {
                table.extend(row);
            }
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
        let widths: Vec<usize> = query.output_lengths(self.batch.model()).collect();
        let tables = self.outputs.of(query, self.batch.model());
        let part = |place: usize| tables[place][state * widths[place]..][..widths[place]].to_vec();
        Ok(compared(query).flat_map(part).collect())
    }
}
