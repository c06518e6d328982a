//! The equation of motion, with joints that rest against their stops.

use super::closing::Closer;
use super::factored_mass::FactoredMass;
use super::held::Held;
use super::modes::Modes;
use super::state::State;
use super::{Closing, Energy, Equation, Input, Options, Powers};
use crate::model::{Error, Freedom, Model};
use alloc::boxed::Box;
use alloc::vec;
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector};

/// A robot, its input, and the joints that are held at a stop, which do not accelerate beyond it.
pub(super) struct Driven<'m, I = &'m mut (dyn Input + 'm)> {
    pub model: &'m Model,
    pub equation: Equation<'m, I>,
    pub held: Vec<Held>,
    /// The stops' forces at the last evaluation, one for each held joint.
    pub reactions: Vec<f64>,
    /// M of the last call of `factor`.
    pub mass: FactoredMass<'m>,
    closer: Option<Closer>,
    /// A of the constraints at the last factorization of M.
    A: DMatrix<f64>,
    /// What holds and what slides, for methods that stop at events.
    pub modes: Option<Box<Modes<'m>>>,
}

impl<'m, I: Input> Driven<'m, I> {
    pub fn new(equation: Equation<'m, I>) -> Self {
        let model = equation.model();
        let n = model.n();
        Driven {
            model,
            equation,
            held: Vec::new(),
            reactions: Vec::new(),
            mass: FactoredMass::new(model),
            closer: Closer::new(model),
            A: DMatrix::zeros(0, n),
            modes: None,
        }
    }

    /// Sets the step that errors report.
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
        let mut powers = self.equation.evaluate(t, theta, dtheta, ddtheta)?;
        if let Some(modes) = &mut self.modes {
            let [lost, given] = modes.accelerate(t, theta, dtheta, ddtheta)?;
            powers[1] += lost;
            powers[2] += given;
        }
        if !self.held.is_empty() {
            self.factor(theta)?;
            self.reactions = self.bring_to_rest(theta, Some(dtheta), ddtheta);
        }
        Ok(powers)
    }

    /// Does the robot have constraints?
    pub fn has_constraints(&self) -> bool {
        self.closer.is_some()
    }

    /// Checks that the start satisfies the constraints, then brings it onto them.
    pub fn close_start(&mut self, theta: &mut [f64], dtheta: &mut [f64]) -> Result<(), Error> {
        let Some(closer) = &mut self.closer else { return Ok(()) };
        closer.check_start(self.model, theta, dtheta)?;
        closer.close(self.model, 0.0, theta, dtheta)
    }

    /// Brings positions and velocities back onto the constraints.
    pub fn close(&mut self, t: f64, theta: &mut [f64], dtheta: &mut [f64]) -> Result<(), Error> {
        match &mut self.closer {
            Some(closer) => closer.close(self.model, t, theta, dtheta),
            None => Ok(()),
        }
    }

    /// The largest violation of the constraints so far.
    pub fn closing(&self) -> Closing {
        self.closer.as_ref().map_or(Closing::default(), |closer| closer.account)
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

    /// M(θ), factored in `mass`.
    pub fn factor(&mut self, theta: &[f64]) -> Result<(), Error> {
        if self.has_constraints() {
            self.A = self.model.constraint_rows_at(theta, &vec![0.0; self.model.n()]).A;
        }
        self.mass.factor(theta, 0.0, &[])
    }

    /// x ← x + M⁻¹Eλ, and returns the λ that keeps the held joints at their limits. For velocities x, Eᵀx = 0 and λ are
    /// impulses; for accelerations x at the velocities θ̇, Eᵀx + Ėᵀθ̇ = 0 and λ are forces. E has the column n of each
    /// held joint.
    pub fn bring_to_rest(&self, theta: &[f64], moving: Option<&[f64]>, x: &mut [f64]) -> Vec<f64> {
        let count = self.held.len();
        let mut E = DMatrix::zeros(x.len(), count);
        for (held, mut column) in self.held.iter().zip(E.column_iter_mut()) {
            held.add(theta, 1.0, column.as_mut_slice());
        }
        let excess =
            |held: &Held, x: &[f64]| held.along(theta, x) + moving.map_or(0.0, |dtheta| held.rate_along(theta, dtheta));
        let columns = self.response(&E);
        let A = E.transpose() * &columns;
        let b = DVector::from_iterator(count, self.held.iter().map(|held| -excess(held, x)));
        let lambda = match self.has_constraints() {
            true => pseudo_solve(A, &DMatrix::from_column_slice(count, 1, b.as_slice())).column(0).clone_owned(),
            false => A.cholesky().map_or_else(|| DVector::zeros(count), |A| A.solve(&b)),
        };
        let change = columns * &lambda;
        x.iter_mut().zip(change.iter()).for_each(|(x, d)| *x += d);
        self.held.iter().for_each(|held| held.add(theta, -excess(held, x), x)); // the rounding error
        lambda.as_slice().to_vec()
    }

    /// The accelerations due to forces E: M⁻¹E; for a robot with constraints, their projection M⁻¹P E.
    fn response(&self, E: &DMatrix<f64>) -> DMatrix<f64> {
        let divide = |mut X: DMatrix<f64>| {
            X.column_iter_mut().for_each(|mut column| self.mass.divide(column.as_mut_slice()));
            X
        };
        let mut columns = divide(E.clone());
        if self.has_constraints() {
            let by_constraints = divide(self.A.transpose());
            let G = &self.A * &by_constraints;
            columns -= by_constraints * pseudo_solve(G, &(&self.A * &columns));
        }
        columns
    }

    /// Releases the held joints whose stop would have to pull, the worst first. x and `moving`, as for
    /// [`bring_to_rest`](Self::bring_to_rest), are the values without stops. Returns whether some were released.
    pub fn let_go(&mut self, theta: &[f64], moving: Option<&[f64]>, x: &[f64]) -> bool {
        let mut found = false;
        while !self.held.is_empty() {
            let lambda = self.bring_to_rest(theta, moving, &mut x.to_vec());
            let pull = |k: &usize| lambda[*k] * self.held[*k].side;
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

    /// The largest force with which a stop would have to pull; −∞ if no joint is held.
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
            .map(|(force, held)| force * held.side)
            .fold(f64::NEG_INFINITY, f64::max))
    }

    /// Puts held balls, which the step's error moved, back onto their limits; the kinetic energy lost is counted as
    /// friction. Held joints of one axis do not move.
    pub fn keep_at_limits(&mut self, state: &mut State) -> Result<(), Error> {
        if self.held.iter().all(|held| held.place.freedom == Freedom::One) {
            return Ok(());
        }
        self.held.iter().for_each(|held| held.project(&mut state.theta));
        let before = self.energy(&state.theta, &state.dtheta, state.works).kinetic;
        self.factor(&state.theta)?;
        self.bring_to_rest(&state.theta, None, &mut state.dtheta);
        state.works[1] += before - self.energy(&state.theta, &state.dtheta, state.works).kinetic;
        self.complete(state)
    }

    /// Releases the held joints whose stop would pull now.
    pub fn release(&mut self, state: &mut State) -> Result<(), Error> {
        if self.held.is_empty() {
            return Ok(());
        }
        self.factor(&state.theta)?;
        let mut free = vec![0.0; self.model.n()];
        self.equation.evaluate(state.t, &state.theta, &state.dtheta, &mut free)?;
        if self.let_go(&state.theta, Some(&state.dtheta), &free) {
            self.complete(state)?;
        }
        Ok(())
    }
}

/// X of least norm with GX = B, for a G that may be singular.
fn pseudo_solve(G: DMatrix<f64>, B: &DMatrix<f64>) -> DMatrix<f64> {
    let (rows, columns) = (G.ncols(), B.ncols());
    if rows == 0 {
        return DMatrix::zeros(rows, columns);
    }
    let svd = G.svd(true, true);
    let tolerance = 1e-10 * svd.singular_values.max();
    svd.solve(B, tolerance).unwrap_or_else(|_| DMatrix::zeros(rows, columns))
}
