//! x86-64's registers: AVX2 with fused multiply-add, 4 `f64` or 8 `f32`; AVX-512, 8 `f64` or 16 `f32`.

use super::register;
use core::arch::x86_64::*;

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
