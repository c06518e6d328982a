//! What is computed.

use mozzi::Model;

/// A quantity of the tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    InverseDynamics,
    ForwardDynamics,
    MassMatrix,
    CoriolisMatrix,
    BiasForces,
    InverseDynamicsDerivatives,
    ForwardDynamicsDerivatives,
}

impl Quantity {
    /// In the order of the tables.
    pub const ALL: [Quantity; 7] = [
        Quantity::InverseDynamics,
        Quantity::ForwardDynamics,
        Quantity::MassMatrix,
        Quantity::CoriolisMatrix,
        Quantity::BiasForces,
        Quantity::InverseDynamicsDerivatives,
        Quantity::ForwardDynamicsDerivatives,
    ];

    /// As mozzi's function is called.
    pub fn name(self) -> &'static str {
        match self {
            Quantity::InverseDynamics => "inverse_dynamics",
            Quantity::ForwardDynamics => "forward_dynamics",
            Quantity::MassMatrix => "mass_matrix",
            Quantity::CoriolisMatrix => "coriolis_matrix",
            Quantity::BiasForces => "bias_forces",
            Quantity::InverseDynamicsDerivatives => "inverse_dynamics_derivatives",
            Quantity::ForwardDynamicsDerivatives => "forward_dynamics_derivatives",
        }
    }

    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|quantity| quantity.name() == name)
    }

    /// How many n × n matrices it is; 0 for a vector.
    pub fn matrices(self) -> usize {
        match self {
            Quantity::InverseDynamics | Quantity::ForwardDynamics | Quantity::BiasForces => 0,
            Quantity::MassMatrix | Quantity::CoriolisMatrix => 1,
            Quantity::InverseDynamicsDerivatives | Quantity::ForwardDynamicsDerivatives => 3,
        }
    }

    /// How many numbers it is, matrices by rows.
    pub fn length(self, model: &Model) -> usize {
        let n = model.n();
        if self.matrices() > 0 { self.matrices() * n * n } else { n }
    }

    /// The largest difference over the largest entry, of the vector or of each matrix; NaN where something is.
    pub fn difference(self, x: &[f64], reference: &[f64]) -> f64 {
        let block = reference.len() / self.matrices().max(1);
        let largest = |worst: f64, x: f64| if x <= worst { worst } else { x }; // NaN stays
        let mut worst = 0.0;
        for (x, reference) in x.chunks_exact(block).zip(reference.chunks_exact(block)) {
            let size = reference.iter().map(|y| y.abs()).fold(0.0, largest);
            let difference = x.iter().zip(reference).map(|(x, y)| (x - y).abs()).fold(0.0, largest);
            worst = largest(worst, difference / size);
        }
        worst
    }
}
