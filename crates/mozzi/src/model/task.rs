//! A task: rows of a frame's twist.

use super::{Error, FrameId, Model, Pivots};
use crate::linalg::ldlt::Pattern;
use crate::scalar::Scalar;
use crate::spatial::Twist;
use alloc::vec;
use alloc::vec::Vec;
use nalgebra::{Matrix6, SMatrix, Vector6};

/// Coordinates of the task's twist and wrench.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TaskFrame {
    /// The frame's own: 𝒱_b, with v the velocity of the frame's origin.
    Body,
    /// The base's: 𝒱_s, with v the velocity of the point of the body that is at the base's origin.
    Space,
}

/// A task: a frame, the coordinates, and the indices of the rows of its twist (ω, v).
#[derive(Clone, Copy, Debug)]
pub struct Task<'a> {
    /// The frame.
    pub frame: FrameId,
    /// The coordinates of twist and wrench.
    pub coordinates: TaskFrame,
    /// Rows of (ω_x, ω_y, ω_z, v_x, v_y, v_z), each once.
    pub rows: &'a [usize],
}

impl Task<'_> {
    /// All six rows.
    pub fn all(frame: FrameId, coordinates: TaskFrame) -> Self {
        Task { frame, coordinates, rows: &[0, 1, 2, 3, 4, 5] }
    }

    /// Checks that the frame belongs to this model and that the rows are distinct and below six.
    ///
    /// # Errors
    /// [`Error::BadArgument`].
    pub fn check(&self, model: &Model) -> Result<(), Error> {
        model.check_frame(self.frame)?;
        let distinct = (1..self.rows.len()).all(|k| !self.rows[..k].contains(&self.rows[k]));
        if self.rows.is_empty() || self.rows.iter().any(|&row| row > 5) || !distinct {
            let expected = "distinct row numbers from 0 to 5 (ω_x, ω_y, ω_z, v_x, v_y, v_z)";
            return Err(Error::BadArgument {
                what: "the task's rows",
                found: alloc::format!("{:?}", self.rows),
                expected,
            });
        }
        Ok(())
    }
}

/// Memory of [`task_space_dynamics`](crate::dynamics::task_space_dynamics) for k rows, and its intermediate results.
#[derive(Clone, Debug)]
pub struct TaskMemory<S = f64> {
    /// J, k × n by rows.
    pub J: Vec<S>,
    /// J̇θ̇, k.
    pub dJ_dtheta: Vec<S>,
    /// The k pivots of Λ⁻¹, then Σ_j ‖S_j‖² / d_j over all six rows of J = [S_1 … S_n] and the pivots d of M, which is
    /// what they are measured by: a pivot within rounding error of it or of the others makes the task singular. The
    /// pivots of M are in the workspace.
    pub pivots: Vec<S>,
    /// The dense pattern: Λ⁻¹ has no structural zeros.
    pub(crate) dense: Pattern,
    pub(crate) M: Vec<S>,
    /// M⁻¹h.
    pub(crate) h: Vec<S>,
    /// J L⁻¹ with L of M = LᵀDL, k × n by rows, then orthogonal rows.
    pub(crate) Q: Vec<S>,
    /// One of them times D⁻¹; a column of Λ.
    pub(crate) row: Vec<S>,
    pub(crate) columns: Vec<Twist<S>>,
}

impl<S: Scalar> TaskMemory<S> {
    /// Memory for a task of this many rows.
    pub fn new<C: Scalar>(model: &Model<C>, rows: usize) -> Self {
        let (n, o) = (model.n(), S::zero());
        TaskMemory {
            J: vec![o; rows * n],
            dJ_dtheta: vec![o; rows],
            pivots: vec![o; rows + 1],
            dense: Pattern::new(rows, rows, core::iter::empty()),
            M: vec![o; n * n],
            h: vec![o; n],
            Q: vec![o; rows * n],
            row: vec![o; n.max(rows)],
            columns: vec![Twist::zero(); n],
        }
    }

    /// k, the number of rows.
    pub(crate) fn rows(&self) -> usize {
        self.dJ_dtheta.len()
    }

    /// Every number NaN.
    pub(crate) fn fill_nan(&mut self) {
        let nan = S::from_f64(f64::NAN);
        let TaskMemory { J, dJ_dtheta, pivots, M, h, Q, row, .. } = self;
        for list in [J, dJ_dtheta, pivots, M, h, Q, row] {
            list.fill(nan);
        }
        self.columns.fill(Twist::from_array([nan; 6]));
    }
}

/// The singular values of a matrix of up to six rows, by rows, largest first; 0 for rows that it lacks. J is rotated
/// into a 6 × 6 triangle, six columns at a time.
fn singular_values<S: Scalar + Into<f64>>(J: &[S], rows: usize, n: usize) -> Vector6<f64> {
    let mut R = Matrix6::zeros();
    for first in (0..n).step_by(6) {
        let mut stacked = SMatrix::<f64, 12, 6>::zeros();
        stacked.fixed_rows_mut::<6>(0).copy_from(&R);
        for (j, row) in (first..n.min(first + 6)).zip(6..) {
            (0..rows).for_each(|r| stacked[(row, r)] = J[r * n + j].into());
        }
        R = stacked.qr().r();
    }
    let mut sigma = R.singular_values();
    (n..6).for_each(|k| sigma[k] = 0.0); // more rows than joints
    sigma
}

impl<S: Scalar + Into<f64>> TaskMemory<S> {
    /// True if the rows are dependent or cannot move: the smallest singular value of J's k rows is at most 10⁻¹² of the
    /// norm of all six rows, or a pivot is not positive. No allocation.
    pub(crate) fn is_singular(&self, n: usize) -> bool {
        let (k, tolerance) = (self.rows(), self.tolerance());
        let sigma = singular_values(&self.J, k, n);
        (0..k).any(|i| !(sigma[i] > tolerance)) || self.pivots[..k].iter().any(|&pivot| !(pivot.into() > 0.0))
    }

    /// The singular value of J that counts as 0.
    fn tolerance(&self) -> f64 {
        let numbers = self.columns.iter().flat_map(|column| column.to_array()).map(Into::<f64>::into);
        RANK * Scalar::sqrt(numbers.map(|x| x * x).sum::<f64>())
    }
}

/// The smallest part of J's norm that counts as motion of a row.
const RANK: f64 = 1e-12;

impl TaskMemory {
    /// Checks that the rows are independent and can move: the smallest singular value of their J is above 10⁻¹² of the
    /// norm of all six rows. Singular values are computed only if a quick test of the pivots fails.
    ///
    /// # Errors
    /// [`Error::SingularTask`] with the singular values.
    pub(crate) fn check(&self, n: usize, theta: &[f64]) -> Result<(), Error> {
        if Pivots::new(&self.pivots).are_clear() || theta.iter().any(|x| !x.is_finite()) {
            return Ok(());
        }
        if self.is_singular(n) {
            let k = self.rows();
            let singular_values = singular_values(&self.J, k, n).as_slice()[..k].to_vec();
            let tolerance = self.tolerance();
            return Err(Error::SingularTask { singular_values, tolerance, theta: theta.to_vec() });
        }
        Ok(())
    }
}
