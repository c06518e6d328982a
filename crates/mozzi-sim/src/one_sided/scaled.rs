//! A problem whose blocks have a G of about 1 on the diagonal: rows in rad/s and in m/s, of light and of heavy links,
//! are then alike. The factors are powers of two, so that nothing is rounded.

use super::{Law, Problem, residual_with};
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector};

/// A row whose g is below this part of the largest is rounding, such as that of a loop's constraint which holds anyway.
const NOISE: f64 = 1e-22;

/// The scaled problem, and the best impulses so far, scaled.
pub(super) struct Scaled {
    pub problem: Problem,
    /// √g of each row, to the next power of two.
    root: Vec<f64>,
    pub best: DVector<f64>,
    /// The residual of `best`, as a velocity of the problem before scaling.
    pub residual: f64,
}

impl Scaled {
    pub fn new(problem: &Problem, guess: &DVector<f64>) -> Self {
        let scales = problem.scales();
        let largest = scales.iter().fold(0.0_f64, |most, g| most.max(*g));
        let root: Vec<f64> = scales.iter().map(|&g| root(if g > NOISE * largest { g } else { largest })).collect();
        let m = root.len();
        let G = DMatrix::from_fn(m, m, |r, c| problem.G[(r, c)] / root[r] / root[c]);
        let b = DVector::from_fn(m, |r, _| problem.b[r] / root[r]);
        let laws = problem.blocks().map(|(first, law)| match law {
            Law::Dry { most } => Law::Dry { most: most * root[first] },
            law => law,
        });
        let problem = Problem { G, b, laws: laws.collect() };
        let best = DVector::from_fn(m, |r, _| guess[r] * root[r]);
        let residual = residual_with(&problem, &root, &best);
        Scaled { problem, root, best, residual }
    }

    /// Keeps the admissible impulses next to p if they are better: true if so.
    pub fn offer(&mut self, p: &DVector<f64>) -> bool {
        let mut p = p.clone();
        self.problem.project(&mut p);
        let residual = residual_with(&self.problem, &self.root, &p);
        let is_better = residual < self.residual || self.residual.is_nan();
        if is_better {
            (self.best, self.residual) = (p, residual);
        }
        is_better
    }

    /// The best impulses, not scaled.
    pub fn impulses(&self) -> DVector<f64> {
        DVector::from_fn(self.best.len(), |r, _| self.best[r] / self.root[r])
    }
}

/// 2ᵏ with g/4ᵏ from ½ to 2.
fn root(g: f64) -> f64 {
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
            assert_eq!(super::root(g), expected, "{g}");
        }
    }
}
