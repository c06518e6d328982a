//! mozzi's ways to compute: each is one entry of the list.

use crate::batch::Batched;
use crate::compiled;
use crate::contestant::{Contestant, Entry};
use crate::peak::Width;
use crate::quantity::Quantity;
use mozzi::fast::{self, Workspace};
use mozzi::{Environment, Model};
use mozzi_batch::{InstructionSet, Layout};
use mozzi_benches::{State, States};
use std::hint::black_box;

/// All of them; the first is the unit of the tables.
pub fn all<'a>(model: &'a Model, states: &'a States) -> Result<Vec<Entry<'a>>, String> {
    let one = |name: &str, workspace| {
        let contestant = Box::new(OneState::new(model, states, workspace));
        Entry { name: name.into(), width: Some(Width::Scalar), contestant }
    };
    let mut entries = vec![one("mozzi", Workspace::new(model)), one("portable", Workspace::portable(model))];
    let registers = [(InstructionSet::Avx2, Width::Four), (InstructionSet::Avx512, Width::Eight)];
    let mut many = |name: &str, set: InstructionSet, width, batched: Option<Batched<'a>>| {
        let name = format!("{name} {}", set.name());
        entries.extend(batched.map(|batched| Entry { name, width: Some(width), contestant: Box::new(batched) }));
    };
    for (set, width) in registers {
        many("batch", set, width, Batched::by_kernels(model, states, set, Layout::Rows));
    }
    for (set, width) in registers {
        many("blocks", set, width, Batched::by_kernels(model, states, set, Layout::Blocks));
    }
    for (set, width) in registers {
        many("compiled", set, width, Batched::by_machine_code(model, states, set));
    }
    let contestant = Box::new(compiled::OneState::new(model, states)?);
    entries.insert(2, Entry { name: "compiled".into(), width: Some(Width::Scalar), contestant });
    Ok(entries)
}

/// One state a call.
struct OneState<'a> {
    model: &'a Model,
    states: Vec<State<'a>>,
    environment: Environment<'static>,
    workspace: Workspace,
    /// n numbers, and three matrices after them.
    out: Vec<f64>,
}

impl<'a> OneState<'a> {
    fn new(model: &'a Model, states: &'a States, workspace: Workspace) -> Self {
        let n = model.n();
        let (environment, out) = (model.environment(), vec![0.0; n + 3 * n * n]);
        OneState { model, states: states.iter().collect(), environment, workspace, out }
    }
}

/// The result at one state: a vector at the start of `out`, matrices behind its first n numbers.
#[inline(always)]
fn evaluate(
    quantity: Quantity,
    model: &Model,
    [theta, dtheta, ddtheta, tau]: State,
    environment: &Environment,
    w: &mut Workspace,
    out: &mut [f64],
) {
    let n = model.n();
    let (x, matrices) = out.split_at_mut(n);
    match quantity {
        Quantity::InverseDynamics => fast::inverse_dynamics(model, theta, dtheta, ddtheta, environment, w, x),
        Quantity::ForwardDynamics => fast::forward_dynamics(model, theta, dtheta, tau, environment, w, x),
        Quantity::MassMatrix => fast::mass_matrix(model, theta, w, &mut matrices[..n * n]),
        Quantity::CoriolisMatrix => fast::coriolis_matrix(model, theta, dtheta, w, &mut matrices[..n * n]),
        Quantity::BiasForces => fast::bias_forces(model, theta, dtheta, environment, w, x),
        Quantity::InverseDynamicsDerivatives => {
            let by = three(matrices, n);
            fast::inverse_dynamics_derivatives(model, theta, dtheta, ddtheta, environment, w, by);
        }
        Quantity::ForwardDynamicsDerivatives => {
            let by = three(matrices, n);
            fast::forward_dynamics_derivatives(model, theta, dtheta, tau, environment, w, x, by);
        }
    }
}

/// Three n × n matrices.
pub fn three<T>(numbers: &mut [T], n: usize) -> [&mut [T]; 3] {
    let (a, rest) = numbers.split_at_mut(n * n);
    let (b, c) = rest.split_at_mut(n * n);
    [a, b, c]
}

impl Contestant for OneState<'_> {
    fn algorithms(&self) -> Vec<(Quantity, String)> {
        Quantity::ALL.iter().map(|&quantity| (quantity, String::new())).collect()
    }

    fn run(&mut self, algorithm: usize) {
        let quantity = Quantity::ALL[algorithm];
        for &state in &self.states {
            let state = black_box(state);
            evaluate(quantity, self.model, state, &self.environment, &mut self.workspace, &mut self.out);
            black_box(&mut self.out);
        }
    }

    fn result(&mut self, algorithm: usize, state: usize) -> Result<Vec<f64>, String> {
        let quantity = Quantity::ALL[algorithm];
        evaluate(quantity, self.model, self.states[state], &self.environment, &mut self.workspace, &mut self.out);
        let start = if quantity.matrices() > 0 { self.model.n() } else { 0 };
        Ok(self.out[start..start + quantity.length(self.model)].to_vec())
    }
}
