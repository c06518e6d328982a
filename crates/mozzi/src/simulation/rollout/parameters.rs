//! xᵀ∂θ̈/∂π.
//!
//! In M θ̈ + h = τ with forces Y π that are linear in π, a change of π alone changes θ̈ by −M⁻¹Y δπ at this θ̈, so that
//!
//! > xᵀ∂θ̈/∂π = −yᵀY(θ, θ̇, θ̈), y = M⁻¹x

use crate::fast;
use crate::model::{Environment, Model};
use crate::quantities::{Query, Regressor};
use alloc::vec;
use alloc::vec::Vec;

/// Memory for the vector-Jacobian products of forward dynamics by the [`parameters`](Model::parameters) π.
#[derive(Clone, Debug)]
pub struct ParameterVjp {
    workspace: fast::Workspace,
    /// Y, n × p; empty before the first use.
    regressor: Vec<f64>,
}

impl ParameterVjp {
    /// For robots like this one.
    pub fn new(model: &Model) -> Self {
        ParameterVjp { workspace: fast::Workspace::new(model), regressor: Vec::new() }
    }

    /// Adds −yᵀY at (θ, θ̇, θ̈) to the gradient, p numbers. Cost O(n p).
    ///
    /// # Panics
    /// When θ is not nq long, θ̇, θ̈ or y not n, or the gradient not p.
    pub fn add(
        &mut self,
        model: &Model,
        state: [&[f64]; 3],
        y: &[f64],
        environment: &Environment,
        gradient: &mut [f64],
    ) {
        let (n, p) = (model.n(), model.parameter_count());
        assert!(y.len() == n && gradient.len() == p, "expected y with {n} entries and a gradient with {p}");
        if self.regressor.is_empty() {
            self.regressor = vec![0.0; n * p];
        }
        let outputs = &mut [&mut self.regressor[..]];
        fast::evaluate(&Query::from(Regressor), model, &state, environment, &mut self.workspace, outputs);
        for (row, &y) in self.regressor.chunks_exact(p.max(1)).zip(y) {
            gradient.iter_mut().zip(row).for_each(|(sum, Y)| *sum -= y * Y);
        }
    }
}
