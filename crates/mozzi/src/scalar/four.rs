//! Four numbers of one state side by side, which the compiler would not put into one register by itself.

use super::{Fused, Scalar};

/// Four numbers.
pub trait Four<S>: Copy {
    /// Some if this machine multiplies and adds four of them in one instruction.
    fn at_once() -> Option<FourAtOnce>;

    /// These numbers.
    fn new(at_once: FourAtOnce, numbers: [S; 4]) -> Self;

    /// self · factor + c.
    fn mul_add(self, factor: S, c: Self) -> Self;

    /// As an array.
    fn numbers(self) -> [S; 4];
}

/// Proof that the processor has fused multiply-add on registers of four `f64`.
#[derive(Clone, Copy, Debug)]
pub struct FourAtOnce(());

/// No register: never at once.
impl<S: Scalar> Four<S> for [S; 4] {
    #[inline(always)]
    fn at_once() -> Option<FourAtOnce> {
        None
    }
    #[inline(always)]
    fn new(_: FourAtOnce, numbers: [S; 4]) -> Self {
        numbers
    }
    #[inline(always)]
    fn mul_add(self, factor: S, c: Self) -> Self {
        core::array::from_fn(|k| self[k].mul_add(factor, c[k]))
    }
    #[inline(always)]
    fn numbers(self) -> [S; 4] {
        self
    }
}

#[cfg(all(feature = "std", target_arch = "x86_64"))]
pub use of_fused::FourFused;
#[cfg(not(all(feature = "std", target_arch = "x86_64")))]
pub type FourFused = [Fused; 4];

#[cfg(all(feature = "std", target_arch = "x86_64"))]
mod of_fused {
    use super::{Four, FourAtOnce, Fused};
    use core::arch::x86_64::*;

    /// In one register. Every block below is safe because a value exists only where [`FourAtOnce`] was detected.
    #[derive(Clone, Copy, Debug)]
    pub struct FourFused(__m256d);

    impl Four<Fused> for FourFused {
        #[inline(always)]
        fn at_once() -> Option<FourAtOnce> {
            std::is_x86_feature_detected!("fma").then_some(FourAtOnce(())) // which needs AVX
        }
        #[inline(always)]
        fn new(_: FourAtOnce, [a, b, c, d]: [Fused; 4]) -> Self {
            // SAFETY: see the type.
            FourFused(unsafe { _mm256_setr_pd(a.0, b.0, c.0, d.0) })
        }
        #[inline(always)]
        fn mul_add(self, factor: Fused, c: Self) -> Self {
            // SAFETY: see the type.
            FourFused(unsafe { _mm256_fmadd_pd(self.0, _mm256_set1_pd(factor.0), c.0) })
        }
        #[inline(always)]
        fn numbers(self) -> [Fused; 4] {
            let mut numbers = [0.0; 4];
            // SAFETY: see the type; four numbers are written.
            unsafe { _mm256_storeu_pd(numbers.as_mut_ptr(), self.0) };
            numbers.map(Fused)
        }
    }

    #[test]
    fn four_are_as_one_by_one() {
        use crate::scalar::Scalar;
        let Some(at_once) = FourFused::at_once() else { return };
        let (a, c) = ([1.1, -2.3, 1e300, 0.1].map(Fused), [0.7, 1e-9, -3.0, f64::NAN].map(Fused));
        let found = FourFused::new(at_once, a).mul_add(Fused(0.3), FourFused::new(at_once, c)).numbers();
        for k in 0..4 {
            assert_eq!(found[k].0.to_bits(), Scalar::mul_add(a[k], Fused(0.3), c[k]).0.to_bits());
        }
    }
}
