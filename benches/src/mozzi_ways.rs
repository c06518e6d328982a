//! mozzi's ways to compute: each is one entry of the list.

use crate::batch::Batched;
use crate::compiled;
use crate::contestant::{Contestant, Entry};
use crate::peak::Width;
use crate::quantity::{self, Outputs, compared};
use crate::states::{States, inputs};
use mozzi::Model;
use mozzi::fast::{self, Workspace};
use mozzi::quantities::Query;
use mozzi_engine::{Shape, compile};
use std::hint::black_box;

/// All of them; the first is the unit of the tables.
pub fn all<'a>(model: &'a Model, states: &'a States) -> Result<Vec<Entry<'a>>, String> {
    let mut entries = Vec::new();
    for (name, mut workspace) in [("mozzi", Workspace::new(model)), ("portable", Workspace::portable(model))] {
        let (environment, quantities) = (model.environment(), quantity::of(model).map(|query| (query, None)).collect());
        let one = OneState::new(model, states, quantities, move |query, inputs, outputs| {
            fast::evaluate(query, model, inputs, &environment, &mut workspace, outputs);
        });
        entries.push(Entry { name: name.into(), width: Some(Width::Scalar), contestant: Box::new(one) });
    }
    let queries: Vec<Query> = quantity::of(model).collect();
    let robot = compile(model, &queries).map_err(|error| error.to_string())?;
    let quantities = compiled::quantities(model, |query| robot.engine(query));
    let one = OneState::new(model, states, quantities, move |query, inputs, outputs| {
        robot.evaluate(*query, inputs, outputs);
    });
    entries.push(Entry { name: "compiled".into(), width: Some(Width::Scalar), contestant: Box::new(one) });
    for (set, shape, width) in [("avx2", Shape::FourF64, Width::Four), ("avx512", Shape::EightF64, Width::Eight)] {
        let (name, batched) = (format!("arrays {set}"), Batched::new(model, states, shape));
        entries.extend(batched.map(|batched| Entry { name, width: Some(width), contestant: Box::new(batched) }));
    }
    Ok(entries)
}

/// One call for each state.
struct OneState<'a, F> {
    model: &'a Model,
    /// With the flops of their programs, if they have any.
    quantities: Vec<(Query<'static>, Option<usize>)>,
    /// The inputs of each quantity at each state.
    inputs: Vec<Vec<Vec<&'a [f64]>>>,
    evaluate: F,
    outputs: Outputs,
}

impl<'a, F: FnMut(&Query, &[&[f64]], &mut [&mut [f64]])> OneState<'a, F> {
    fn new(
        model: &'a Model,
        states: &'a States,
        quantities: Vec<(Query<'static>, Option<usize>)>,
        evaluate: F,
    ) -> Self {
        let at_states = |&(query, _): &(Query, _)| states.iter().map(|state| inputs(query, state)).collect();
        let inputs = quantities.iter().map(at_states).collect();
        OneState { model, quantities, inputs, evaluate, outputs: Outputs::new(model, 1) }
    }
}

impl<F: FnMut(&Query, &[&[f64]], &mut [&mut [f64]])> Contestant for OneState<'_, F> {
    fn algorithms(&self) -> Vec<(Query<'static>, String)> {
        self.quantities.iter().map(|&(query, _)| (query, String::new())).collect()
    }

    fn flops(&self, algorithm: usize) -> Option<usize> {
        self.quantities[algorithm].1
    }

    fn run(&mut self, algorithm: usize) {
        let query = self.quantities[algorithm].0;
        let mut outputs = self.outputs.of(query, self.model);
        for inputs in &self.inputs[algorithm] {
            (self.evaluate)(&query, black_box(inputs), &mut outputs);
            black_box(&mut outputs);
        }
    }

    fn result(&mut self, algorithm: usize, state: usize) -> Result<Vec<f64>, String> {
        let query = self.quantities[algorithm].0;
        let mut outputs = self.outputs.of(query, self.model);
        (self.evaluate)(&query, &self.inputs[algorithm][state], &mut outputs);
        Ok(compared(query).flat_map(|place| outputs[place].to_vec()).collect())
    }
}
