//! Weighted least squares on base parameters: iteratively reweighted by each force's own noise.

use crate::Error;
use crate::compress::{Evidence, Triangle};
use mozzi::BaseParameters;
use nalgebra::{DMatrix, DVector};

/// Directions with a smaller singular value, relative to the largest, of the equations with unit columns are not
/// determined by the motion.
const DETERMINED: f64 = 1e-6;

/// The least error of a force, as a part of the largest force: sensors do not resolve more, and a joint without any
/// force would outweigh all others.
const RESOLVED: f64 = 1e-6;

/// The least share of the noise that the unknowns leave in the residuals.
const LEAST_FREEDOM: f64 = 0.05;

/// Rounds of reweighting.
const ROUNDS: usize = 20;

/// Estimated base parameters with their standard deviations.
#[derive(Clone, Debug)]
pub struct LeastSquares {
    /// Values of the base parameters.
    pub values: Vec<f64>,
    /// Their standard deviations, from the residuals and the number of independent samples; infinite for those that
    /// the motion does not determine.
    pub deviations: Vec<f64>,
    /// All unknowns: base parameters at their own columns, the others 0. The forces are the same.
    pub x: Vec<f64>,
    /// σ of each force's residuals.
    pub sigma: Vec<f64>,
    /// Condition number of the weighted equations with unit columns.
    pub condition: f64,
    /// The number of directions that the motion determines.
    pub rank: usize,
}

impl LeastSquares {
    /// Minimizes Σ_j ‖A_j x − b_j‖²/σ_j² over the base parameters; σ_j is each force's own residual, found in turns.
    ///
    /// # Errors
    /// [`Error::NotExciting`] if the equations or all forces are 0, or if there are fewer than base parameters.
    pub fn new(evidence: &Evidence, base: &BaseParameters) -> Result<Self, Error> {
        let rows: usize = evidence.forces.iter().map(|force| force.rows).sum();
        let r = base.count();
        if rows <= r || evidence.forces.iter().all(|force| force.R.amax() == 0.0) {
            let reason = format!("{rows} equations that are not 0, for {r} base parameters");
            return Err(Error::NotExciting { reason });
        }
        let most = evidence.rms().into_iter().fold(0.0, f64::max);
        if !(most > 0.0 && most.is_finite()) {
            let reason = if most > 0.0 { "the forces are too large to be squared" } else { "all forces are 0" };
            return Err(Error::NotExciting { reason: reason.into() });
        }
        let least = RESOLVED * most;
        // a force that is 0, such as a floating base's, begins with the weight of the largest
        let start = |rms: f64| if rms > 1e-9 * most { rms } else { most };
        let mut sigma: Vec<f64> = evidence.rms().into_iter().map(start).collect();
        // each force's share of the unknowns, as if they were spread evenly: they fit as many independent samples
        let freedom = (1.0 - r as f64 / (rows as f64 * evidence.independent)).max(LEAST_FREEDOM).sqrt();
        for _ in 0..ROUNDS {
            let x = weighted_by(evidence, base, &sigma);
            let next: Vec<f64> = evidence.rmse(&x).into_iter().map(|e| (e / freedom).max(least)).collect();
            let change = next.iter().zip(&sigma).map(|(a, b)| (a / b).ln().abs()).fold(0.0, f64::max);
            sigma = next;
            if change < 1e-6 {
                break;
            }
        }
        let R = reduced(&evidence.weighted(&sigma), base);
        let independent = (evidence.samples() as f64 * evidence.independent).sqrt();
        let Solution { values, deviations, condition, rank } = Solution::new(&R);
        let x = spread(base, &values, evidence.unknowns);
        let deviations = deviations.into_iter().map(|d| d / independent).collect();
        Ok(LeastSquares { deviations, values, x, sigma, condition, rank })
    }
}

/// All unknowns of least squares with these σ of the forces.
pub fn weighted_by(evidence: &Evidence, base: &BaseParameters, sigma: &[f64]) -> Vec<f64> {
    let values = solve(&reduced(&evidence.weighted(sigma), base));
    spread(base, &values, evidence.unknowns)
}

/// Base parameters at their columns, 0 at the others.
fn spread(base: &BaseParameters, values: &[f64], unknowns: usize) -> Vec<f64> {
    let mut x = vec![0.0; unknowns];
    base.columns.iter().zip(values).for_each(|(&k, value)| x[k] = *value);
    x
}

/// A solution with what is known about it.
struct Solution {
    values: Vec<f64>,
    /// For one sample of weight 1.
    deviations: Vec<f64>,
    condition: f64,
    rank: usize,
}

impl Solution {
    /// By substitution; by singular values, if the triangle is close to singular.
    fn new(triangle: &Triangle) -> Self {
        let by_singular_values = || {
            let all = Decomposition::new(triangle);
            let (values, deviations) = (all.solution(), all.deviations());
            Solution { values, deviations, condition: all.condition(), rank: all.rank() }
        };
        let P = triangle.unknowns();
        let Some(inverse) = regular_inverse(triangle) else { return by_singular_values() };
        let R = triangle.R.view((0, 0), (P, P));
        let norm = DVector::from_iterator(P, R.column_iter().map(|column| column.norm()));
        // R with unit columns is R/‖·‖, its inverse ‖·‖R⁻¹
        let largest = power(P, |v| R.tr_mul(&(R * v.component_div(&norm))).component_div(&norm));
        let of_inverse = |v: &DVector<f64>| {
            let w = inverse.tr_mul(&v.component_mul(&norm));
            (&inverse * w).component_mul(&norm)
        };
        let condition = (largest * power(P, of_inverse)).sqrt();
        if !(condition < 0.1 / DETERMINED) {
            return by_singular_values();
        }
        let values = (&inverse * triangle.R.view((0, P), (P, 1))).iter().copied().collect();
        let deviations = inverse.row_iter().map(|row| row.norm()).collect();
        Solution { values, deviations, condition, rank: P }
    }
}

/// The largest eigenvalue of a symmetric positive matrix, to a few percent, by power iteration.
fn power(P: usize, product: impl Fn(&DVector<f64>) -> DVector<f64>) -> f64 {
    let mut random = mozzi::random::Random(2);
    let (mut v, mut value) = (DVector::from_vec(random.vector(P, 1.0)).normalize(), 0.0);
    for _ in 0..60 {
        let next = product(&v);
        value = next.norm();
        if value == 0.0 {
            break;
        }
        v = next / value;
    }
    value
}

/// R⁻¹, unless a diagonal entry is close to 0 relative to its column.
fn regular_inverse(triangle: &Triangle) -> Option<DMatrix<f64>> {
    let P = triangle.unknowns();
    let R = triangle.R.view((0, 0), (P, P));
    let is_clear = |k: usize| R[(k, k)].abs() > DETERMINED * R.column(k).norm();
    if (0..P).all(is_clear) { R.solve_upper_triangular(&DMatrix::identity(P, P)) } else { None }
}

/// The triangle of the base parameters' columns alone.
pub fn reduced(all: &Triangle, base: &BaseParameters) -> Triangle {
    let columns: Vec<usize> = base.columns.iter().copied().chain([all.unknowns()]).collect();
    let mut R = Triangle::new(base.count());
    R.push(all.R.select_columns(&columns), all.rows);
    R
}

/// The solution by substitution, or by singular values if the triangle is singular.
fn solve(triangle: &Triangle) -> Vec<f64> {
    let P = triangle.unknowns();
    let R = triangle.R.view((0, 0), (P, P));
    let is_clear = |k: usize| R[(k, k)].abs() > DETERMINED * R.column(k).norm();
    if (0..P).all(is_clear)
        && let Some(x) = R.solve_upper_triangular(&triangle.R.view((0, P), (P, 1)))
    {
        return x.iter().copied().collect();
    }
    Decomposition::new(triangle).solution()
}

/// Singular values of a triangle with unit columns.
#[derive(Clone, Debug)]
pub struct Decomposition {
    u: DMatrix<f64>,
    v: DMatrix<f64>,
    s: DVector<f64>,
    z: DVector<f64>,
    size: DVector<f64>,
}

impl Decomposition {
    /// Decomposes a triangle.
    pub fn new(triangle: &Triangle) -> Self {
        let P = triangle.unknowns();
        let mut R = triangle.R.view((0, 0), (P, P)).clone_owned();
        let size = DVector::from_iterator(P, R.column_iter().map(|c| c.norm()));
        let size = size.map(|s| if s > 0.0 { s } else { 1.0 });
        R.column_iter_mut().zip(&size).for_each(|(mut column, s)| column.unscale_mut(*s));
        let z = DVector::from_column_slice(triangle.R.column(P).rows(0, P).clone_owned().as_slice());
        let svd = R.svd(true, true);
        let v = svd.v_t.map_or_else(|| DMatrix::identity(P, P), |v| v.transpose());
        Decomposition { u: svd.u.unwrap_or_else(|| DMatrix::identity(P, P)), v, s: svd.singular_values, z, size }
    }

    fn is_determined(&self, k: usize) -> bool {
        self.s[k] > DETERMINED * self.s.max()
    }

    /// The number of determined directions.
    pub fn rank(&self) -> usize {
        (0..self.s.len()).filter(|&k| self.is_determined(k)).count()
    }

    /// Largest over smallest singular value; infinite if it is singular.
    pub fn condition(&self) -> f64 {
        self.s.max() / self.s.min()
    }

    /// The least-squares solution, of least length in undetermined directions.
    pub fn solution(&self) -> Vec<f64> {
        let mut c = self.u.tr_mul(&self.z);
        (0..c.len()).for_each(|k| c[k] = if self.is_determined(k) { c[k] / self.s[k] } else { 0.0 });
        (&self.v * c).component_div(&self.size).iter().copied().collect()
    }

    /// The standard deviation of each unknown for one sample of weight 1; infinite if undetermined.
    pub fn deviations(&self) -> Vec<f64> {
        let of = |row: usize| {
            let mut sum = 0.0;
            for k in 0..self.s.len() {
                let v = self.v[(row, k)];
                if self.is_determined(k) {
                    sum += (v / self.s[k]).powi(2);
                } else if v.abs() > 1e-3 {
                    return f64::INFINITY;
                }
            }
            sum.sqrt() / self.size[row]
        };
        (0..self.size.len()).map(of).collect()
    }
}
