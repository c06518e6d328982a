//! Positions and velocities brought back onto the constraints after a step.

use crate::Error;
use alloc::vec;
use alloc::vec::Vec;
use mozzi::ConstraintMemory;
use mozzi::Workspace;
use mozzi::constraints::{change, constraint_jacobian, delassus};
use mozzi::model::Model;
use mozzi::model::integrate;
use mozzi::scalar::{Float, Real, Scalar};

/// Maximum numbers of corrections with one factorization, and of factorizations.
const CORRECTIONS: usize = 4;
const FACTORIZATIONS: usize = 6;

/// A residual below this needs no correction: rounding of positions of the order of 1 m; 10⁻¹⁵ for `f64`.
fn closed<S: Float + Into<f64>>() -> f64 {
    4.5 * S::EPSILON.into()
}

/// A constraint with a residual above this, rad or m, is not closed; 10⁻¹⁰ for `f64`, 5 · 10⁻⁵ for `f32`.
fn open<S: Float + Into<f64>>() -> f64 {
    (450_000.0 * S::EPSILON.into()).min(5e-5)
}

/// Closing changes no velocity by more than this part of 1 + the largest: more is no error of a step, but another
/// branch of a mechanism that passes a change point.
const JUMP: f64 = 0.3;

/// The largest violation of the constraints along a motion, rad and m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Closing {
    /// After the steps, before the correction: what the method of integration left.
    pub corrected: f64,
    /// After the correction.
    pub residual: f64,
}

/// The numbers of corrections in one closing, so that they can be repeated for a state of another number type.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Corrections {
    /// Corrections of the positions with each factorization.
    positions: [usize; FACTORIZATIONS],
    factorizations: usize,
    velocities: usize,
}

/// Brings states of a robot with constraints back onto them.
#[derive(Clone, Debug)]
pub struct Closer<S = f64> {
    workspace: Workspace<S>,
    memory: ConstraintMemory<S>,
    phi: Vec<S>,
    change: Vec<S>,
    at_rest: Vec<S>,
    /// The largest violation so far.
    pub account: Closing,
    pub(crate) corrections: Corrections,
}

impl<S: Float + Into<f64>> Closer<S> {
    /// None for a robot without constraints.
    pub fn new(model: &Model<S>) -> Option<Self> {
        let (m, n) = (model.constraint_rows(), model.n());
        (m > 0).then(|| Closer {
            workspace: Workspace::new(model),
            memory: ConstraintMemory::new(model),
            phi: vec![S::zero(); m],
            change: vec![S::zero(); n],
            at_rest: vec![S::zero(); n],
            account: Closing::default(),
            corrections: Corrections::default(),
        })
    }

    /// Checks that the start satisfies the constraints, to 10⁻⁶ (`f32`: 5 · 10⁻⁵), by half turns, too.
    ///
    /// # Errors
    /// [`Error::OpenStart`].
    ///
    /// # Panics
    /// When θ is not nq long, or θ̇ not n.
    pub fn check_start(&mut self, model: &Model<S>, theta: &[S], dtheta: &[S]) -> Result<(), Error> {
        model.assert_lengths(theta.len(), [dtheta.len()]);
        self.rows(model, theta);
        model.add_half_turns(theta, &mut self.phi);
        self.find_speeds(model, dtheta);
        let tolerance = open::<S>().max(1e-6);
        let bound = tolerance * largest(dtheta).max(1.0);
        let rows = [("a position", &self.phi, tolerance), ("a velocity", &self.memory.right, bound)];
        for (what, values, bound) in rows {
            let mut values = values.iter().map(|&x| x.into().abs()).enumerate();
            if let Some((row, residual)) = values.find(|(_, x)| !(*x <= bound)) {
                return Err(Error::OpenStart { constraint: model.constraint_of_row(row), residual, what });
            }
        }
        Ok(())
    }

    /// θ ← θ ⊕ δ with M δ = −Aᵀλ, A δ = −φ, until φ is 0; then θ̇ ← θ̇ − M⁻¹AᵀΛ with A θ̇ = 0: the nearest velocities
    /// in the metric of M. t is only used in the error.
    ///
    /// # Errors
    /// [`Error::Opened`], [`Error::Jumped`].
    ///
    /// # Panics
    /// When θ is not nq long, or θ̇ not n.
    pub fn close(&mut self, model: &Model<S>, t: f64, theta: &mut [S], dtheta: &mut [S]) -> Result<(), Error> {
        model.assert_lengths(theta.len(), [dtheta.len()]);
        let (closed, open) = (closed::<S>(), open::<S>());
        let mut residual = self.rows(model, theta);
        self.account.corrected = self.account.corrected.max(residual);
        self.corrections = Corrections::default();
        for round in 0..FACTORIZATIONS {
            if round > 0 && residual <= open {
                break;
            }
            delassus::factor(model, &mut self.workspace, &mut self.memory);
            self.corrections.factorizations += 1;
            for _ in 0..CORRECTIONS {
                if residual <= closed {
                    break;
                }
                self.memory.right.copy_from_slice(&self.phi);
                change(model, &mut self.memory, &mut self.change);
                integrate(model, theta, &self.change, S::one());
                self.corrections.positions[round] += 1;
                let next = self.rows(model, theta);
                let improves = next < 0.5 * residual;
                residual = next;
                if !improves {
                    break;
                }
            }
        }
        if !(residual <= open) {
            let size = |row: &usize| self.phi[*row].into().abs();
            let row = (0..self.phi.len()).max_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or(0);
            let constraint = model.constraint_of_row(row);
            return Err(Error::Opened { constraint, residual, time: t });
        }
        self.account.residual = self.account.residual.max(residual);
        // A is evaluated at the corrected θ, its factors are not: each round gains as many digits as θ had
        for _ in 0..CORRECTIONS {
            self.find_speeds(model, dtheta);
            if largest(&self.memory.right) <= closed * largest(dtheta).max(1.0) {
                break;
            }
            change(model, &mut self.memory, &mut self.change);
            let most = largest(&self.change);
            if most > JUMP * (1.0 + largest(dtheta)) {
                let worst = self.change.iter().position(|&x| x.into().abs() == most).unwrap_or(0);
                let joint = model.velocity_names().nth(worst).unwrap_or_default().into();
                return Err(Error::Jumped { joint, change: most, time: t });
            }
            self.corrections.velocities += 1;
            dtheta.iter_mut().zip(&self.change).for_each(|(rate, &change)| *rate += change);
        }
        Ok(())
    }

    /// A and φ at θ; the largest of φ.
    fn rows(&mut self, model: &Model<S>, theta: &[S]) -> f64 {
        let Closer { workspace, memory, phi, at_rest, .. } = self;
        constraint_jacobian(model, theta, at_rest, workspace, &mut memory.A, &mut [], phi);
        largest(phi)
    }

    /// A θ̇, in the memory's `right`.
    fn find_speeds(&mut self, model: &Model<S>, dtheta: &[S]) {
        let ConstraintMemory { A, right, .. } = &mut self.memory;
        right.fill(S::zero());
        delassus::add_products(model, A, dtheta, right);
    }
}

impl Corrections {
    /// Applies the same numbers of corrections to a state of any number type, without tests of convergence.
    pub(crate) fn repeat<S: Real + From<C>, C: Scalar>(
        self,
        model: &Model<C>,
        theta: &mut [S],
        dtheta: &mut [S],
        workspace: &mut Workspace<S>,
        memory: &mut ConstraintMemory<S>,
    ) {
        let zeros = |length: usize| vec![S::zero(); length];
        let (mut phi, mut x, still) = (zeros(model.constraint_rows()), zeros(model.n()), zeros(model.n()));
        constraint_jacobian(model, theta, &still, workspace, &mut memory.A, &mut [], &mut phi);
        for &corrections in &self.positions[..self.factorizations] {
            delassus::factor(model, workspace, memory);
            for _ in 0..corrections {
                memory.right.copy_from_slice(&phi);
                change(model, memory, &mut x);
                integrate(model, theta, &x, S::one());
                constraint_jacobian(model, theta, &still, workspace, &mut memory.A, &mut [], &mut phi);
            }
        }
        for _ in 0..self.velocities {
            let ConstraintMemory { A, right, .. } = &mut *memory;
            right.fill(S::zero());
            delassus::add_products(model, A, dtheta, right);
            change(model, memory, &mut x);
            dtheta.iter_mut().zip(&x).for_each(|(rate, &change)| *rate += change);
        }
    }
}

/// The largest |x|; NaN if one is NaN.
fn largest<S: Float + Into<f64>>(numbers: &[S]) -> f64 {
    let sizes = numbers.iter().map(|&x| x.into().abs());
    sizes.fold(0.0, |most, x| if x <= most { most } else { x })
}
