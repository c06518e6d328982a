//! The pivots of a factorization of the mass matrix, and the rule that judges whether it is singular.

use super::{Error, Model};
use crate::scalar::{Float, Scalar};
use alloc::string::ToString;
use alloc::vec::Vec;

/// The pivots of LᵀDL or of articulated bodies, one for each velocity. A pivot is a joint's inertia with the joints
/// beyond it free.
///
/// The rule: a pivot is regular if it is above 64 ε M_jj, where M_jj is the joint's inertia with the joints beyond it
/// locked. M is computed only if the quick test [`are_clear`](Self::are_clear) fails.
#[derive(Clone, Copy, Debug)]
pub struct Pivots<'a, S = f64>(&'a [S]);

impl<'a, S: Copy + Into<f64>> Pivots<'a, S> {
    /// The pivots in this list.
    pub fn new(pivots: &'a [S]) -> Self {
        Pivots(pivots)
    }

    /// The quick test, without M: true if every pivot is well above rounding error of the largest.
    #[inline]
    pub fn are_clear(&self) -> bool {
        let (mut least, mut sum) = (f64::INFINITY, 0.0);
        for &pivot in self.0 {
            let pivot = pivot.into();
            // one instruction each; a NaN stays in the sum
            (least, sum) = (if pivot < least { pivot } else { least }, sum + pivot);
        }
        self.0.is_empty() || least_is_clear(least, sum)
    }
}

impl<S: Copy + Into<f64>> Pivots<'_, S> {
    /// The outermost velocity whose pivot fails the rule, M(θ) being given, n × n: it spoils the pivots closer to the
    /// base.
    ///
    /// # Panics
    /// When M is not n².
    pub fn first_singular(&self, n: usize, M: &[f64]) -> Option<usize> {
        assert!(M.len() == n * n, "M has {} entries, expected {}", M.len(), n * n);
        let is_regular = |j: usize| {
            let pivot: f64 = self.0[j].into();
            pivot > 64.0 * f64::EPSILON * M[j * n + j] && pivot.is_finite()
        };
        (0..self.0.len()).rev().find(|&j| !is_regular(j))
    }
}

impl Pivots<'_> {
    /// Applies the rule. `mass_matrix` is called for M(θ), n × n, only if the pivots are not [clear](Self::are_clear).
    ///
    /// # Errors
    /// [`Error::SingularMassMatrix`] with the outermost joint whose pivot fails: it spoils the pivots closer to the
    /// base.
    pub fn check(&self, model: &Model, theta: &[f64], mass_matrix: impl FnOnce() -> Vec<f64>) -> Result<(), Error> {
        if self.are_clear() || theta.iter().any(|x| !x.is_finite()) {
            return Ok(());
        }
        let (n, M) = (model.n(), mass_matrix());
        let Some(j) = self.first_singular(n, &M) else { return Ok(()) };
        let joint = model.velocity_names().nth(j).unwrap_or_default().to_string();
        Err(Error::SingularMassMatrix { joint, pivot: self.0[j], diagonal: M[j * n + j], theta: theta.to_vec() })
    }
}

/// The quick test from the smallest pivot and the sum of all: least > √ε/4 · sum. False for NaN and infinity.
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn least_is_clear<T: Float>(least: T, sum: T) -> bool {
    clearance(least, sum, T::EPSILON) > T::zero()
}

/// least − √ε/4 · sum, positive if the pivots pass the quick test, for each state of a register. ε is that of the
/// number type.
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn clearance<S: Scalar + From<T>, T: Float>(least: S, sum: S, epsilon: T) -> S {
    least - S::from(epsilon.sqrt() * T::from_f64(0.25)) * sum
}
