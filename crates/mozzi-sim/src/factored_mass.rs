//! M = LᵀDL at a state of a simulation.

use crate::Error;
use alloc::format;
use alloc::vec;
use alloc::vec::Vec;
use mozzi::Workspace;
use mozzi::dynamics::mass_matrix;
use mozzi::linalg::ldlt;
use mozzi::model::Model;
use mozzi::scalar::Scalar;

/// M(θ), with an addition to its diagonal, factored along the robot's tree.
pub(crate) struct FactoredMass<'m> {
    model: &'m Model,
    pub workspace: Workspace,
    /// L and D.
    M: Vec<f64>,
    pivots: Vec<f64>,
    /// D^{−½}
    scale: Vec<f64>,
}

/// Where a vector of n numbers is not 0, from the last to the first.
#[derive(Default)]
pub(crate) struct Support {
    pub places: Vec<usize>,
    is_in: Vec<bool>,
}

impl<'m> FactoredMass<'m> {
    pub fn new(model: &'m Model) -> Self {
        let (n, workspace) = (model.n(), Workspace::new(model));
        FactoredMass { model, workspace, M: vec![0.0; n * n], pivots: vec![0.0; n], scale: vec![0.0; n] }
    }

    /// Computes and factors M(θ) + diag(s d).
    pub fn factor(&mut self, theta: &[f64], s: f64, d: &[f64]) -> Result<(), Error> {
        let n = self.model.n();
        mass_matrix(self.model, theta, &mut self.workspace, &mut self.M);
        d.iter().enumerate().for_each(|(j, d)| self.M[j * n + j] += s * d);
        ldlt::factor(self.model.pattern(), &mut self.M, &mut self.pivots);
        self.scale.iter_mut().zip(&self.pivots).for_each(|(scale, d)| *scale = 1.0 / Scalar::sqrt(*d));
        if self.pivots.iter().all(|d| *d > 0.0) {
            return Ok(());
        }
        let zeros = vec![0.0; n];
        // checks each pivot, and names the joint
        self.model.forward_dynamics_by_mass_matrix(theta, &zeros, &zeros, &self.model.environment())?;
        let found = format!("not positive definite at θ = {theta:?}");
        Err(Error::Model(mozzi::Error::BadArgument { what: "M(θ)", found, expected: "positive definite" }))
    }

    /// x ← M⁻¹x.
    pub fn divide(&self, x: &mut [f64]) {
        ldlt::solve(self.model.pattern(), &self.M, x);
    }

    /// y ← D^{−½}L⁻ᵀy, so that yᵀz is that of M⁻¹. The support is where it is not 0: where y was not, and the ancestors
    /// there.
    pub fn halve(&self, y: &mut [f64], Support { places, is_in }: &mut Support) {
        let pattern = self.model.pattern();
        places.clear();
        is_in.clear();
        is_in.resize(y.len(), false);
        for (k, _) in y.iter().enumerate().filter(|(_, y)| **y != 0.0) {
            let known = places.len();
            places.extend(core::iter::once(k).chain(pattern.ancestors(k)).take_while(|&i| !is_in[i]));
            places[known..].iter().for_each(|&i| is_in[i] = true);
        }
        places.sort_unstable_by(|a, b| b.cmp(a));
        ldlt::solve_transposed(pattern, &self.M, y, places.iter().copied());
        places.iter().for_each(|&k| y[k] *= self.scale[k]);
    }
}
