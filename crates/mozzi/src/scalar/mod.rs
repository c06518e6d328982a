//! The number that every kernel is generic over.

mod dual;
mod float;
mod fused;
mod fused_lanes;
mod lanes;
mod pass;
#[cfg(test)]
pub(crate) mod recorded;
mod sin_cos;

pub use dual::Dual;
pub use fused::Fused;
pub use lanes::Lanes;
#[cfg(all(feature = "std", target_arch = "x86_64"))]
pub(crate) use pass::assert_fma;
pub(crate) use pass::pass;
pub use sin_cos::{Bits, Float, sin_cos};

use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// The number type of the kernels: `f64`, `f32`, [`Dual`] (derivatives), or a recording.
///
/// There is deliberately no `PartialOrd`: a recording cannot branch on a value.
/// A kernel with states of type `S` takes the model's constants of type `C` by `S: From<C>`.
pub trait Scalar:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
{
    /// Upper bound on its binary digits; series are summed to this precision.
    const DIGITS: u32 = 53;

    /// True for a number, false for a recording.
    const IS_ONE: bool = true;

    /// Whether passes on it are compiled for fused multiply-add: see `scalar/pass.rs`.
    const IS_FUSED: bool = false;

    /// L of these numbers, at most four; `[Self; L]` unless a register holds them.
    type Lanes<const L: usize>: Lanes<Self, L>;

    /// The number nearest to `x`.
    fn from_f64(x: f64) -> Self;

    /// (sin x, cos x); NaN for NaN and for ±∞.
    fn sin_cos(self) -> (Self, Self);

    /// √x; NaN for negative x.
    fn sqrt(self) -> Self;

    /// tanh x.
    fn tanh(self) -> Self;

    /// −1, 0 or 1, with sgn 0 = 0; its derivative is 0 everywhere. NaN for NaN.
    fn sgn(self) -> Self;

    /// self · a + b, with one rounding where the number's type offers it.
    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        self * a + b
    }

    /// 0.
    #[inline(always)]
    fn zero() -> Self {
        Self::from_f64(0.0)
    }

    /// 1.
    #[inline(always)]
    fn one() -> Self {
        Self::from_f64(1.0)
    }
}

/// A [`Scalar`] with an order, for code that compares values: logarithms, checks and iterations.
pub trait Real: Scalar + PartialOrd {
    /// From 1 to the next number.
    fn epsilon() -> Self;

    /// The angle of the point (x, y), in (−π, π]; `self` is y.
    fn atan2(self, x: Self) -> Self;

    /// |x|.
    fn abs(self) -> Self {
        if self < Self::zero() { -self } else { self }
    }

    /// True if the value and all its derivatives are 0.
    fn is_identically_zero(self) -> bool {
        self == Self::zero()
    }
}

/// Implements the assigning operators by their plain ones.
macro_rules! assign_ops {
    ([$($generics:tt)*] $t:ty) => {
        impl<$($generics)*> core::ops::AddAssign for $t {
            #[inline(always)]
            fn add_assign(&mut self, other: Self) { *self = *self + other }
        }
        impl<$($generics)*> core::ops::SubAssign for $t {
            #[inline(always)]
            fn sub_assign(&mut self, other: Self) { *self = *self - other }
        }
    };
}
pub(crate) use assign_ops;
