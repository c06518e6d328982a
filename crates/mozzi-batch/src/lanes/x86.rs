//! x86-64's registers: AVX2 with fused multiply-add, 4 `f64` or 8 `f32`; AVX-512, 8 `f64` or 16 `f32`.
//!
//! Values of these types are made and used only inside the entries of `instruction_set.rs`, which run only if the
//! processor has the instructions: every unsafe block here relies on that. Each method is inlined into an entry, where
//! it becomes one or two instructions. Negation is −0 − x, which the compiler merges into a fused multiply-add.

use super::Lane;
use core::arch::x86_64::*;
use mozzi::scalar::Bits;

macro_rules! register {
    (
        $(#[$doc:meta])* $L:ident($register:ty) of $width:literal $number:ty;
        $add:ident $sub:ident $mul:ident $div:ident $fma:ident $sqrt:ident $min:ident $max:ident $set:ident $load:ident $store:ident;
        $xor:ident $and:ident $to_bits:ident $from_bits:ident $and_bits:ident $sub_bits:ident $shift:ident::<$places:literal> $set_bits:ident;
        sign |$x:ident, $zero:ident, $one:ident, $minus_one:ident| $sign:expr;
        zip |$a:ident, $b:ident| $zip:expr;
        within |$y:ident, $low:ident, $high:ident| $within:expr;
    ) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        #[repr(transparent)]
        pub struct $L($register);

        // SAFETY (all blocks of this macro): see the module's documentation.
        #[allow(clippy::undocumented_unsafe_blocks)]
        impl $L {
            #[inline(always)]
            fn add(self, other: Self) -> Self { $L(unsafe { $add(self.0, other.0) }) }
            #[inline(always)]
            fn sub(self, other: Self) -> Self { $L(unsafe { $sub(self.0, other.0) }) }
            #[inline(always)]
            fn mul(self, other: Self) -> Self { $L(unsafe { $mul(self.0, other.0) }) }
            #[inline(always)]
            fn div(self, other: Self) -> Self { $L(unsafe { $div(self.0, other.0) }) }
            #[inline(always)]
            fn negative(self) -> Self { Self::from(-0.0) - self }
            #[inline(always)]
            fn square_root(self) -> Self { $L(unsafe { $sqrt(self.0) }) }
            #[inline(always)]
            fn sign(self) -> Self {
                $L(unsafe {
                    let ($x, $zero, $one, $minus_one) = (self.0, $set(0.0), $set(1.0), $set(-1.0));
                    $sign
                })
            }
            #[inline(always)]
            fn times_plus(self, a: Self, b: Self) -> Self { $L(unsafe { $fma(self.0, a.0, b.0) }) }
        }
        super::lane!([] $L);

        impl From<$number> for $L {
            #[inline(always)]
            #[allow(clippy::undocumented_unsafe_blocks)]
            fn from(x: $number) -> Self { $L(unsafe { $set(x) }) }
        }

        #[allow(clippy::undocumented_unsafe_blocks)]
        impl Bits for $L {
            type Number = $number;
            #[inline(always)]
            fn constant(x: $number) -> Self { x.into() }
            #[inline(always)]
            fn xor(self, other: Self) -> Self { $L(unsafe { $xor(self.0, other.0) }) }
            #[inline(always)]
            fn and(self, other: Self) -> Self { $L(unsafe { $and(self.0, other.0) }) }
            #[inline(always)]
            fn lowest_everywhere(self) -> Self {
                $L(unsafe { $from_bits($sub_bits($set_bits(0), $and_bits($to_bits(self.0), $set_bits(1)))) })
            }
            #[inline(always)]
            fn second_lowest_as_sign(self) -> Self {
                $L(unsafe { $from_bits($shift::<$places>($and_bits($to_bits(self.0), $set_bits(2)))) })
            }
        }

        #[allow(clippy::undocumented_unsafe_blocks)]
        impl Lane for $L {
            const WIDTH: usize = $width;
            #[inline(always)]
            fn load(from: &[$number]) -> Self {
                let from = &from[..$width]; // exactly the numbers that are read
                $L(unsafe { $load(from.as_ptr()) })
            }
            #[inline(always)]
            fn store(self, to: &mut [$number]) {
                let to = &mut to[..$width]; // exactly the numbers that are written
                unsafe { $store(to.as_mut_ptr(), self.0) }
            }
            #[inline(always)]
            fn numbers(registers: &[Self]) -> &[$number] {
                // a register holds its numbers in order, is at least as aligned as they are, and every bit pattern is a
                // valid number
                unsafe { core::slice::from_raw_parts(registers.as_ptr().cast(), registers.len() * $width) }
            }
            #[inline(always)]
            fn numbers_mut(registers: &mut [Self]) -> &mut [$number] {
                // likewise; the borrow is exclusive
                unsafe { core::slice::from_raw_parts_mut(registers.as_mut_ptr().cast(), registers.len() * $width) }
            }
            #[inline(always)]
            fn zip(self, other: Self) -> (Self, Self) {
                let (low, high) = unsafe {
                    let ($a, $b) = (self.0, other.0);
                    $zip
                };
                ($L(low), $L(high))
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self { $L(unsafe { $min(self.0, other.0) }) }
            #[inline(always)]
            fn max(self, other: Self) -> Self { $L(unsafe { $max(self.0, other.0) }) }
            #[inline(always)]
            fn within(self, bound: $number) -> bool {
                unsafe {
                    let ($y, $low, $high) = (self.0, $set(-bound), $set(bound));
                    $within
                }
            }
        }
    };
}

register! {
    /// Four `f64` by AVX2.
    F64x4(__m256d) of 4 f64;
    _mm256_add_pd _mm256_sub_pd _mm256_mul_pd _mm256_div_pd _mm256_fmadd_pd _mm256_sqrt_pd _mm256_min_pd _mm256_max_pd _mm256_set1_pd
        _mm256_loadu_pd _mm256_storeu_pd;
    _mm256_xor_pd _mm256_and_pd _mm256_castpd_si256 _mm256_castsi256_pd _mm256_and_si256 _mm256_sub_epi64
        _mm256_slli_epi64::<62> _mm256_set1_epi64x;
    sign |x, zero, one, minus_one| {
        let positive = _mm256_and_pd(_mm256_cmp_pd::<_CMP_GT_OQ>(x, zero), one);
        let negative = _mm256_and_pd(_mm256_cmp_pd::<_CMP_LT_OQ>(x, zero), minus_one);
        let nan = _mm256_and_pd(_mm256_cmp_pd::<_CMP_UNORD_Q>(x, x), x);
        _mm256_or_pd(_mm256_or_pd(positive, negative), nan)
    };
    zip |a, b| {
        let (even, odd) = (_mm256_unpacklo_pd(a, b), _mm256_unpackhi_pd(a, b));
        (_mm256_permute2f128_pd::<0x20>(even, odd), _mm256_permute2f128_pd::<0x31>(even, odd))
    };
    within |x, low, high| {
        let (above, below) = (_mm256_cmp_pd::<_CMP_GE_OQ>(x, low), _mm256_cmp_pd::<_CMP_LE_OQ>(x, high));
        _mm256_movemask_pd(_mm256_and_pd(above, below)) == 0b1111
    };
}

register! {
    /// Eight `f32` by AVX2.
    F32x8(__m256) of 8 f32;
    _mm256_add_ps _mm256_sub_ps _mm256_mul_ps _mm256_div_ps _mm256_fmadd_ps _mm256_sqrt_ps _mm256_min_ps _mm256_max_ps _mm256_set1_ps
        _mm256_loadu_ps _mm256_storeu_ps;
    _mm256_xor_ps _mm256_and_ps _mm256_castps_si256 _mm256_castsi256_ps _mm256_and_si256 _mm256_sub_epi32
        _mm256_slli_epi32::<30> _mm256_set1_epi32;
    sign |x, zero, one, minus_one| {
        let positive = _mm256_and_ps(_mm256_cmp_ps::<_CMP_GT_OQ>(x, zero), one);
        let negative = _mm256_and_ps(_mm256_cmp_ps::<_CMP_LT_OQ>(x, zero), minus_one);
        let nan = _mm256_and_ps(_mm256_cmp_ps::<_CMP_UNORD_Q>(x, x), x);
        _mm256_or_ps(_mm256_or_ps(positive, negative), nan)
    };
    zip |a, b| {
        let (low, high) = (_mm256_unpacklo_ps(a, b), _mm256_unpackhi_ps(a, b));
        (_mm256_permute2f128_ps::<0x20>(low, high), _mm256_permute2f128_ps::<0x31>(low, high))
    };
    within |x, low, high| {
        let (above, below) = (_mm256_cmp_ps::<_CMP_GE_OQ>(x, low), _mm256_cmp_ps::<_CMP_LE_OQ>(x, high));
        _mm256_movemask_ps(_mm256_and_ps(above, below)) == 0b1111_1111
    };
}

register! {
    /// Eight `f64` by AVX-512.
    F64x8(__m512d) of 8 f64;
    _mm512_add_pd _mm512_sub_pd _mm512_mul_pd _mm512_div_pd _mm512_fmadd_pd _mm512_sqrt_pd _mm512_min_pd _mm512_max_pd _mm512_set1_pd
        _mm512_loadu_pd _mm512_storeu_pd;
    _mm512_xor_pd _mm512_and_pd _mm512_castpd_si512 _mm512_castsi512_pd _mm512_and_si512 _mm512_sub_epi64
        _mm512_slli_epi64::<62> _mm512_set1_epi64;
    sign |x, zero, one, minus_one| {
        let positive = _mm512_maskz_mov_pd(_mm512_cmp_pd_mask::<_CMP_GT_OQ>(x, zero), one);
        let signed = _mm512_mask_mov_pd(positive, _mm512_cmp_pd_mask::<_CMP_LT_OQ>(x, zero), minus_one);
        _mm512_mask_mov_pd(signed, _mm512_cmp_pd_mask::<_CMP_UNORD_Q>(x, x), x)
    };
    zip |a, b| {
        let low = _mm512_permutex2var_pd(a, _mm512_setr_epi64(0, 8, 1, 9, 2, 10, 3, 11), b);
        (low, _mm512_permutex2var_pd(a, _mm512_setr_epi64(4, 12, 5, 13, 6, 14, 7, 15), b))
    };
    within |x, low, high| {
        (_mm512_cmp_pd_mask::<_CMP_GE_OQ>(x, low) & _mm512_cmp_pd_mask::<_CMP_LE_OQ>(x, high)) == u8::MAX
    };
}

register! {
    /// Sixteen `f32` by AVX-512.
    F32x16(__m512) of 16 f32;
    _mm512_add_ps _mm512_sub_ps _mm512_mul_ps _mm512_div_ps _mm512_fmadd_ps _mm512_sqrt_ps _mm512_min_ps _mm512_max_ps _mm512_set1_ps
        _mm512_loadu_ps _mm512_storeu_ps;
    _mm512_xor_ps _mm512_and_ps _mm512_castps_si512 _mm512_castsi512_ps _mm512_and_si512 _mm512_sub_epi32
        _mm512_slli_epi32::<30> _mm512_set1_epi32;
    sign |x, zero, one, minus_one| {
        let positive = _mm512_maskz_mov_ps(_mm512_cmp_ps_mask::<_CMP_GT_OQ>(x, zero), one);
        let signed = _mm512_mask_mov_ps(positive, _mm512_cmp_ps_mask::<_CMP_LT_OQ>(x, zero), minus_one);
        _mm512_mask_mov_ps(signed, _mm512_cmp_ps_mask::<_CMP_UNORD_Q>(x, x), x)
    };
    zip |a, b| {
        let low = _mm512_setr_epi32(0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23);
        let high = _mm512_setr_epi32(8, 24, 9, 25, 10, 26, 11, 27, 12, 28, 13, 29, 14, 30, 15, 31);
        (_mm512_permutex2var_ps(a, low, b), _mm512_permutex2var_ps(a, high, b))
    };
    within |x, low, high| {
        (_mm512_cmp_ps_mask::<_CMP_GE_OQ>(x, low) & _mm512_cmp_ps_mask::<_CMP_LE_OQ>(x, high)) == u16::MAX
    };
}
