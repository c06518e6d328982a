//! The equation of motion, with joints that rest against their stops.

use super::state::State;
use super::{Energy, Equation, Input, Options, Powers};
use crate::dynamics::mass_matrix;
use crate::model::{Error, Model, Workspace};
use alloc::format;
use alloc::vec;
use alloc::vec::Vec;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// A robot, its input, and the joints that are held at a stop: of those θ̈ = 0.
pub(super) struct Driven<'m> {
    pub model: &'m Model,
    equation: Equation<'m, &'m mut (dyn Input + 'm)>,
    /// Velocity j, and the side of its stop: −1 or 1.
    pub held: Vec<(usize, f64)>,
    /// The stops' forces at the last evaluation, one for each held joint.
    pub reactions: Vec<f64>,
    workspace: Workspace,
    M: Vec<f64>,
}

impl<'m> Driven<'m> {
    pub fn new(equation: Equation<'m, &'m mut (dyn Input + 'm)>) -> Self {
        let model = equation.model();
        let n = model.n();
        Driven {
            model,
            equation,
            held: Vec::new(),
            reactions: Vec::new(),
            workspace: Workspace::new(model),
            M: vec![0.0; n * n],
        }
    }

    /// For errors.
    pub fn at_step(&mut self, step: usize, step_size: f64) {
        self.equation.at_step(step, step_size);
    }

    pub fn options(&self) -> &Options {
        &self.equation.options
    }

    pub fn tau(&self) -> &[f64] {
        self.equation.tau()
    }

    /// θ̈ and the powers.
    pub fn evaluate(&mut self, t: f64, theta: &[f64], dtheta: &[f64], ddtheta: &mut [f64]) -> Result<Powers, Error> {
        let powers = self.equation.evaluate(t, theta, dtheta, ddtheta)?;
        if !self.held.is_empty() {
            let M = self.factored(theta)?;
            self.reactions = self.bring_to_rest(&M, ddtheta);
        }
        Ok(powers)
    }

    /// Fills in θ̈ and the powers of a state.
    pub fn complete(&mut self, state: &mut State) -> Result<(), Error> {
        let State { t, theta, dtheta, ddtheta, powers, .. } = state;
        *powers = self.evaluate(*t, theta, dtheta, ddtheta)?;
        Ok(())
    }

    pub fn energy(&mut self, theta: &[f64], dtheta: &[f64], works: Powers) -> Energy {
        self.equation.energy(theta, dtheta, works)
    }

    /// M(θ).
    pub fn mass(&mut self, theta: &[f64]) -> DMatrix<f64> {
        mass_matrix(self.model, theta, &mut self.workspace, &mut self.M);
        DMatrix::from_row_slice(self.model.n(), self.model.n(), &self.M)
    }

    /// M(θ), factored.
    pub fn factored(&mut self, theta: &[f64]) -> Result<Cholesky<f64, Dyn>, Error> {
        let M = self.mass(theta);
        match M.cholesky() {
            Some(M) => Ok(M),
            // looks closer, and names the joint
            None => {
                let zeros = vec![0.0; self.model.n()];
                self.model.forward_dynamics_by_mass_matrix(theta, &zeros, &zeros, &self.model.environment())?;
                Err(Error::BadArgument {
                    what: "M(θ)",
                    found: format!("not positive definite at θ = {theta:?}"),
                    expected: "positive definite",
                })
            }
        }
    }

    /// x ← x + M⁻¹Eλ with the λ that makes x 0 at the held joints, which is returned: forces, of accelerations, or
    /// impulses, of velocities.
    pub fn bring_to_rest(&self, M: &Cholesky<f64, Dyn>, x: &mut [f64]) -> Vec<f64> {
        let count = self.held.len();
        let mut E = DMatrix::zeros(x.len(), count);
        for (k, &(j, _)) in self.held.iter().enumerate() {
            E[(j, k)] = 1.0;
        }
        let columns = M.solve(&E); // M⁻¹E
        let A = E.transpose() * &columns;
        let b = DVector::from_iterator(count, self.held.iter().map(|&(j, _)| -x[j]));
        let lambda = A.cholesky().map_or_else(|| DVector::zeros(count), |A| A.solve(&b));
        let change = columns * &lambda;
        x.iter_mut().zip(change.iter()).for_each(|(x, d)| *x += d);
        self.held.iter().for_each(|&(j, _)| x[j] = 0.0);
        lambda.as_slice().to_vec()
    }

    /// Lets go of the held joints whose stop would have to pull, the worst first: forces of accelerations, impulses of
    /// velocities; x is what it would be without stops. Returns whether some were let go.
    pub fn let_go(&mut self, M: &Cholesky<f64, Dyn>, x: &[f64]) -> bool {
        let mut found = false;
        while !self.held.is_empty() {
            let lambda = self.bring_to_rest(M, &mut x.to_vec());
            let pull = |k: &usize| lambda[*k] * self.held[*k].1;
            let worst = (0..lambda.len()).max_by(|a, b| pull(a).total_cmp(&pull(b)));
            match worst {
                Some(k) if pull(&k) > 0.0 => {
                    self.held.remove(k);
                    found = true;
                }
                _ => break,
            }
        }
        found
    }

    /// The largest force with which a stop would have to pull; −∞ where no joint is held.
    pub fn pull(&mut self, state: &State) -> Result<f64, Error> {
        if self.held.is_empty() {
            return Ok(f64::NEG_INFINITY);
        }
        let mut ddtheta = vec![0.0; self.model.n()];
        self.evaluate(state.t, &state.theta, &state.dtheta, &mut ddtheta)?;
        Ok(self
            .reactions
            .iter()
            .zip(&self.held)
            .map(|(force, (_, side))| force * side)
            .fold(f64::NEG_INFINITY, f64::max))
    }

    /// Of held joints, those whose stop would pull now.
    pub fn release(&mut self, state: &mut State) -> Result<(), Error> {
        if self.held.is_empty() {
            return Ok(());
        }
        let M = self.factored(&state.theta)?;
        let mut free = vec![0.0; self.model.n()];
        self.equation.evaluate(state.t, &state.theta, &state.dtheta, &mut free)?;
        if self.let_go(&M, &free) {
            self.complete(state)?;
        }
        Ok(())
    }
}
