//! A few numbers of one state side by side, which the compiler would not put into one register by itself.

use super::Scalar;

/// L numbers, at most four.
#[doc(hidden)]
pub trait Lanes<S, const L: usize>: Copy {
    /// Six rows of numbers.
    ///
    /// # Panics
    /// If they are in registers, and the processor has none with fused multiply-add.
    fn rows(numbers: [[S; L]; 6]) -> [Self; 6];

    /// self · factor.
    fn times(self, factor: S) -> Self;

    /// self · factor + c.
    fn mul_add(self, factor: S, c: Self) -> Self;

    /// As an array.
    fn numbers(self) -> [S; L];
}

impl<S: Scalar, const L: usize> Lanes<S, L> for [S; L] {
    #[inline(always)]
    fn rows(numbers: [[S; L]; 6]) -> [Self; 6] {
        numbers
    }
    #[inline(always)]
    fn times(mut self, factor: S) -> Self {
        for x in &mut self {
            *x = *x * factor;
        }
        self
    }
    #[inline(always)]
    fn mul_add(mut self, factor: S, c: Self) -> Self {
        for k in 0..L {
            self[k] = self[k].mul_add(factor, c[k]);
        }
        self
    }
    #[inline(always)]
    fn numbers(self) -> [S; L] {
        self
    }
}
