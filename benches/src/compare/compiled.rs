//! mozzi's machine code for the one robot.

use crate::contestant::Contestant;
use crate::quantity::Quantity;
use mozzi::Model;
use mozzi_batch::{Batch, InstructionSet};
use mozzi_benches::{State, States};
use mozzi_codegen::{Arguments, Compiled, Kernel, Quantity as Code, Shape, compile};
use std::hint::black_box;
use std::time::Instant;

/// What there is machine code for.
pub fn code(quantity: Quantity) -> Option<Code> {
    Some(match quantity {
        Quantity::InverseDynamics => Code::InverseDynamics,
        Quantity::ForwardDynamics => Code::ForwardDynamics,
        Quantity::MassMatrix => Code::MassMatrix,
        Quantity::BiasForces => Code::BiasForces,
        Quantity::InverseDynamicsDerivatives => Code::InverseDynamicsDerivatives,
        Quantity::ForwardDynamicsDerivatives => Code::ForwardDynamicsDerivatives,
        Quantity::CoriolisMatrix => return None,
    })
}

/// Of its machine code of this shape, where there is one.
pub fn flops(model: &Model, code: Code, shape: Shape) -> Option<usize> {
    Some(Kernel::new(&code.record(model, Arguments::default()), shape).ok()?.flops())
}

/// One state a call.
pub struct OneState<'a> {
    robot: Compiled,
    /// Those that became machine code here, with the flops of their programs.
    quantities: Vec<(Quantity, Code, usize)>,
    states: Vec<State<'a>>,
    /// θ̈ of forward dynamics, and pivots: n numbers each; three matrices.
    vectors: [Vec<f64>; 2],
    matrices: [Vec<f64>; 3],
}

impl<'a> OneState<'a> {
    pub fn new(model: &'a Model, states: &'a States) -> Result<Self, String> {
        let n = model.n();
        let codes: Vec<Code> = Quantity::ALL.into_iter().filter_map(code).collect();
        let robot = compile(model, &codes).map_err(|error| error.to_string())?;
        let quantities = Quantity::ALL.into_iter().filter_map(|quantity| {
            let code = code(quantity)?;
            Some((quantity, code, flops(model, code, Shape::OneF64)?))
        });
        Ok(OneState {
            quantities: quantities.collect(),
            robot,
            states: states.iter().collect(),
            vectors: [(); 2].map(|()| vec![0.0; n]),
            matrices: [(); 3].map(|()| vec![0.0; n * n]),
        })
    }
}

#[inline(always)]
fn evaluate(robot: &Compiled, code: Code, state: State, [x, y]: [&mut [f64]; 2], [a, b, c]: [&mut [f64]; 3]) {
    let [theta, dtheta, ddtheta, tau] = state;
    match code {
        Code::InverseDynamics => robot.evaluate(code, &[theta, dtheta, ddtheta], &mut [x]),
        Code::ForwardDynamics => robot.evaluate(code, &[theta, dtheta, tau], &mut [x, y]),
        Code::MassMatrix => robot.evaluate(code, &[theta], &mut [a]),
        Code::InverseDynamicsDerivatives => robot.evaluate(code, &[theta, dtheta, ddtheta], &mut [a, b, c]),
        Code::ForwardDynamicsDerivatives => robot.evaluate(code, &[theta, dtheta, tau], &mut [x, a, b, c, y]),
        _ => robot.evaluate(code, &[theta, dtheta], &mut [x]),
    }
}

impl Contestant for OneState<'_> {
    fn algorithms(&self) -> Vec<(Quantity, String)> {
        self.quantities.iter().map(|&(quantity, ..)| (quantity, String::new())).collect()
    }

    fn flops(&self, algorithm: usize) -> Option<usize> {
        Some(self.quantities[algorithm].2)
    }

    fn run(&mut self, algorithm: usize) {
        let code = self.quantities[algorithm].1;
        for &state in &self.states {
            let (vectors, matrices) = (self.vectors.each_mut(), self.matrices.each_mut());
            evaluate(&self.robot, code, black_box(state), vectors.map(|x| &mut x[..]), matrices.map(|x| &mut x[..]));
            black_box((&mut self.vectors, &mut self.matrices));
        }
    }

    fn result(&mut self, algorithm: usize, state: usize) -> Result<Vec<f64>, String> {
        let (quantity, code, _) = self.quantities[algorithm];
        let (vectors, matrices) = (self.vectors.each_mut(), self.matrices.each_mut());
        let state = self.states[state];
        evaluate(&self.robot, code, state, vectors.map(|x| &mut x[..]), matrices.map(|x| &mut x[..]));
        let matrices = self.matrices[..quantity.matrices()].concat();
        Ok(if matrices.is_empty() { self.vectors[0].clone() } else { matrices })
    }
}

/// The machine code for registers of this instruction set, on one thread.
pub fn many(model: &Model, set: InstructionSet) -> Option<Compiled> {
    let batch = Batch::new(model).with_instruction_set(set).and_then(|batch| batch.with_threads(1)).ok()?;
    Compiled::of(batch, &Quantity::ALL.into_iter().filter_map(code).collect::<Vec<_>>()).ok()
}

/// Milliseconds from a model to its first inverse dynamics by machine code, the least of a few.
pub fn to_first_result(model: &Model, states: &States) -> Option<f64> {
    let [theta, dtheta, ddtheta, _] = states.iter().next()?;
    let once = |_| {
        let start = Instant::now();
        let robot = compile(model, &[Code::InverseDynamics]).ok()?;
        black_box(robot.inverse_dynamics(theta, dtheta, ddtheta).ok()?);
        Some(start.elapsed().as_secs_f64() * 1e3)
    };
    (0..20).filter_map(once).min_by(f64::total_cmp)
}
