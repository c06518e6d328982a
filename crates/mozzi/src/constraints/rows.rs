//! The rows of all constraints at a state, dense.

use super::constraint_jacobian;
use crate::linalg::Vec3;
use crate::model::description::Closure;
use crate::model::{Error, Model, TieKind};
use crate::scalar::{Real, Scalar};
use crate::workspace::Workspace;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec;
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector};

/// Singular values below this fraction of the largest count as zero: loops are closed only up to rounding.
pub(crate) const SINGULAR: f64 = 1e-9;
/// cos(α/2) of an angle at which the kernel loses digits.
const HALF_TURN: f64 = 1e-3;

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

impl<C: Real> Model<C> {
    /// Writes into the kernel's φ what is open by a half turn: see [`Model::constraint_errors`].
    #[doc(hidden)] // a start of mozzi-sim's is judged by it
    pub fn add_half_turns(&self, theta: &[C], phi: &mut [C]) {
        let number = C::from_f64;
        let frames = self.ties.list.iter().filter_map(|tie| match &tie.kind {
            TieKind::Frames { closure, .. } => Some((tie.first, *closure)),
            TieKind::Joint { .. } => None,
        });
        for ((first, closure), [a, b]) in frames.zip(self.anchors(theta)) {
            let R = (a.inverse() * b).R;
            let angles = &mut phi[first..];
            match closure {
                Closure::Weld => {
                    let (s, v) = R.quaternion();
                    if s < number(HALF_TURN) {
                        angles[..3].copy_from_slice(&(v * number(2.0)).0);
                    }
                }
                Closure::Hinge => {
                    let [x, y, z] = (R * Vec3([C::zero(), C::zero(), C::one()])).0;
                    if z < C::zero() {
                        let (across, size) = ((x * x + y * y).sqrt(), (number(2.0) * (C::one() - z)).sqrt());
                        let axis = if across > C::zero() { [-y / across, x / across] } else { [C::one(), C::zero()] };
                        angles[..2].copy_from_slice(&axis.map(|c| c * size));
                    }
                }
                _ => {}
            }
        }
    }
}

impl Model<f64> {
    /// A, Ȧθ̇ and φ at a state whose lengths were checked.
    pub(crate) fn constraint_rows_at(&self, theta: &[f64], dtheta: &[f64]) -> Rows {
        let (m, n) = (self.constraint_rows(), self.n());
        let (mut A, mut bias, mut phi) = (vec![0.0; m * n], vec![0.0; m], vec![0.0; m]);
        constraint_jacobian(self, theta, dtheta, &mut Workspace::new(self), &mut A, &mut bias, &mut phi);
        self.add_half_turns(theta, &mut phi);
        Rows { A: DMatrix::from_row_slice(m, n, &A), bias: DVector::from_vec(bias), phi: DVector::from_vec(phi) }
    }

    /// Refuses rows that are not finite: a decomposition of them would not end.
    pub(crate) fn check_rows(&self, Rows { A, bias, phi }: &Rows) -> Result<(), Error> {
        let is_finite =
            |row: &usize| A.row(*row).iter().chain([&phi[*row], &bias[*row]]).all(|number| number.is_finite());
        let Some(row) = (0..phi.len()).find(|row| !is_finite(row)) else { return Ok(()) };
        let found = format!("one at which constraint `{}` is undefined", self.constraint_of_row(row));
        let expected = "finite numbers that are not too large, and no wheel whose axis is normal to its plane";
        Err(Error::BadArgument { what: "the state", found, expected })
    }

    /// φ(θ), m numbers: see [`constraint_jacobian`]. Unlike there, what is open by a half turn is: 2 sin(α/2) times the
    /// axis also of a weld at α = π, and of the angle between the axes of a hinge that are more than 90° apart.
    ///
    /// # Errors
    /// [`Error::WrongLength`].
    pub fn constraint_errors(&self, theta: &[f64]) -> Result<DVector<f64>, Error> {
        self.check_configuration(theta)?;
        Ok(self.constraint_rows_at(theta, &vec![0.0; self.n()]).phi)
    }

    /// The indices of the velocities of the joints with these names.
    pub(crate) fn velocities_of(&self, names: &[&str]) -> Result<Vec<usize>, Error> {
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
    pub(crate) fn velocity_name(&self, j: usize) -> String {
        self.velocity_names().nth(j).unwrap_or_default().to_string()
    }
}

/// The x of least norm that minimizes ‖Ax − b‖.
pub(crate) fn least_squares(A: &DMatrix<f64>, b: &DVector<f64>) -> DVector<f64> {
    if A.nrows() == 0 || A.ncols() == 0 {
        return DVector::zeros(A.ncols());
    }
    if !A.iter().chain(b.iter()).all(|x| x.is_finite()) {
        return DVector::repeat(A.ncols(), f64::NAN); // a decomposition would not end
    }
    let svd = A.clone().svd(true, true);
    let tolerance = SINGULAR * svd.singular_values.max();
    svd.solve(b, tolerance).unwrap_or_else(|_| DVector::zeros(A.ncols()))
}

/// The columns with these indices.
pub(crate) fn columns(A: &DMatrix<f64>, places: &[usize]) -> DMatrix<f64> {
    A.select_columns(places)
}
