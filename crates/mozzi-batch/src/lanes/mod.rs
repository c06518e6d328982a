//! Registers of numbers, one number of each state: scalars that mozzi's kernels run on unchanged.

#[cfg(target_arch = "aarch64")]
mod neon;
mod portable;
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
mod register;
#[cfg(target_arch = "x86_64")]
mod x86;

#[cfg(target_arch = "aarch64")]
pub use neon::{F32x4, F64x2};
pub use portable::Portable;
#[cfg(target_arch = "x86_64")]
pub use x86::{F32x8, F32x16, F64x4, F64x8};

use mozzi::Scalar;
use mozzi::scalar::{Bits, Float, sin_cos};

/// A register.
pub trait Lane: Scalar + Bits + From<Self::Number> + Send + Sync + 'static {
    /// The count of numbers that it holds: a power of two, at most 16.
    const WIDTH: usize;

    /// Loads the first numbers of the slice.
    fn load(from: &[Self::Number]) -> Self;
    /// Stores into the first numbers of the slice.
    fn store(self, to: &mut [Self::Number]);
    /// The numbers of registers, one after the other.
    fn numbers(registers: &[Self]) -> &[Self::Number];
    /// The same, mutable.
    fn numbers_mut(registers: &mut [Self]) -> &mut [Self::Number];
    /// Interleaves two registers: the first and the second register of (a₀ b₀ a₁ b₁ …).
    fn zip(self, other: Self) -> (Self, Self);
    /// The smaller number of each lane; if one is NaN, either of the two.
    fn min(self, other: Self) -> Self;
    /// The larger number of each lane; if one is NaN, either of the two.
    fn max(self, other: Self) -> Self;
    /// True if every |x| is at most this; false for NaN.
    fn within(self, bound: Self::Number) -> bool;
}

/// The count of numbers in the widest register.
pub const MOST: usize = 16;

/// Sine and cosine of every number: by the polynomial, or, if any number is beyond its range, by the exact reduction of
/// each number.
#[inline(always)]
fn sin_cos_or_exact<L: Lane>(x: L) -> (L, L) {
    if x.within(L::Number::LARGEST) { sin_cos(x) } else { one_by_one(x) }
}

#[cold]
#[inline(never)]
fn one_by_one<L: Lane>(x: L) -> (L, L) {
    let [mut s, mut c] = [[L::Number::zero(); MOST]; 2];
    x.store(&mut s);
    for (s, c) in s.iter_mut().zip(&mut c).take(L::WIDTH) {
        (*s, *c) = s.sin_cos();
    }
    (L::load(&s), L::load(&c))
}

/// Applies a function that has no vector instruction, number by number.
fn each<L: Lane>(x: L, f: impl Fn(L::Number) -> L::Number) -> L {
    let mut numbers = [L::Number::zero(); MOST];
    x.store(&mut numbers);
    for x in &mut numbers[..L::WIDTH] {
        *x = f(*x);
    }
    L::load(&numbers)
}

/// The part that all lanes share: operators by their functions, and the scalar's methods.
macro_rules! lane {
    ([$($generics:tt)*] $L:ty) => {
        impl<$($generics)*> core::ops::Add for $L {
            type Output = Self;
            #[inline(always)]
            fn add(self, other: Self) -> Self { <$L>::add(self, other) }
        }
        impl<$($generics)*> core::ops::Sub for $L {
            type Output = Self;
            #[inline(always)]
            fn sub(self, other: Self) -> Self { <$L>::sub(self, other) }
        }
        impl<$($generics)*> core::ops::Mul for $L {
            type Output = Self;
            #[inline(always)]
            fn mul(self, other: Self) -> Self { <$L>::mul(self, other) }
        }
        impl<$($generics)*> core::ops::Div for $L {
            type Output = Self;
            #[inline(always)]
            fn div(self, other: Self) -> Self { <$L>::div(self, other) }
        }
        impl<$($generics)*> core::ops::AddAssign for $L {
            #[inline(always)]
            fn add_assign(&mut self, other: Self) { *self = *self + other }
        }
        impl<$($generics)*> core::ops::SubAssign for $L {
            #[inline(always)]
            fn sub_assign(&mut self, other: Self) { *self = *self - other }
        }
        impl<$($generics)*> core::ops::Neg for $L {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self { self.negative() }
        }
        impl<$($generics)*> mozzi::Scalar for $L {
            type Four = [Self; 4];
            const IS_ONE: bool = <$L as crate::lanes::Lane>::WIDTH == 1;
            const IN_PLACE: bool = !Self::IS_ONE;
            #[inline(always)]
            fn from_f64(x: f64) -> Self { mozzi::scalar::Bits::constant(mozzi::Scalar::from_f64(x)) }
            #[inline(always)]
            fn sin_cos(self) -> (Self, Self) { crate::lanes::sin_cos_or_exact(self) }
            #[inline(always)]
            fn sqrt(self) -> Self { self.square_root() }
            fn tanh(self) -> Self { crate::lanes::each(self, mozzi::Scalar::tanh) }
            #[inline(always)]
            fn sgn(self) -> Self { self.sign() }
            #[inline(always)]
            fn mul_add(self, a: Self, b: Self) -> Self { self.times_plus(a, b) }
        }
    };
}
pub(crate) use lane;
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
pub(crate) use register::register;
