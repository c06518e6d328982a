//! mozzi at many states at once, on one thread: tables in rows, as a caller has them.

use crate::contestant::Contestant;
use crate::quantity::Quantity;
use mozzi::Model;
use mozzi_batch::{Batch, Error, InstructionSet, Surroundings};
use mozzi_benches::States;
use std::hint::black_box;

/// All states in one call.
pub struct Batched<'a> {
    model: &'a Model,
    batch: Batch,
    surroundings: Surroundings<'static>,
    /// θ, θ̇, θ̈, τ.
    tables: [Vec<f64>; 4],
    vectors: Vec<f64>,
    matrices: [Vec<f64>; 3],
}

impl<'a> Batched<'a> {
    /// None where the machine has no such registers.
    pub fn new(model: &'a Model, states: &States, set: InstructionSet) -> Option<Self> {
        let batch = Batch::new(model).with_instruction_set(set).and_then(|batch| batch.with_threads(1)).ok()?;
        let mut tables: [Vec<f64>; 4] = Default::default();
        for state in states.iter() {
            for (table, row) in tables.iter_mut().zip(state) {
                table.extend(row);
            }
        }
        let (n, count) = (model.n(), states.count());
        let matrices = [(); 3].map(|()| vec![0.0; count * n * n]);
        let surroundings = model.environment().into();
        Some(Batched { model, batch, surroundings, tables, vectors: vec![0.0; count * n], matrices })
    }

    fn evaluate(&mut self, quantity: Quantity) -> Result<(), Error> {
        let [theta, dtheta, ddtheta, tau] = self.tables.each_ref().map(|table| black_box(&table[..]));
        let (batch, around, x) = (&self.batch, &self.surroundings, &mut self.vectors[..]);
        let [a, b, c] = self.matrices.each_mut().map(|matrix| &mut matrix[..]);
        match quantity {
            Quantity::InverseDynamics => batch.inverse_dynamics(theta, dtheta, ddtheta, around, x),
            Quantity::ForwardDynamics => batch.forward_dynamics(theta, dtheta, tau, around, x),
            Quantity::MassMatrix => batch.mass_matrix(theta, a),
            Quantity::CoriolisMatrix => batch.coriolis_matrix(theta, dtheta, a),
            Quantity::BiasForces => batch.bias_forces(theta, dtheta, around, x),
            Quantity::InverseDynamicsDerivatives => {
                batch.inverse_dynamics_derivatives(theta, dtheta, ddtheta, around, a, b, c)
            }
            Quantity::ForwardDynamicsDerivatives => {
                batch.forward_dynamics_derivatives(theta, dtheta, tau, around, x, a, b, c)
            }
        }
    }
}

impl Contestant for Batched<'_> {
    fn algorithms(&self) -> Vec<(Quantity, String)> {
        Quantity::ALL.iter().map(|&quantity| (quantity, String::new())).collect()
    }

    fn run(&mut self, algorithm: usize) {
        let result = self.evaluate(Quantity::ALL[algorithm]);
        black_box((&mut self.vectors, &mut self.matrices));
        result.expect("states that were computed before"); // `result` found their errors
    }

    fn result(&mut self, algorithm: usize, state: usize) -> Result<Vec<f64>, String> {
        let quantity = Quantity::ALL[algorithm];
        if state == 0 {
            self.evaluate(quantity).map_err(|error| error.to_string())?; // of all states
        }
        let n = self.model.n();
        let part = |table: &[f64], width: usize| table[state * width..][..width].to_vec();
        let matrices = self.matrices[..quantity.matrices()].iter().map(|matrix| part(matrix, n * n));
        Ok(if quantity.matrices() > 0 { matrices.flatten().collect() } else { part(&self.vectors, n) })
    }
}
