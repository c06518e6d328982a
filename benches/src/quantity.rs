//! The quantities that are compared.

use mozzi::Model;
use mozzi::quantities::{ConstrainedForwardDynamics, MOST_OUTPUTS, Query};

/// The quantities of the tables, in their order.
const QUANTITIES: [&str; 8] = [
    "inverse_dynamics",
    "forward_dynamics",
    "mass_matrix",
    "coriolis_matrix",
    "bias_forces",
    "inverse_dynamics_derivatives",
    "forward_dynamics_derivatives",
    "constrained_forward_dynamics",
];

/// Queries of them.
pub fn all() -> impl Iterator<Item = Query<'static>> {
    QUANTITIES.into_iter().map(|name| Query::named(name).expect("one of mozzi's"))
}

/// The quantities for a robot; a robot with constraints has only the constrained dynamics.
pub fn of(model: &Model) -> impl Iterator<Item = Query<'static>> {
    let is_constrained = model.constraint_rows() > 0;
    all().filter(move |&query| (query == ConstrainedForwardDynamics.into()) == is_constrained)
}

/// True if the outputs are matrices.
pub fn has_matrices(query: Query) -> bool {
    query.declaration().outputs.iter().any(|output| output.dims.len() == 2)
}

/// The indices of the compared outputs: if there are matrices, only these, because peers give nothing else.
pub fn compared(query: Query) -> impl Iterator<Item = usize> {
    let (outputs, is_matrix) = (query.declaration().outputs, has_matrices(query));
    // λ differs in signs and axes
    (0..outputs.len())
        .filter(move |&place| (outputs[place].dims.len() == 2) == is_matrix && outputs[place].name != "multipliers")
}

/// The count of those numbers, matrices by rows.
pub fn length(query: Query, model: &Model) -> usize {
    let lengths: Vec<usize> = query.output_lengths(model).collect();
    compared(query).map(|place| lengths[place]).sum()
}

/// The largest difference relative to the largest entry, of the vector or of each matrix; NaN if an entry is.
pub fn difference(query: Query, x: &[f64], reference: &[f64]) -> f64 {
    let block = reference.len() / compared(query).count();
    let largest = |worst: f64, x: f64| if x <= worst { worst } else { x }; // NaN stays
    let mut worst = 0.0;
    for (x, reference) in x.chunks_exact(block).zip(reference.chunks_exact(block)) {
        let size = reference.iter().map(|y| y.abs()).fold(0.0, largest);
        let difference = x.iter().zip(reference).map(|(x, y)| (x - y).abs()).fold(0.0, largest);
        worst = largest(worst, difference / size);
    }
    worst
}

/// Memory for the outputs of any quantity at some states.
pub struct Outputs {
    states: usize,
    arrays: [Vec<f64>; MOST_OUTPUTS],
}

impl Outputs {
    pub fn new(model: &Model, states: usize) -> Self {
        Outputs {
            states,
            arrays: [(); MOST_OUTPUTS]
                .map(|()| vec![0.0; states * (model.n() * model.n()).max(model.constraint_rows())]),
        }
    }

    /// In their order.
    pub fn of(&mut self, query: Query, model: &Model) -> Vec<&mut [f64]> {
        let lengths = query.output_lengths(model).map(|length| self.states * length);
        self.arrays.iter_mut().zip(lengths).map(|(array, length)| &mut array[..length]).collect()
    }
}
