//! Positions and velocities brought back onto the constraints after a step.

use crate::constraints::{ConstraintMemory, change, constraint_jacobian, delassus};
use crate::kinematics::integrate;
use crate::model::{Error, Model, Workspace};
use alloc::vec;
use alloc::vec::Vec;

/// A residual below this needs no correction: rounding of positions of the order of 1 m.
const CLOSED: f64 = 1e-15;
/// One above this, rad or m, is not closed.
const OPEN: f64 = 1e-10;
/// Corrections with one factorization, and factorizations.
const CORRECTIONS: usize = 4;
const FACTORIZATIONS: usize = 6;

/// The largest violation of the constraints along a motion, rad and m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Closing {
    /// After the steps, before the correction: what the method of integration left.
    pub corrected: f64,
    /// After the correction.
    pub residual: f64,
}

/// Memory for the correction.
pub(super) struct Closer {
    workspace: Workspace,
    memory: ConstraintMemory,
    phi: Vec<f64>,
    change: Vec<f64>,
    at_rest: Vec<f64>,
    pub account: Closing,
}

impl Closer {
    /// None for a robot without constraints.
    pub fn new(model: &Model) -> Option<Self> {
        let (m, n) = (model.constraint_rows(), model.n());
        (m > 0).then(|| Closer {
            workspace: Workspace::new(model),
            memory: ConstraintMemory::new(model),
            phi: vec![0.0; m],
            change: vec![0.0; n],
            at_rest: vec![0.0; n],
            account: Closing::default(),
        })
    }

    /// θ ← θ ⊕ δ with M δ = −Aᵀλ, A δ = −φ, until φ is 0; then θ̇ ← θ̇ − M⁻¹AᵀΛ with A θ̇ = 0: the nearest in the metric
    /// of M.
    pub fn close(&mut self, model: &Model, t: f64, theta: &mut [f64], dtheta: &mut [f64]) -> Result<(), Error> {
        let mut residual = self.rows(model, theta);
        self.account.corrected = self.account.corrected.max(residual);
        let mut is_factored = false;
        for _ in 0..FACTORIZATIONS {
            if is_factored && residual <= OPEN {
                break;
            }
            delassus::factor(model, &mut self.workspace, &mut self.memory);
            is_factored = true;
            for _ in 0..CORRECTIONS {
                if residual <= CLOSED {
                    break;
                }
                self.memory.right.copy_from_slice(&self.phi);
                change(model, &mut self.memory, &mut self.change);
                integrate(model, theta, &self.change, 1.0);
                let next = self.rows(model, theta);
                let improves = next < 0.5 * residual;
                residual = next;
                if !improves {
                    break;
                }
            }
        }
        if !(residual <= OPEN) {
            let row = (0..self.phi.len()).max_by(|&a, &b| self.phi[a].abs().total_cmp(&self.phi[b].abs())).unwrap_or(0);
            let constraint = model.constraint_of_row(row);
            return Err(Error::Opened { constraint, residual, time: t });
        }
        self.account.residual = self.account.residual.max(residual);
        // A is that of the corrected θ, its factors are not: each round gains as many digits as θ had
        for _ in 0..CORRECTIONS {
            self.memory.right.fill(0.0);
            delassus::add_products(model, &self.memory.A, dtheta, &mut self.memory.right);
            let speed = self.memory.right.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            if speed <= CLOSED * dtheta.iter().fold(1.0_f64, |most, x| most.max(x.abs())) {
                break;
            }
            change(model, &mut self.memory, &mut self.change);
            dtheta.iter_mut().zip(&self.change).for_each(|(rate, change)| *rate += change);
        }
        Ok(())
    }

    /// A and φ at θ; the largest of φ.
    fn rows(&mut self, model: &Model, theta: &[f64]) -> f64 {
        let Closer { workspace, memory, phi, at_rest, .. } = self;
        constraint_jacobian(model, theta, at_rest, workspace, &mut memory.A, &mut [], phi);
        phi.iter().fold(0.0, |most, x| if x.abs() <= most { most } else { x.abs() }) // NaN is kept
    }
}

/// Does the start satisfy the constraints, to 10⁻⁶?
pub(super) fn check_start(model: &Model, theta: &[f64], dtheta: &[f64]) -> Result<(), Error> {
    let rows = model.constraint_rows_at(theta, dtheta);
    let speeds = &rows.A * nalgebra::DVector::from_column_slice(dtheta);
    let size = dtheta.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
    for (what, values, bound) in [("a position", &rows.phi, 1e-6), ("a velocity", &speeds, 1e-6 * size)] {
        if let Some((row, x)) = values.iter().enumerate().find(|(_, x)| !(x.abs() <= bound)) {
            return Err(Error::OpenStart { constraint: model.constraint_of_row(row), residual: x.abs(), what });
        }
    }
    Ok(())
}
