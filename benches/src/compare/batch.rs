//! mozzi at many states at once, on one thread: tables in rows, as a caller has them, or in blocks.

use crate::compiled;
use crate::contestant::Contestant;
use crate::quantity::Quantity;
use mozzi::Model;
use mozzi_batch::{Batch, BatchEnvironment, Error, InstructionSet, Layout};
use mozzi_benches::States;
use mozzi_codegen::{Compiled, Engine, Shape};
use std::hint::black_box;

/// What computes them.
enum Means {
    Kernels(Batch, BatchEnvironment<'static>),
    MachineCode(Compiled),
}

impl Means {
    fn batch(&self) -> &Batch {
        match self {
            Means::Kernels(batch, _) => batch,
            Means::MachineCode(robot) => robot.batch(),
        }
    }
}

/// All states in one call.
pub struct Batched<'a> {
    model: &'a Model,
    means: Means,
    /// With the flops of their programs, where they have one.
    quantities: Vec<(Quantity, Option<usize>)>,
    /// θ, θ̇, θ̈, τ.
    tables: [Vec<f64>; 4],
    vectors: Vec<f64>,
    matrices: [Vec<f64>; 3],
}

impl<'a> Batched<'a> {
    /// By the kernels; none where the machine has no such registers, as in [`by_machine_code`](Self::by_machine_code).
    pub fn by_kernels(model: &'a Model, states: &States, set: InstructionSet, layout: Layout) -> Option<Self> {
        let batch = Batch::new(model).with_instruction_set(set).and_then(|batch| batch.with_threads(1)).ok()?;
        let batch = batch.with_layout(layout);
        let quantities = Quantity::ALL.map(|quantity| (quantity, None)).to_vec();
        Some(Self::new(model, states, Means::Kernels(batch, model.environment().into()), quantities))
    }

    pub fn by_machine_code(model: &'a Model, states: &States, set: InstructionSet) -> Option<Self> {
        let robot = compiled::many(model, set)?;
        let shape = if set == InstructionSet::Avx512 { Shape::EightF64 } else { Shape::FourF64 };
        let quantity = |quantity| {
            let code = compiled::code(quantity)?;
            let Engine::MachineCode(..) = robot.batch_engine(code) else { return None };
            Some((quantity, Some(compiled::flops(model, code, shape)?)))
        };
        let quantities = Quantity::ALL.into_iter().filter_map(quantity).collect();
        Some(Self::new(model, states, Means::MachineCode(robot), quantities))
    }

    fn new(model: &'a Model, states: &States, means: Means, quantities: Vec<(Quantity, Option<usize>)>) -> Self {
        let mut tables: [Vec<f64>; 4] = Default::default();
        for state in states.iter() {
            for (table, row) in tables.iter_mut().zip(state) {
                table.extend(row);
            }
        }
        let batch = means.batch();
        if batch.layout() == Layout::Blocks {
            let widths = [model.nq(), model.n(), model.n(), model.n()];
            tables.iter_mut().zip(widths).for_each(|(table, width)| *table = batch.to_blocks(table, width));
        }
        let (n, count) = (model.n(), states.count());
        let matrices = [(); 3].map(|()| vec![0.0; count * n * n]);
        Batched { model, means, quantities, tables, vectors: vec![0.0; count * n], matrices }
    }

    fn evaluate(&mut self, quantity: Quantity) -> Result<(), Error> {
        let [theta, dtheta, ddtheta, tau] = self.tables.each_ref().map(|table| black_box(&table[..]));
        let x = &mut self.vectors[..];
        let [a, b, c] = self.matrices.each_mut().map(|matrix| &mut matrix[..]);
        let (batch, around) = match &self.means {
            Means::Kernels(batch, around) => (batch, around),
            Means::MachineCode(robot) => {
                return match quantity {
                    Quantity::InverseDynamics => robot.inverse_dynamics_batch(theta, dtheta, ddtheta, x),
                    Quantity::ForwardDynamics => robot.forward_dynamics_batch(theta, dtheta, tau, x),
                    Quantity::MassMatrix => robot.mass_matrix_batch(theta, a),
                    Quantity::CoriolisMatrix => robot.batch().coriolis_matrix(theta, dtheta, a),
                    Quantity::BiasForces => robot.bias_forces_batch(theta, dtheta, x),
                    Quantity::InverseDynamicsDerivatives => {
                        robot.inverse_dynamics_derivatives_batch(theta, dtheta, ddtheta, a, b, c)
                    }
                    Quantity::ForwardDynamicsDerivatives => {
                        robot.forward_dynamics_derivatives_batch(theta, dtheta, tau, x, a, b, c)
                    }
                };
            }
        };
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
        self.quantities.iter().map(|&(quantity, _)| (quantity, String::new())).collect()
    }

    fn flops(&self, algorithm: usize) -> Option<usize> {
        self.quantities[algorithm].1
    }

    fn run(&mut self, algorithm: usize) {
        let result = self.evaluate(self.quantities[algorithm].0);
        black_box((&mut self.vectors, &mut self.matrices));
        result.expect("states that were computed before"); // `result` found their errors
    }

    fn result(&mut self, algorithm: usize, state: usize) -> Result<Vec<f64>, String> {
        let quantity = self.quantities[algorithm].0;
        if state == 0 {
            self.evaluate(quantity).map_err(|error| error.to_string())?; // of all states
        }
        let n = self.model.n();
        let batch = self.means.batch();
        let part = |table: &[f64], width: usize| match batch.layout() {
            Layout::Rows => table[state * width..][..width].to_vec(),
            Layout::Blocks => {
                batch.to_rows(&table[state / batch.lanes() * batch.lanes() * width..], width, batch.lanes())
                    [state % batch.lanes() * width..][..width]
                    .to_vec()
            }
        };
        let matrices = self.matrices[..quantity.matrices()].iter().map(|matrix| part(matrix, n * n));
        Ok(if quantity.matrices() > 0 { matrices.flatten().collect() } else { part(&self.vectors, n) })
    }
}
