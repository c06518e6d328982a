//! AArch64's registers, which each of its processors has: NEON, 2 `f64` or 4 `f32`.

use super::register;
use core::arch::aarch64::*;

register! {
    /// Two `f64` by NEON.
    F64x2(float64x2_t) of 2 f64;
    vaddq_f64 vsubq_f64 vmulq_f64 vdivq_f64 times_plus_f64 vsqrtq_f64 vminq_f64 vmaxq_f64 vdupq_n_f64 vld1q_f64 vst1q_f64;
    xor_f64 and_f64 vreinterpretq_u64_f64 vreinterpretq_f64_u64 vandq_u64 vsubq_u64 vshlq_n_u64::<62> vdupq_n_u64;
    sign |x, zero, one, minus_one| {
        let signed = vbslq_f64(vcgtq_f64(x, zero), one, vbslq_f64(vcltq_f64(x, zero), minus_one, zero));
        vbslq_f64(vceqq_f64(x, x), signed, x)
    };
    zip |a, b| (vzip1q_f64(a, b), vzip2q_f64(a, b));
    within |x, low, high| {
        let both = vandq_u64(vcgeq_f64(x, low), vcleq_f64(x, high));
        vgetq_lane_u64::<0>(both) & vgetq_lane_u64::<1>(both) == u64::MAX
    };
}

register! {
    /// Four `f32` by NEON.
    F32x4(float32x4_t) of 4 f32;
    vaddq_f32 vsubq_f32 vmulq_f32 vdivq_f32 times_plus_f32 vsqrtq_f32 vminq_f32 vmaxq_f32 vdupq_n_f32 vld1q_f32 vst1q_f32;
    xor_f32 and_f32 vreinterpretq_u32_f32 vreinterpretq_f32_u32 vandq_u32 vsubq_u32 vshlq_n_u32::<30> vdupq_n_u32;
    sign |x, zero, one, minus_one| {
        let signed = vbslq_f32(vcgtq_f32(x, zero), one, vbslq_f32(vcltq_f32(x, zero), minus_one, zero));
        vbslq_f32(vceqq_f32(x, x), signed, x)
    };
    zip |a, b| (vzip1q_f32(a, b), vzip2q_f32(a, b));
    within |x, low, high| vminvq_u32(vandq_u32(vcgeq_f32(x, low), vcleq_f32(x, high))) == u32::MAX;
}

/// a b + c, whose instruction names c first.
#[inline(always)]
fn times_plus_f64(a: float64x2_t, b: float64x2_t, c: float64x2_t) -> float64x2_t {
    // SAFETY: as in `register.rs`
    unsafe { vfmaq_f64(c, a, b) }
}
#[inline(always)]
fn times_plus_f32(a: float32x4_t, b: float32x4_t, c: float32x4_t) -> float32x4_t {
    // SAFETY: as in `register.rs`
    unsafe { vfmaq_f32(c, a, b) }
}

// bits of numbers, for which there are instructions on integers alone
#[inline(always)]
fn xor_f64(a: float64x2_t, b: float64x2_t) -> float64x2_t {
    // SAFETY: as in `register.rs`
    unsafe { vreinterpretq_f64_u64(veorq_u64(vreinterpretq_u64_f64(a), vreinterpretq_u64_f64(b))) }
}
#[inline(always)]
fn and_f64(a: float64x2_t, b: float64x2_t) -> float64x2_t {
    // SAFETY: as in `register.rs`
    unsafe { vreinterpretq_f64_u64(vandq_u64(vreinterpretq_u64_f64(a), vreinterpretq_u64_f64(b))) }
}
#[inline(always)]
fn xor_f32(a: float32x4_t, b: float32x4_t) -> float32x4_t {
    // SAFETY: as in `register.rs`
    unsafe { vreinterpretq_f32_u32(veorq_u32(vreinterpretq_u32_f32(a), vreinterpretq_u32_f32(b))) }
}
#[inline(always)]
fn and_f32(a: float32x4_t, b: float32x4_t) -> float32x4_t {
    // SAFETY: as in `register.rs`
    unsafe { vreinterpretq_f32_u32(vandq_u32(vreinterpretq_u32_f32(a), vreinterpretq_u32_f32(b))) }
}
