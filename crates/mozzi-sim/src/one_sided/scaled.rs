//! A problem whose blocks have a G of about 1 on the diagonal: rows in rad/s and in m/s, of light and of heavy links,
//! are then alike. The factors are powers of two, so that nothing is rounded.

use super::{Law, Problem, blocks, residual_with};
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector};

/// A row whose g is below this part of the largest is rounding, such as that of a loop's constraint which holds anyway.
const NOISE: f64 = 1e-22;

/// The scaled problem, and the best impulses so far, scaled.
pub(super) struct Scaled {
    pub problem: Problem,
    /// R, n × m, with G = RᵀR, where it is known.
    pub root: Option<DMatrix<f64>>,
    /// √g of each row, to the next power of two.
    factors: Vec<f64>,
    pub best: DVector<f64>,
    /// The residual of `best`, as a velocity of the problem before scaling.
    pub residual: f64,
}

impl Scaled {
    /// The problem of this G, without a b yet.
    pub fn new(G: &DMatrix<f64>, laws: &[Law], mut root: Option<DMatrix<f64>>) -> Self {
        let scales = scales(G, laws);
        let largest = scales.iter().fold(0.0_f64, |most, g| most.max(*g));
        let factors: Vec<f64> = scales.iter().map(|&g| power(if g > NOISE * largest { g } else { largest })).collect();
        let m = factors.len();
        let mut scaled = G.clone();
        for (mut column, &c) in scaled.column_iter_mut().zip(&factors) {
            column.iter_mut().zip(&factors).for_each(|(x, &r)| *x *= (1.0 / c) * (1.0 / r));
        }
        let laws = blocks(laws).map(|(first, law)| match law {
            Law::Dry { most } => Law::Dry { most: most * factors[first] },
            law => law,
        });
        for (mut column, &c) in root.iter_mut().flat_map(|R| R.column_iter_mut()).zip(&factors) {
            column *= 1.0 / c;
        }
        let problem = Problem { G: scaled, b: DVector::zeros(m), laws: laws.collect() };
        Scaled { problem, root, factors, best: DVector::zeros(m), residual: f64::NAN }
    }

    /// True if the rows have the same factors.
    pub fn is_scaled_as(&self, other: &Scaled) -> bool {
        self.factors == other.factors
    }

    /// Another b, and impulses to begin with.
    pub fn begin(&mut self, b: &DVector<f64>, guess: &DVector<f64>) {
        for (r, &factor) in self.factors.iter().enumerate() {
            (self.problem.b[r], self.best[r]) = (b[r] / factor, guess[r] * factor);
        }
        self.residual = residual_with(&self.problem, &self.factors, &self.best);
    }

    /// Keeps the admissible impulses next to p if they are better: true if so.
    pub fn offer(&mut self, p: &DVector<f64>) -> bool {
        let mut p = p.clone();
        self.problem.project(&mut p);
        let residual = residual_with(&self.problem, &self.factors, &p);
        let is_better = residual < self.residual || self.residual.is_nan();
        if is_better {
            (self.best, self.residual) = (p, residual);
        }
        is_better
    }

    /// The best impulses, not scaled.
    pub fn impulses(&self) -> DVector<f64> {
        DVector::from_fn(self.best.len(), |r, _| self.best[r] / self.factors[r])
    }
}

/// g of each row: the mean diagonal entry of G in the row's block. 1 for a block that nothing moves.
pub(super) fn scales(G: &DMatrix<f64>, laws: &[Law]) -> Vec<f64> {
    let mut scales = Vec::with_capacity(G.nrows());
    for (first, law) in blocks(laws) {
        let rows = law.rows();
        let mean = (first..first + rows).map(|r| G[(r, r)]).sum::<f64>() / rows as f64;
        scales.extend(core::iter::repeat_n(if mean > 0.0 { mean } else { 1.0 }, rows));
    }
    scales
}

/// 2ᵏ with g/4ᵏ from ½ to 2.
fn power(g: f64) -> f64 {
    let exponent = ((g.to_bits() >> 52) & 0x7ff) as i64 - 1023;
    f64::from_bits((((exponent + 1).div_euclid(2) + 1023) as u64) << 52)
}

#[cfg(test)]
mod tests {
    #[test]
    fn roots_are_powers_of_two() {
        for (g, expected) in
            [(1.0, 1.0), (1.9, 1.0), (2.0, 2.0), (4.0, 2.0), (0.25, 0.5), (0.5, 1.0), (3e-5, 2f64.powi(-8))]
        {
            assert_eq!(super::power(g), expected, "{g}");
        }
    }
}
