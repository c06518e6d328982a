//! Numbers with fused multiply-add side by side: a register.

#[cfg(not(all(feature = "std", target_arch = "x86_64")))]
use super::Fused;

#[cfg(all(feature = "std", target_arch = "x86_64"))]
pub type FusedLanes<const L: usize> = of_fused::Register;
#[cfg(not(all(feature = "std", target_arch = "x86_64")))]
pub type FusedLanes<const L: usize> = [Fused; L];

#[cfg(all(feature = "std", target_arch = "x86_64"))]
mod of_fused {
    use crate::scalar::{Fused, Lanes};
    use core::arch::x86_64::*;

    /// Four numbers in a register. Every block below is safe because [`rows`](Lanes::rows), which alone makes the first
    /// registers, panics without FMA.
    #[derive(Clone, Copy, Debug)]
    pub struct Register(__m256d);

    impl<const L: usize> Lanes<Fused, L> for Register {
        #[inline(always)]
        fn rows(numbers: [[Fused; L]; 6]) -> [Self; 6] {
            const { assert!(L <= 4) };
            crate::scalar::assert_fma(); // which needs AVX
            let mut rows = [[Fused(0.0); 4]; 6];
            for r in 0..6 {
                for k in 0..L {
                    rows[r][k] = numbers[r][k];
                }
            }
            let [a, b, c, d, e, f] = rows;
            // SAFETY: see the type.
            let register = |[a, b, c, d]: [Fused; 4]| Register(unsafe { _mm256_setr_pd(a.0, b.0, c.0, d.0) });
            [register(a), register(b), register(c), register(d), register(e), register(f)]
        }
        #[inline(always)]
        fn times(self, factor: Fused) -> Self {
            // SAFETY: see the type.
            Register(unsafe { _mm256_mul_pd(self.0, _mm256_set1_pd(factor.0)) })
        }
        #[inline(always)]
        fn mul_add(self, factor: Fused, c: Self) -> Self {
            // SAFETY: see the type.
            Register(unsafe { _mm256_fmadd_pd(self.0, _mm256_set1_pd(factor.0), c.0) })
        }
        #[inline(always)]
        fn numbers(self) -> [Fused; L] {
            let (mut all, mut numbers) = ([0.0; 4], [Fused(0.0); L]);
            // SAFETY: see the type; four numbers are written.
            unsafe { _mm256_storeu_pd(all.as_mut_ptr(), self.0) };
            for k in 0..L {
                numbers[k] = Fused(all[k]);
            }
            numbers
        }
    }

    #[test]
    fn four_are_as_one_by_one() {
        use crate::scalar::Scalar;
        if !std::is_x86_feature_detected!("fma") {
            return;
        }
        let (a, c) = ([1.1, -2.3, 1e300, 0.1].map(Fused), [0.7, 1e-9, -3.0, f64::NAN].map(Fused));
        let [four, c_four, ..]: [Register; 6] = Lanes::rows([a, c, a, a, a, a]);
        let found: [Fused; 4] = Lanes::<Fused, 4>::mul_add(four, Fused(0.3), c_four).numbers();
        let doubled: [Fused; 4] = Lanes::<Fused, 4>::times(four, Fused(2.0)).numbers();
        for k in 0..4 {
            assert_eq!(found[k].0.to_bits(), Scalar::mul_add(a[k], Fused(0.3), c[k]).0.to_bits());
            assert_eq!(doubled[k].0, 2.0 * a[k].0);
        }
    }
}
