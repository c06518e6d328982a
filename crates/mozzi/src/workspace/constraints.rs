//! Memory of the constrained dynamics.

use crate::model::Model;
use crate::scalar::Scalar;
use alloc::vec;
use alloc::vec::Vec;

/// The number of rows of a weld, the most of any constraint.
pub(crate) const MOST_ROWS: usize = 6;

/// Memory of the constrained dynamics, m constraint rows and n velocities.
#[derive(Clone, Debug)]
pub struct ConstraintMemory<S = f64> {
    /// A, m × n by rows.
    pub A: Vec<S>,
    /// Ȧθ̇, m.
    pub dA_dtheta: Vec<S>,
    /// L and D of M.
    pub(crate) M: Vec<S>,
    /// Y = A L⁻¹, m × n.
    pub(crate) Y: Vec<S>,
    /// The rows of Y D⁻¹ that belong to one constraint.
    pub(crate) scaled: Vec<S>,
    /// G, m × m, and then the factors of G + diag ρ.
    pub(crate) G: Vec<S>,
    pub(crate) one_over_d: Vec<S>,
    /// ρ of each row.
    pub(crate) rho: Vec<S>,
    /// The increment of λ.
    pub(crate) step: Vec<S>,
    /// The right-hand side, m numbers; `lambda` has m as well, `vector` n.
    pub right: Vec<S>,
    pub(crate) lambda: Vec<S>,
    pub(crate) vector: Vec<S>,
}

impl<S: Scalar> ConstraintMemory<S> {
    /// Memory for this model.
    pub fn new<C: Scalar>(model: &Model<C>) -> Self {
        let (m, n, o) = (model.constraint_rows(), model.n(), S::zero());
        ConstraintMemory {
            A: vec![o; m * n],
            dA_dtheta: vec![o; m],
            M: vec![o; n * n],
            Y: vec![o; m * n],
            scaled: vec![o; MOST_ROWS * n],
            G: vec![o; m * m],
            one_over_d: vec![o; m],
            rho: vec![o; m],
            step: vec![o; m],
            right: vec![o; m],
            lambda: vec![o; m],
            vector: vec![o; n],
        }
    }

    /// Sets every number to NaN.
    pub(crate) fn fill_nan(&mut self) {
        let nan = S::from_f64(f64::NAN);
        let ConstraintMemory { A, dA_dtheta, M, Y, scaled, G, one_over_d, rho, step, right, lambda, vector } = self;
        for list in [A, dA_dtheta, M, Y, scaled, G, one_over_d, rho, step, right, lambda, vector] {
            list.fill(nan);
        }
    }
}
