//! One step of a least-squares method under bounds: δ = JᵀA⁻¹e with A = JJᵀ + λI, six equations however many joints
//! there are.

use super::bounds::Within;
use mozzi::model::Bounds;
use mozzi::nalgebra::{Matrix6, SymmetricEigen, Vector6};
use mozzi::{Freedom, Place, Twist};
use std::ops::Range;

/// How a step is damped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// The Newton-Raphson method, by the pseudo-inverse (Modern Robotics, section 6.2.2): δ = J⁺e. Few iterations from
    /// a near guess; erratic far from the goal and near singular positions.
    Newton,
    /// The Levenberg-Marquardt method with λ = ‖e‖²/50 (after Chan and Lawrence 1988): δ = Jᵀ(JJᵀ + λI)⁻¹e. Cautious
    /// far from the goal, like Newton's near it.
    LevenbergMarquardt,
}

/// Eigenvalues of JJᵀ below this fraction of the largest belong to directions that no joint moves.
const NEGLIGIBLE: f64 = 1e-12;

/// The columns of J at a position, without those of joints held at a bound.
#[derive(Clone, Debug)]
pub(super) struct Step {
    /// J with v in units of the length in the options, one column for each velocity.
    pub columns: Vec<Twist>,
    /// Velocities that are 0.
    pub held: Vec<bool>,
    /// Balls at their largest angle, which turn no further: nᵀω = 0.
    pub cones: Vec<(Place, [f64; 3])>,
    pub rows: Range<usize>,
}

impl Step {
    fn column(&self, j: usize) -> Vector6<f64> {
        let mut column = Vector6::from(self.columns[j].to_array());
        for row in (0..6).filter(|row| !self.rows.contains(row)) {
            column[row] = 0.0;
        }
        column
    }

    fn moving(&self) -> impl Iterator<Item = (usize, Vector6<f64>)> {
        (0..self.columns.len()).filter(|&j| !self.held[j]).map(|j| (j, self.column(j)))
    }

    /// JJᵀ of the joints that move.
    fn gram(&self) -> Matrix6<f64> {
        self.moving().fold(Matrix6::zeros(), |A, (_, column)| A + column * column.transpose())
    }

    /// Jᵀy, 0 at held joints.
    fn transpose_mul(&self, y: &Vector6<f64>, delta: &mut [f64]) {
        delta.fill(0.0);
        self.moving().for_each(|(j, column)| delta[j] = column.dot(y));
    }

    /// δ towards the error e.
    pub fn towards(&self, e: &Vector6<f64>, method: Method, delta: &mut [f64]) {
        let mut A = self.gram();
        let damping = match method {
            Method::Newton => 0.0,
            Method::LevenbergMarquardt => 0.02 * e.norm_squared(),
        };
        let floor = NEGLIGIBLE * A.trace().max(f64::MIN_POSITIVE);
        (0..6).for_each(|row| A[(row, row)] += damping.max(floor));
        let cholesky = if method == Method::Newton { None } else { A.cholesky() };
        let y = cholesky.map_or_else(|| pseudo_inverse(self.gram()) * e, |A| A.solve(e));
        self.transpose_mul(&y, delta);
    }

    /// No joint is held.
    pub fn let_go(&mut self) {
        self.held.fill(false);
        self.cones.clear();
    }

    /// z without the part that would move the frame: (I − J⁺J)z of the joints that move.
    /// `back` is overwritten.
    pub fn within_null_space(&self, z: &mut [f64], back: &mut [f64]) {
        self.cones.iter().for_each(|(place, n)| remove_along(n, &mut z[place.velocities()]));
        let moved = self.moving().fold(Vector6::zeros(), |V, (j, column)| V + column * z[j]);
        let y = pseudo_inverse(self.gram()) * moved;
        self.transpose_mul(&y, back);
        for ((z, back), held) in z.iter_mut().zip(&*back).zip(&self.held) {
            *z = if *held { 0.0 } else { *z - back };
        }
    }

    /// Holds the joints at a bound that δ would take beyond it; returns true if there were any. A ball's columns lose
    /// their part along n, J ← J(I − nnᵀ), and so does δ = Jᵀy.
    pub fn hold_at_bounds(&mut self, bounds: &Bounds, theta: &[f64], delta: &[f64]) -> bool {
        let mut found = false;
        for (k, place) in bounds.places.iter().enumerate() {
            let side = bounds.side(theta, k);
            match place.freedom {
                Freedom::One if !self.held[place.j] && side * delta[place.j] > 0.0 => self.held[place.j] = true,
                Freedom::Ball if side > 0.0 && self.cones.iter().all(|(held, _)| held != place) => {
                    let n = place.bounded_gradient(theta);
                    if delta[place.velocities()].iter().zip(n).map(|(x, n)| x * n).sum::<f64>() <= 0.0 {
                        continue;
                    }
                    let columns = &mut self.columns[place.velocities()];
                    let along = columns.iter().zip(n).fold(Twist::zero(), |sum, (column, n)| sum + *column * n);
                    columns.iter_mut().zip(n).for_each(|(column, n)| *column -= along * n);
                    self.cones.push((*place, n));
                }
                _ => continue,
            }
            found = true;
        }
        found
    }
}

/// x ← (I − nnᵀ)x.
fn remove_along(n: &[f64; 3], x: &mut [f64]) {
    let along: f64 = x.iter().zip(n).map(|(x, n)| x * n).sum();
    x.iter_mut().zip(n).for_each(|(x, n)| *x -= along * n);
}

/// A⁺ of a symmetric positive semi-definite matrix.
fn pseudo_inverse(A: Matrix6<f64>) -> Matrix6<f64> {
    let SymmetricEigen { eigenvalues, eigenvectors } = A.symmetric_eigen();
    let least = NEGLIGIBLE * eigenvalues.max();
    let inverse = eigenvalues.map(|x| if x > least { 1.0 / x } else { 0.0 });
    eigenvectors * Matrix6::from_diagonal(&inverse) * eigenvectors.transpose()
}
