//! Robots with constraints as methods (Modern Robotics, section 8.7): dynamics, assembly, rank, reduction.

mod assembly;
mod derivatives;
mod dynamics;
mod inverse_dynamics;
mod rank;
mod reduction;
#[cfg(test)]
mod tests;

pub use derivatives::ConstrainedForwardDynamicsDerivatives;
pub use dynamics::ConstrainedDynamics;
pub use rank::ConstraintRank;
pub use reduction::Reduction;

use crate::constraints::constraint_jacobian;
use crate::model::{Error, Model};
use crate::scalar::Scalar;
use crate::workspace::Workspace;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec;
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector};

/// Singular values below this fraction of the largest count as zero: loops are closed only up to rounding.
pub(crate) const SINGULAR: f64 = 1e-9;

/// A, Ȧθ̇ and φ.
pub(crate) struct Rows {
    pub A: DMatrix<f64>,
    pub bias: DVector<f64>,
    pub phi: DVector<f64>,
}

impl<C: Scalar> Model<C> {
    /// The constraint that a row belongs to.
    pub fn constraint_of_row(&self, row: usize) -> String {
        let found = self.ties.list.iter().rposition(|tie| tie.first <= row).unwrap_or(0);
        self.constraints().get(found).map_or_else(String::new, |one| one.name.clone())
    }
}

impl Model<f64> {
    /// A, Ȧθ̇ and φ at a state whose lengths were checked.
    pub(crate) fn constraint_rows_at(&self, theta: &[f64], dtheta: &[f64]) -> Rows {
        let (m, n) = (self.constraint_rows(), self.n());
        let (mut A, mut bias, mut phi) = (vec![0.0; m * n], vec![0.0; m], vec![0.0; m]);
        constraint_jacobian(self, theta, dtheta, &mut Workspace::new(self), &mut A, &mut bias, &mut phi);
        Rows { A: DMatrix::from_row_slice(m, n, &A), bias: DVector::from_vec(bias), phi: DVector::from_vec(phi) }
    }

    /// The indices of the velocities of the joints with these names.
    fn velocities_of(&self, names: &[&str]) -> Result<Vec<usize>, Error> {
        let mut found = Vec::new();
        for &name in names {
            let Some(k) = self.joint_names().position(|known| known == name) else {
                let known = self.joint_names().map(ToString::to_string).collect();
                return Err(Error::NoSuchJoint { name: name.to_string(), known });
            };
            let place = self.places()[k];
            if found.contains(&place.j) {
                let (what, found) = ("the list of joints", format!("`{name}`, twice"));
                return Err(Error::BadArgument { what, found, expected: "each joint once" });
            }
            found.extend(place.velocities());
        }
        Ok(found)
    }

    /// The name of a velocity.
    fn velocity_name(&self, j: usize) -> String {
        self.velocity_names().nth(j).unwrap_or_default().to_string()
    }
}

/// The x of least norm that minimizes ‖Ax − b‖.
fn least_squares(A: &DMatrix<f64>, b: &DVector<f64>) -> DVector<f64> {
    if A.nrows() == 0 || A.ncols() == 0 {
        return DVector::zeros(A.ncols());
    }
    let svd = A.clone().svd(true, true);
    let tolerance = SINGULAR * svd.singular_values.max();
    svd.solve(b, tolerance).unwrap_or_else(|_| DVector::zeros(A.ncols()))
}

/// The columns with these indices.
fn columns(A: &DMatrix<f64>, places: &[usize]) -> DMatrix<f64> {
    A.select_columns(places)
}
