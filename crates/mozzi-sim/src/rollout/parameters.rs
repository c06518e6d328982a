//! xᵀ∂θ̈/∂π.
//!
//! In M θ̈ + h = τ with forces Y π that are linear in π, a change of π alone changes θ̈ by −M⁻¹Y δπ at this θ̈, so that
//!
//! > xᵀ∂θ̈/∂π = −yᵀY(θ, θ̇, θ̈), y = M⁻¹x
//!
//! which is [`inverse_dynamics_parameter_vjp`](mozzi::dynamics::inverse_dynamics_parameter_vjp()) of y. A stage knows
//! θ̈ and y.

use alloc::vec;
use alloc::vec::Vec;
use mozzi::fast;
use mozzi::model::{Environment, Model};
use mozzi::quantities::{InverseDynamicsParameterVjp, Query};

/// Memory for the vector-Jacobian products of forward dynamics with respect to the [`parameters`](Model::parameters) π.
#[derive(Clone, Debug)]
pub struct ParameterGradient {
    workspace: fast::Workspace,
    /// The products with respect to π, placements, axes and gravity; empty before the first use.
    products: [Vec<f64>; 4],
}

impl ParameterGradient {
    /// Scratch memory for this model.
    pub fn new(model: &Model) -> Self {
        ParameterGradient { workspace: fast::Workspace::new(model), products: Default::default() }
    }

    /// Adds −yᵀY at (θ, θ̇, θ̈) to the gradient, p numbers. Cost O(n).
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
        let query = Query::from(InverseDynamicsParameterVjp);
        assert!(gradient.len() == model.parameter_count(), "expected {} entries", model.parameter_count());
        if self.products[3].is_empty() {
            let mut lengths = query.output_lengths(model);
            self.products = core::array::from_fn(|_| vec![0.0; lengths.next().unwrap_or(0)]);
        }
        let [a, b, c, d] = &mut self.products;
        let (inputs, outputs) = ([theta, dtheta, ddtheta, y], &mut [&mut a[..], &mut b[..], &mut c[..], &mut d[..]]);
        fast::evaluate(&query, model, &inputs, environment, &mut self.workspace, outputs);
        gradient.iter_mut().zip(&self.products[0]).for_each(|(sum, product)| *sum -= product);
    }
}
