//! Quantities that a robot does not have, such as those of the inverse of a singular mass matrix: a list that nobody
//! gave is without them.

use crate::failure;
use crate::quantity::hyphenated;
use mozzi::quantities::{Of, Query};
use mozzi::random::Random;
use mozzi::{Error, Model};
use std::collections::BTreeMap;

/// Names of quantities by the reason why they are left out.
#[derive(Default)]
pub struct Missing(BTreeMap<String, Vec<String>>);

impl Missing {
    /// The result, if there is one; an error is kept as the quantity's reason.
    pub fn keep<T>(&mut self, query: &Query, found: Result<T, Error>) -> Option<T> {
        found.map_err(|error| self.0.entry(error.to_string()).or_default().push(hyphenated(query.name()))).ok()
    }

    /// A note for each reason.
    pub fn note(&self) {
        for (reason, names) in &self.0 {
            failure::note(&format!("no {}: {reason}", names.join(", ")));
        }
    }
}

/// The quantities that the robot has in a random state at rest; those of a task need rows that the robot can move.
pub fn those_of<'q>(queries: Vec<Query<'q>>, model: &Model) -> Vec<Query<'q>> {
    let mut theta: Vec<f64> = model.neutral_configuration();
    mozzi::model::integrate(model, &mut theta, &Random(1).vector(model.n(), 1.0), 1.0);
    let mut missing = Missing::default();
    let mut has = |query: &Query| {
        if query.declaration().of == Of::Task {
            return true;
        }
        let inputs = query.declaration().inputs.iter().zip(query.input_lengths(model));
        let inputs =
            inputs.map(|(input, length)| if input.name == "theta" { theta.clone() } else { vec![0.0; length] });
        let inputs: Vec<Vec<f64>> = inputs.collect();
        let slices: Vec<&[f64]> = inputs.iter().map(Vec::as_slice).collect();
        missing.keep(query, model.compute(*query, &slices, &model.environment())).is_some()
    };
    let kept = queries.into_iter().filter(&mut has).collect();
    missing.note();
    kept
}
