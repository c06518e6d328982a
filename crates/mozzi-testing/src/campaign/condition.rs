//! The condition of what a quantity divides by.

use crate::campaign::case::Numbers;
use crate::inverse;
use mozzi::Model;
use mozzi::quantities::{BodyJacobian, ConstraintJacobian, Declaration, MassMatrix, Of, Query, SpaceJacobian};
use mozzi::{TaskFrame, nalgebra::DMatrix};

/// Largest condition at which quantities are compared.
pub const LARGEST: f64 = 1e9;

/// Largest ‖G⁻¹‖ times the mean diagonal entry of G = A M⁻¹Aᵀ at which constrained quantities are compared. The
/// kernel's ρ are 10⁻¹⁰ times the mean diagonal entry of each constraint; this bound does not tell constraints apart.
pub const LARGEST_SPREAD: f64 = 1e5;

/// Skeel's condition, ‖|X⁻¹| |X|‖ in the ∞-norm, of the mass matrix M, of A M⁻¹Aᵀ and of J M⁻¹Jᵀ (times the
/// size of the frame's Jacobian over that of the least row). Infinite if singular.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Condition {
    mass: f64,
    constraints: f64,
    spread: f64,
    task: f64,
}

impl Condition {
    /// At the state; the Jacobian has these rows.
    pub fn new(model: &Model, numbers: &Numbers, coordinates: TaskFrame, task_rows: &[usize]) -> Self {
        let (n, theta) = (model.n(), &numbers.state[0]);
        let of =
            |query: Query| model.compute(query, &[theta], &model.environment()).map_or(Vec::new(), |mut x| x.remove(0));
        let rows = |x: &[f64]| DMatrix::from_row_slice(x.len().checked_div(n).unwrap_or(0), n, x);
        let M = rows(&of(MassMatrix.into()));
        let Some(inverted) = inverse(&M) else {
            let [mass, constraints, spread, task] = [f64::INFINITY; 4];
            return Condition { mass, constraints, spread, task };
        };
        let A = rows(&of(ConstraintJacobian.into()));
        let J = match coordinates {
            TaskFrame::Body => of(Query::from(BodyJacobian).of(numbers.frame)),
            TaskFrame::Space => of(Query::from(SpaceJacobian).of(numbers.frame)),
        };
        let J = rows(&J);
        let whole = J.norm();
        let chosen = task_rows.iter().filter(|&&row| row < J.nrows()).map(|&row| J.row(row).into_owned());
        let J = match chosen.collect::<Vec<_>>() {
            none if none.is_empty() => DMatrix::zeros(0, n),
            some => DMatrix::from_rows(&some),
        };
        let of_rows = |A: &DMatrix<f64>| {
            let G = A * &inverted * A.transpose();
            let Some(inverse) = inverse(&G) else { return [f64::INFINITY; 2] };
            [skeel(&G, &inverse), inverse.norm() * G.trace() / G.nrows().max(1) as f64]
        };
        let ([constraints, spread], [task, _]) = (of_rows(&A), of_rows(&J));
        // a row that no joint moves is rounding error alone
        let least = J.row_iter().map(|row| row.norm()).fold(whole, f64::min);
        Condition { mass: skeel(&M, &inverted), constraints, spread, task: task * whole / least }
    }

    /// True if the rows of the constraints differ in size, or are close to redundant, beyond [`LARGEST_SPREAD`].
    pub fn is_spread(&self, declaration: &Declaration) -> bool {
        declaration.divides && declaration.is_constrained && !(self.spread < LARGEST_SPREAD)
    }

    /// κ of a quantity: 0 if it does not divide; the product of two conditions for constraints and tasks.
    pub fn of(&self, declaration: &Declaration) -> f64 {
        match declaration {
            Declaration { divides: false, .. } => 0.0,
            Declaration { is_constrained: true, .. } => self.mass * self.constraints,
            Declaration { of: Of::Task, .. } => self.mass * self.task,
            _ => self.mass,
        }
    }
}

fn skeel(X: &DMatrix<f64>, inverse: &DMatrix<f64>) -> f64 {
    let product = inverse.abs() * X.abs();
    let largest = product.row_iter().map(|row| row.sum()).fold(1.0, f64::max);
    if product.iter().all(|x| x.is_finite()) { largest } else { f64::INFINITY }
}
