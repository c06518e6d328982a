//! `f64` whose `mul_add` is one machine instruction.

use super::fused_lanes::FusedLanes;
use super::{Bits, Float, Scalar, assign_ops, float, sin_cos};
use core::ops::{Add, Div, Mul, Neg, Sub};

/// An `f64` with fused multiply-add, for entries compiled with `#[target_feature(enable = "fma")]` alone (see
/// [`fast`](crate::fast)): elsewhere each `mul_add` is a slow library call.
#[doc(hidden)]
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
#[repr(transparent)]
pub struct Fused(pub f64);

#[cfg(feature = "std")]
#[inline(always)]
pub(super) fn mul_add(a: f64, b: f64, c: f64) -> f64 {
    f64::mul_add(a, b, c)
}

/// Without `std` no instruction set is chosen at run time, and `libm`'s emulated fma is a hundred times slower.
#[cfg(not(feature = "std"))]
#[inline(always)]
pub(super) fn mul_add(a: f64, b: f64, c: f64) -> f64 {
    a * b + c
}

macro_rules! ops {
    ($($Op:ident $op:ident),*) => { $(impl $Op for Fused {
        type Output = Self;
        #[inline(always)]
        fn $op(self, other: Self) -> Self { Fused($Op::$op(self.0, other.0)) }
    })* };
}
ops!(Add add, Sub sub, Mul mul, Div div);
assign_ops!([] Fused);

impl Neg for Fused {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Fused(-self.0)
    }
}

impl From<Fused> for f64 {
    #[inline(always)]
    fn from(x: Fused) -> f64 {
        x.0
    }
}

impl From<f64> for Fused {
    #[inline(always)]
    fn from(x: f64) -> Self {
        Fused(x)
    }
}

impl Scalar for Fused {
    const IS_FUSED: bool = true;
    type Lanes<const L: usize> = FusedLanes<L>;

    #[inline(always)]
    fn from_f64(x: f64) -> Self {
        Fused(x)
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        sin_cos_fused(self)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Fused(float::sqrt(self.0))
    }
    fn tanh(self) -> Self {
        Fused(float::tanh(self.0))
    }
    #[inline(always)]
    fn sgn(self) -> Self {
        Fused(self.0.sgn())
    }
    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        Fused(mul_add(self.0, a.0, b.0))
    }
}

/// Sine and cosine with fused multiply-add; exact reduction for arguments beyond the polynomial's range.
#[inline(always)]
fn sin_cos_fused(x: Fused) -> (Fused, Fused) {
    if x.0.abs() <= f64::LARGEST {
        return sin_cos(x);
    }
    let (s, c) = float::sin_cos_of_any(x.0);
    (Fused(s), Fused(c))
}
impl Bits for Fused {
    type Number = f64;
    #[inline(always)]
    fn constant(x: f64) -> Self {
        Fused(x)
    }
    #[inline(always)]
    fn xor(self, other: Self) -> Self {
        Fused(self.0.xor(other.0))
    }
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        Fused(self.0.and(other.0))
    }
    #[inline(always)]
    fn lowest_everywhere(self) -> Self {
        Fused(self.0.lowest_everywhere())
    }
    #[inline(always)]
    fn second_lowest_as_sign(self) -> Self {
        Fused(self.0.second_lowest_as_sign())
    }
}
