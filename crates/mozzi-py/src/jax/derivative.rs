//! A quantity y = f(x) at one state, with x its inputs and, if they vary, the inertial parameters π; and its first and
//! second derivatives in the forms that JAX asks for, always with respect to the numbers of the arrays:
//!
//! | directions | x̄ wanted | result |
//! |---|---|---|
//! | – | no | f(x) |
//! | u | no | ∂f u |
//! | u, v | no | ∂²f(u, v) |
//! | – | yes | wᵀ∂f |
//! | u | yes | wᵀ∂²f u |
//!
//! A direction is the derivative of a dual number; a vector-Jacobian product is the quantity's own kernel if it has
//! one. For π, τ = Yπ and Mθ̈ + … = Yπ give wᵀ∂τ/∂π = wᵀY and wᵀ∂θ̈/∂π = −(M⁻¹w)ᵀY.

use super::evaluate::{Evaluate, Scratch};
use super::registry::Entry;
use super::tangent::position_gradient;
use mozzi::quantities::{ForwardDynamics, ForwardDynamicsVjp, InverseDynamics, InverseDynamicsVjp, Query, Regressor};
use mozzi::{Dual, Scalar};

/// Which derivative, of which quantity.
pub struct Derivative<'a> {
    pub entry: &'a Entry,
    pub query: Query<'a>,
    /// Whether the last of the arguments is π.
    pub has_parameters: bool,
    /// A bit for each argument whose gradient is wanted; 0 for no gradient.
    pub wanted: i64,
}

type Lists<S> = Vec<Vec<S>>;

/// The quantity's kernel of wᵀ∂f.
pub fn vjp_of(query: &Query) -> Option<Query<'static>> {
    let is = |other: Query| query.index() == other.index();
    if is(InverseDynamics.into()) {
        Some(InverseDynamicsVjp.into())
    } else if is(ForwardDynamics.into()) {
        Some(ForwardDynamicsVjp.into())
    } else {
        None
    }
}

/// x + u ε.
fn moved<S: Scalar>(x: &[Vec<S>], u: &[Vec<S>]) -> Lists<Dual<S>> {
    x.iter().zip(u).map(|(x, u)| Dual::list(x, u)).collect()
}

fn constants<S: Scalar>(x: &[Vec<S>]) -> Lists<Dual<S>> {
    x.iter().map(|x| Dual::constants(x)).collect()
}

fn derivatives<S: Scalar>(y: Lists<Dual<S>>) -> Lists<S> {
    y.into_iter().map(|y| y.into_iter().map(|y| y.derivative).collect()).collect()
}

impl Derivative<'_> {
    /// The result at x, along these directions and, for a gradient, with w.
    ///
    /// # Errors
    /// If there is no such derivative, or the mass matrix is singular.
    pub fn at(
        &self,
        x: &[Vec<f64>],
        along: [Option<Lists<f64>>; 2],
        w: &[Vec<f64>],
        scratch: &mut Scratch,
    ) -> Result<Lists<f64>, String> {
        self.check(x)?;
        match (along, self.wanted) {
            ([None, _], 0) => self.evaluate(self.query, x, &[], scratch),
            ([Some(u), None], 0) => Ok(derivatives(self.evaluate(self.query, &moved(x, &u), &[], scratch)?)),
            ([Some(u), Some(v)], 0) => {
                // x + u ε₁ + v ε₂
                let x = moved(&moved(x, &u), &constants(&v));
                Ok(derivatives(derivatives(self.evaluate(self.query, &x, &[], scratch)?)))
            }
            ([None, _], _) => self.gradient(x, w, scratch),
            ([Some(u), None], _) => Ok(derivatives(self.gradient(&moved(x, &u), &constants(w), scratch)?)),
            _ => Err(format!("{} has no third derivatives", self.query.name())),
        }
    }

    /// Checks quaternions and, if the quantity divides by pivots, the pivots.
    fn check(&self, x: &[Vec<f64>]) -> Result<(), String> {
        let Derivative { entry, query, .. } = self;
        let state: Vec<&[f64]> = self.state(x);
        let environment = entry.model.environment();
        query.check(&entry.model, &state, &environment).map_err(|error| error.to_string())?;
        if query.declaration().divides {
            let other = self.parameters(x).map(|parameters| entry.model.with_parameters(parameters));
            let model = other.as_ref().unwrap_or(&entry.model);
            model.compute(*query, &state, &environment).map_err(|error| error.to_string())?;
        }
        Ok(())
    }

    /// The quantity's inputs.
    fn state<'x, S>(&self, x: &'x [Vec<S>]) -> Vec<&'x [S]> {
        x[..self.query.declaration().inputs.len()].iter().map(Vec::as_slice).collect()
    }

    fn parameters<'x, S>(&self, x: &'x [Vec<S>]) -> Option<&'x [S]> {
        x.last().filter(|_| self.has_parameters).map(Vec::as_slice)
    }

    /// A quantity at the inputs of this one, and these further ones.
    fn evaluate<S: Evaluate>(
        &self,
        query: Query,
        x: &[Vec<S>],
        further: &[&[S]],
        scratch: &mut Scratch,
    ) -> Result<Lists<S>, String> {
        let other = self.parameters(x).map(|parameters| self.entry.model.with_parameters(parameters));
        let model = other.as_ref().unwrap_or_else(|| S::model(self.entry));
        let mut inputs = self.state(x);
        inputs.extend(further);
        let mut outputs: Lists<S> = query.output_lengths(model).map(|length| vec![S::zero(); length]).collect();
        let mut slices: Vec<&mut [S]> = outputs.iter_mut().map(Vec::as_mut_slice).collect();
        S::evaluate(&query, model, &inputs, scratch, &mut slices)?;
        Ok(outputs)
    }

    /// wᵀ∂f, of the wanted arguments.
    fn gradient<S: Evaluate>(&self, x: &[Vec<S>], w: &[Vec<S>], scratch: &mut Scratch) -> Result<Lists<S>, String>
    where
        Dual<S>: Evaluate,
    {
        let is_wanted = |k: usize| self.wanted >> k & 1 == 1;
        let Some(vjp) = vjp_of(&self.query) else { return self.gradient_by_directions(x, w, scratch) };
        let mut all = self.evaluate(vjp, x, &[&w[0]], scratch)?;
        let mut by_positions = vec![S::zero(); x[0].len()];
        position_gradient(&self.entry.model, &x[0], &all[0], &mut by_positions);
        if self.has_parameters && is_wanted(3) {
            let (accelerations, y, sign) = match self.query.index() == Query::from(InverseDynamics).index() {
                true => (x[2].clone(), &w[0], S::one()),
                false => (self.evaluate(self.query, x, &[], scratch)?.remove(0), &all[2], -S::one()),
            };
            let motion = [x[0].clone(), x[1].clone(), accelerations, x[3].clone()];
            let Y = self.evaluate(Regressor.into(), &motion, &[], scratch)?.remove(0);
            let mut by_parameters = vec![S::zero(); x[3].len()];
            for (row, &y) in Y.chunks_exact(by_parameters.len().max(1)).zip(y) {
                by_parameters.iter_mut().zip(row).for_each(|(sum, &entry)| *sum += sign * y * entry);
            }
            all.push(by_parameters);
        }
        all[0] = by_positions;
        Ok(all.into_iter().enumerate().filter(|&(k, _)| is_wanted(k)).map(|(_, list)| list).collect())
    }

    /// wᵀ∂f of a quantity without a kernel for it: one direction after the other.
    fn gradient_by_directions<S: Evaluate>(
        &self,
        x: &[Vec<S>],
        w: &[Vec<S>],
        scratch: &mut Scratch,
    ) -> Result<Lists<S>, String>
    where
        Dual<S>: Evaluate,
    {
        let mut x = constants(x);
        let mut gradients = Vec::new();
        for k in (0..x.len()).filter(|k| self.wanted >> k & 1 == 1) {
            let mut gradient = Vec::with_capacity(x[k].len());
            for entry in 0..x[k].len() {
                x[k][entry].derivative = S::one();
                let y = derivatives(self.evaluate(self.query, &x, &[], scratch)?);
                x[k][entry].derivative = S::zero();
                let products = w.iter().flatten().zip(y.iter().flatten());
                gradient.push(products.fold(S::zero(), |sum, (&w, &y)| sum + w * y));
            }
            gradients.push(gradient);
        }
        Ok(gradients)
    }
}
