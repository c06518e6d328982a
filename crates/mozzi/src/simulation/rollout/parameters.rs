//! xᵀ∂θ̈/∂π of the stages of a step: −yᵀ∂τ/∂π at this θ̈, y = M⁻¹x being known from xᵀ∂θ̈/∂τ. See
//! [`forward_dynamics_parameter_vjp`](crate::forward_dynamics_parameter_vjp()).

use crate::fast;
use crate::model::{Environment, Model};
use crate::quantities::{InverseDynamicsParameterVjp, Query};
use alloc::vec;
use alloc::vec::Vec;

/// Memory for the vector-Jacobian products of forward dynamics by the [`parameters`](Model::parameters) π.
#[derive(Clone, Debug)]
pub struct ParameterVjp {
    workspace: fast::Workspace,
    minus_y: Vec<f64>,
    /// By π, placements, axes and gravity; empty before the first use.
    found: [Vec<f64>; 4],
}

impl ParameterVjp {
    /// For robots like this one.
    pub fn new(model: &Model) -> Self {
        let found = core::array::from_fn(|_| Vec::new());
        ParameterVjp { workspace: fast::Workspace::new(model), minus_y: vec![0.0; model.n()], found }
    }

    /// Adds −yᵀ∂τ/∂π at (θ, θ̇, θ̈) to the gradient, p numbers. Cost O(n).
    ///
    /// # Panics
    /// When θ is not nq long, θ̇, θ̈ or y not n, or the gradient not p.
    pub fn add(
        &mut self,
        model: &Model,
        [theta, dtheta, ddtheta]: [&[f64]; 3],
        y: &[f64],
        environment: &Environment,
        gradient: &mut [f64],
    ) {
        let (n, p) = (model.n(), model.parameter_count());
        assert!(y.len() == n && gradient.len() == p, "expected y with {n} entries and a gradient with {p}");
        let query = Query::from(InverseDynamicsParameterVjp);
        for (found, length) in self.found.iter_mut().zip(query.output_lengths(model)) {
            found.resize(length, 0.0);
        }
        self.minus_y.iter_mut().zip(y).for_each(|(minus_y, y)| *minus_y = -y);
        let inputs = [theta, dtheta, ddtheta, &self.minus_y];
        let mut outputs = self.found.each_mut().map(Vec::as_mut_slice);
        fast::evaluate(&query, model, &inputs, environment, &mut self.workspace, &mut outputs);
        gradient.iter_mut().zip(&self.found[0]).for_each(|(sum, entry)| *sum += entry);
    }
}
