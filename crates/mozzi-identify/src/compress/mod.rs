//! All equations of a log as triangles, one for each force and each of ten parts of the log: whatever follows, such as
//! other weights, other parts held out, or other priors, costs nothing of the number of samples.

mod triangle;

pub use triangle::Triangle;

use crate::Error;
use crate::columns::{Columns, Equations};
use crate::cores::each;
use crate::signals::Samples;
use mozzi::random::Random;
use nalgebra::DMatrix;

/// Parts of a log, of equal length in time.
pub const PARTS: usize = 10;

/// Samples that are added to the triangles together.
const BATCH: usize = 256;

/// The equations of one force in one part of a log.
pub type Weight<'a> = &'a (dyn Fn(usize, &[f64], &[f64], &mut [f64]) + Sync);

/// The columns of each force that are not 0 at every state.
#[derive(Clone, Debug)]
pub struct Pattern(pub Vec<Vec<usize>>);

impl Pattern {
    /// By the equations at three random states.
    ///
    /// # Errors
    /// [`Error::Model`].
    pub fn new(columns: &Columns<'_>) -> Result<Self, Error> {
        let (n, P) = (columns.model.n(), columns.count());
        let stacked = stacked(columns, 3)?;
        let is_there = |j: usize, k: usize| (0..3).any(|s| stacked[(s * n + j, k)] != 0.0);
        Ok(Pattern((0..n).map(|j| (0..P).filter(|&k| is_there(j, k)).collect()).collect()))
    }
}

/// The equations at random states, stacked; their rank shows which combinations some motion can determine.
///
/// # Errors
/// [`Error::Model`].
pub fn stacked(columns: &Columns<'_>, states: usize) -> Result<DMatrix<f64>, Error> {
    let (model, P) = (columns.model, columns.count());
    let n = model.n();
    let mut random = Random(1);
    let mut equations = Equations::new(columns, &Samples::default())?;
    let (mut A, mut b, mut all) = (vec![0.0; n * P], vec![0.0; n], Vec::with_capacity(states * n * P));
    for _ in 0..states {
        let mut theta = model.neutral_configuration();
        mozzi::model::integrate(model, &mut theta, &random.vector(n, 3.0), 1.0);
        let (dtheta, ddtheta, tau) = (random.vector(n, 2.0), random.vector(n, 4.0), random.vector(n, 10.0));
        equations.at([&theta, &dtheta, &ddtheta, &tau], &mut A, &mut b);
        all.extend_from_slice(&A);
    }
    Ok(DMatrix::from_row_slice(states * n, P, &all))
}

/// The equations of one log.
#[derive(Clone, Debug)]
pub struct Compressed {
    /// By part, then by force: triangles in the columns of the pattern.
    pub parts: Vec<Vec<Triangle>>,
    /// The share of independent samples.
    pub independent: f64,
}

impl Compressed {
    /// Compresses all equations of a log on all cores. `weight` may change the weights of a sample's equations, which
    /// are 1: it gets the sample's index, its A and its b. The result does not depend on the number of cores.
    ///
    /// # Errors
    /// [`Error::Model`].
    pub fn new(
        columns: &Columns<'_>,
        pattern: &Pattern,
        samples: &Samples,
        weight: Option<Weight>,
    ) -> Result<Self, Error> {
        let n = columns.model.n();
        let empty: Vec<Triangle> = pattern.0.iter().map(|of| Triangle::new(of.len())).collect();
        let edge = |part: usize| part * samples.count() / PARTS;
        let parts = each(PARTS, samples.count() * n * columns.count(), |part| {
            let mut triangles = empty.clone();
            fill(columns, pattern, samples, edge(part)..edge(part + 1), weight, &mut triangles).map(|()| triangles)
        });
        let parts = parts.into_iter().collect::<Result<_, _>>()?;
        Ok(Compressed { parts, independent: samples.independent() })
    }
}

fn fill(
    columns: &Columns<'_>,
    pattern: &Pattern,
    samples: &Samples,
    range: core::ops::Range<usize>,
    weight: Option<Weight>,
    triangles: &mut [Triangle],
) -> Result<(), Error> {
    let (n, P) = (columns.model.n(), columns.count());
    let mut equations = Equations::new(columns, samples)?;
    let (mut A, mut b, mut w) = (vec![0.0; n * P], vec![0.0; n], vec![1.0; n]);
    let (mut batches, mut squares): (Vec<Vec<f64>>, _) = (vec![Vec::new(); n], vec![0.0; n]);
    let mut flush = |batches: &mut [Vec<f64>]| {
        for ((triangle, batch), of) in triangles.iter_mut().zip(batches).zip(&pattern.0) {
            let rows = batch.len() / (of.len() + 1);
            if rows > 0 {
                triangle.push(DMatrix::from_row_slice(rows, of.len() + 1, batch), rows);
            }
            batch.clear();
        }
    };
    for (count, k) in range.enumerate() {
        equations.fill(samples, k, &mut A, &mut b);
        if let Some(weight) = weight {
            w.fill(1.0);
            weight(k, &A, &b, &mut w);
        }
        for j in (0..n).filter(|&j| samples.is_valid[k * n + j]) {
            batches[j].extend(pattern.0[j].iter().map(|&c| w[j] * A[j * P + c]).chain([w[j] * b[j]]));
            // of what was measured, also where a part of it is known; currents have no unit of force
            let force = if columns.choice.gains { b[j] } else { samples.tau[k * n + j] };
            squares[j] += (w[j] * force).powi(2);
        }
        if count % BATCH == BATCH - 1 {
            flush(&mut batches);
        }
    }
    flush(&mut batches);
    triangles.iter_mut().zip(squares).for_each(|(triangle, square)| triangle.square += square);
    Ok(())
}

/// The equations of some parts of some logs, one triangle for each force.
#[derive(Clone, Debug)]
pub struct Evidence {
    /// The columns of each triangle.
    pub pattern: Pattern,
    /// By force.
    pub forces: Vec<Triangle>,
    /// The number of unknowns.
    pub unknowns: usize,
    /// The share of independent samples.
    pub independent: f64,
}

impl Evidence {
    /// Merges the parts of logs that `is_in` accepts, by log and part.
    pub fn new(pattern: &Pattern, unknowns: usize, logs: &[Compressed], is_in: impl Fn(usize, usize) -> bool) -> Self {
        let mut forces: Vec<Triangle> = pattern.0.iter().map(|of| Triangle::new(of.len())).collect();
        let (mut rows, mut independent) = (0.0, 0.0);
        for (log, compressed) in logs.iter().enumerate() {
            for (part, triangles) in compressed.parts.iter().enumerate() {
                if is_in(log, part) {
                    for (all, one) in forces.iter_mut().zip(triangles) {
                        all.merge(one, 1.0);
                        rows += one.rows as f64;
                        independent += one.rows as f64 * compressed.independent;
                    }
                }
            }
        }
        let independent = if rows > 0.0 { independent / rows } else { 1.0 };
        Evidence { pattern: pattern.clone(), forces, unknowns, independent }
    }

    /// All equations of a few samples.
    ///
    /// # Errors
    /// [`Error::Model`].
    pub fn of_samples(columns: &Columns<'_>, pattern: &Pattern, samples: &Samples) -> Result<Self, Error> {
        let mut forces: Vec<Triangle> = pattern.0.iter().map(|of| Triangle::new(of.len())).collect();
        fill(columns, pattern, samples, 0..samples.count(), None, &mut forces)?;
        let (pattern, independent) = (pattern.clone(), samples.independent());
        Ok(Evidence { pattern, forces, unknowns: columns.count(), independent })
    }

    /// Root mean square of each force.
    pub fn rms(&self) -> Vec<f64> {
        self.forces.iter().map(|force| (force.square / force.rows.max(1) as f64).sqrt()).collect()
    }

    /// Root mean square error of each force, for these unknowns.
    pub fn rmse(&self, x: &[f64]) -> Vec<f64> {
        let of = |(triangle, columns): (&Triangle, &Vec<usize>)| {
            let x: Vec<f64> = columns.iter().map(|&k| x[k]).collect();
            (triangle.error(&x) / triangle.rows.max(1) as f64).sqrt()
        };
        self.forces.iter().zip(&self.pattern.0).map(of).collect()
    }

    /// The largest number of equations of a force: the number of samples.
    pub fn samples(&self) -> usize {
        self.forces.iter().map(|force| force.rows).max().unwrap_or(0)
    }

    /// One triangle in all unknowns, each force divided by its σ and by √N: the weighted sum of squares per sample.
    pub fn weighted(&self, sigma: &[f64]) -> Triangle {
        let N = (self.samples().max(1) as f64).sqrt();
        let mut all = Triangle::new(self.unknowns);
        for ((force, columns), sigma) in self.forces.iter().zip(&self.pattern.0).zip(sigma) {
            let mut B = DMatrix::zeros(force.R.nrows(), self.unknowns + 1);
            let own = force.unknowns();
            for (k, &c) in columns.iter().chain([&self.unknowns]).enumerate() {
                B.column_mut(c).copy_from(&force.R.column(k.min(own)));
            }
            // its columns ascend: column c has entries in its first c + 1 rows alone
            all.push_upper(B / (sigma * N), force.rows);
        }
        all
    }
}
