//! One quantity at random states, computed in each available way.

use super::timing::Way;
use crate::failure::Result;
use crate::tables::array::Array;
use crate::tables::precision::Precision;
use crate::tables::results::arrays;
use mozzi::quantities::{MOST_INPUTS, MOST_OUTPUTS, Query};
use mozzi::random::Random;
use mozzi::{Environment, FrameId, Model, Wrench, fast};
use mozzi_engine::{Batch, BatchEnvironment};
use std::hint::black_box;

/// States that are computed one by one.
const ONE_BY_ONE: usize = 1024;

/// Random states: θ, θ̇, and a further vector.
pub struct Data<T> {
    tables: [Vec<T>; 3],
    wrenches: Vec<T>,
}

impl Data<f64> {
    /// θ, θ̇ and what else the quantities take of each state, at most `widest` numbers.
    pub fn new(model: &Model, states: usize, widest: usize) -> Self {
        let mut random = Random(1);
        let mut numbers = |count: usize| random.vector(count, 1.0);
        let theta = (0..states).flat_map(|_| {
            let mut theta: Vec<f64> = model.neutral_configuration();
            mozzi::model::integrate(model, &mut theta, &numbers(model.n()), 1.0);
            theta
        });
        let theta = theta.collect();
        let tables = [theta, numbers(states * model.n()), numbers(states * widest)];
        Data { tables, wrenches: numbers(states * 6) }
    }

    pub fn to_f32(&self) -> Data<f32> {
        let rounded = |table: &Vec<f64>| table.iter().map(|&x| x as f32).collect();
        Data { tables: self.tables.each_ref().map(rounded), wrenches: rounded(&self.wrenches) }
    }
}

impl<T> Data<T> {
    fn states(&self) -> usize {
        self.wrenches.len() / 6
    }

    /// A quantity's inputs.
    fn inputs(&self, query: &Query, model: &Model) -> Vec<&[T]> {
        let place = |name: &str| ["theta", "dtheta"].iter().position(|known| *known == name).unwrap_or(2);
        let inputs = query.declaration().inputs.iter().zip(query.input_lengths(model));
        inputs.map(|(input, length)| &self.tables[place(input.name)][..self.states() * length]).collect()
    }
}

/// A repeatable computation of all states.
pub struct Run<'a> {
    pub way: Way,
    pub states: usize,
    compute: Compute<'a>,
    engine: Box<dyn Fn() -> String + 'a>,
}

/// A run; returns the outputs as f64 if its argument is `true`.
type Compute<'a> = Box<dyn FnMut(bool) -> Result<Vec<Vec<f64>>> + 'a>;

impl Run<'_> {
    pub fn run(&mut self) -> Result<()> {
        (self.compute)(false).map(drop)
    }

    /// The engine of the last run.
    pub fn engine(&self) -> String {
        (self.engine)()
    }

    /// All outputs.
    pub fn results(&mut self) -> Result<Vec<Vec<f64>>> {
        (self.compute)(true)
    }
}

/// The quantity, and the frame that applies wrenches.
#[derive(Clone, Copy)]
pub struct Subject<'a> {
    pub model: &'a Model,
    pub query: Query<'a>,
    pub tip: Option<FrameId>,
}

impl<'a> Subject<'a> {
    /// One state at a time, then all in a call in each precision, on one thread and on several.
    pub fn runs(self, threads: usize, data: &'a Data<f64>, single: &'a Data<f32>) -> Result<Vec<Run<'a>>> {
        let mut runs = vec![self.one_by_one(data)];
        let mut counts = vec![1, threads];
        counts.dedup();
        for threads in counts {
            runs.push(self.at_once(threads, data)?);
            runs.push(self.at_once(threads, single)?);
        }
        Ok(runs)
    }

    fn one_by_one(self, data: &'a Data<f64>) -> Run<'a> {
        let Subject { model, query, tip } = self;
        let count = data.states().min(ONE_BY_ONE);
        let mut workspace = fast::Workspace::new(model);
        let mut results: Vec<Array> = arrays(query, model, count);
        let compute: Compute = Box::new(move |is_asked| {
            let tables = data.inputs(&query, model);
            let mut rows: Vec<_> = results
                .iter_mut()
                .map(|array| (array.width(), array))
                .map(|(n, a)| a.values.chunks_exact_mut(n))
                .collect();
            let (inputs, outputs) = (tables.len(), rows.len());
            for state in 0..count {
                let F: [f64; 6] = std::array::from_fn(|k| data.wrenches[state * 6 + k]);
                let applied = tip.map(|tip| (tip, Wrench::from_array(F)));
                let environment = Environment { applied: applied.as_slice(), ..model.environment() };
                let given: [&[f64]; MOST_INPUTS] = std::array::from_fn(|k| {
                    let table = tables.get(k).copied().unwrap_or_default();
                    let width = table.len() / data.states();
                    &table[state * width..][..width]
                });
                let mut found: [&mut [f64]; MOST_OUTPUTS] =
                    std::array::from_fn(|k| rows.get_mut(k).and_then(Iterator::next).unwrap_or_default());
                let found = black_box(&mut found[..outputs]);
                fast::evaluate(&query, model, &given[..inputs], &environment, &mut workspace, found);
            }
            Ok(if is_asked { to_f64(&results) } else { Vec::new() })
        });
        let instructions = if fast::Workspace::new(model).is_fused(&query) { "fma" } else { "portable" };
        let engine = Box::new(move || format!("kernel ({instructions})"));
        Run { way: Way { is_one: true, precision: f64::NAME, threads: 1 }, states: count, compute, engine }
    }

    fn at_once<T: Precision>(self, threads: usize, data: &'a Data<T>) -> Result<Run<'a>> {
        let Subject { model, query, tip } = self;
        let batch = Batch::<T>::of(model).with_threads(threads)?;
        let shared = batch.clone();
        let engine = Box::new(move || {
            let wrenches: Vec<(FrameId, &[T])> = tip.map(|tip| (tip, &data.wrenches[..])).into_iter().collect();
            shared.engine_in(query, &BatchEnvironment::from(model.environment()).with_wrenches(&wrenches)).to_string()
        });
        let mut results: Vec<Array<T>> = arrays(query, model, data.states());
        let compute: Compute = Box::new(move |is_asked| {
            let wrenches: Vec<(FrameId, &[T])> = tip.map(|tip| (tip, &data.wrenches[..])).into_iter().collect();
            let environment = BatchEnvironment::from(model.environment()).with_wrenches(&wrenches);
            let mut outputs: Vec<&mut [T]> = results.iter_mut().map(|array| black_box(&mut array.values[..])).collect();
            batch.compute(query, &data.inputs(&query, model), &environment, &mut outputs)?;
            Ok(if is_asked { to_f64(&results) } else { Vec::new() })
        });
        Ok(Run { way: Way { is_one: false, precision: T::NAME, threads }, states: data.states(), compute, engine })
    }
}

fn to_f64<T: Precision>(results: &[Array<T>]) -> Vec<Vec<f64>> {
    results.iter().map(|array| array.values.iter().map(|&x| x.into()).collect()).collect()
}
