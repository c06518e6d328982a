//! The rank of the constraints, and the rows that are redundant.

use super::rows::SINGULAR;
use crate::model::{Error, Model};
use alloc::string::String;
use alloc::vec::Vec;

/// The rank of A(θ).
#[derive(Clone, Debug, PartialEq)]
pub struct ConstraintRank {
    /// m, the number of rows.
    pub rows: usize,
    /// The number of independent rows.
    pub rank: usize,
    /// n − rank: the degrees of freedom that are left.
    pub freedom: usize,
    /// The names of rows that depend on the others.
    pub redundant: Vec<String>,
}

impl Model<f64> {
    /// The rank of A(θ), by QR with column pivoting: rows within 10⁻⁹ of the space of the others are redundant,
    /// relative to the largest row of their own constraint. At a singular θ it is less than elsewhere.
    ///
    /// # Errors
    /// [`Error::WrongLength`]; [`Error::BadArgument`] if A is not finite.
    pub fn constraint_rank(&self, theta: &[f64]) -> Result<ConstraintRank, Error> {
        self.check_configuration(theta)?;
        let (rows, n) = (self.constraint_rows(), self.n());
        if rows == 0 || n == 0 {
            return Ok(ConstraintRank { rows, rank: 0, freedom: n, redundant: self.constraint_row_names().collect() });
        }
        let found = self.constraint_rows_at(theta, &alloc::vec![0.0; n]);
        self.check_rows(&found)?;
        let mut A = found.A;
        for tie in &self.ties.list {
            let mut own = A.rows_mut(tie.first, tie.kind.rows());
            let largest = own.row_iter().map(|row| row.norm()).fold(0.0, f64::max);
            if largest > 0.0 {
                own /= largest;
            }
        }
        let qr = A.transpose().col_piv_qr();
        let mut order = nalgebra::RowDVector::from_iterator(rows, 0..rows);
        qr.p().permute_columns(&mut order);
        let R = qr.unpack_r();
        let largest = R[(0, 0)].abs();
        let rank = (0..R.nrows().min(R.ncols())).take_while(|&k| R[(k, k)].abs() > SINGULAR * largest).count();
        let mut dependent: Vec<usize> = order.iter().skip(rank).copied().collect();
        dependent.sort_unstable();
        let names: Vec<String> = self.constraint_row_names().collect();
        let redundant = dependent.into_iter().map(|row| names[row].clone()).collect();
        Ok(ConstraintRank { rows, rank, freedom: n - rank, redundant })
    }
}
