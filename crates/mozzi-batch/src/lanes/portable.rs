//! Numbers in an array, for any processor: bit for bit the plain numbers' results.

use super::Lane;
use mozzi::Scalar;
use mozzi::scalar::{Bits, Float};

/// W numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(transparent)]
pub struct Portable<T, const W: usize>(pub [T; W]);

impl<T: Float + Bits<Number = T>, const W: usize> Portable<T, W> {
    #[inline(always)]
    fn each(self, f: impl Fn(T) -> T) -> Self {
        Portable(self.0.map(f))
    }

    #[inline(always)]
    fn pairs(self, other: Self, f: impl Fn(T, T) -> T) -> Self {
        Portable(core::array::from_fn(|k| f(self.0[k], other.0[k])))
    }

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.pairs(other, |a, b| a + b)
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.pairs(other, |a, b| a - b)
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.pairs(other, |a, b| a * b)
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.pairs(other, |a, b| a / b)
    }
    #[inline(always)]
    fn negative(self) -> Self {
        self.each(|x| -x)
    }
    #[inline(always)]
    fn square_root(self) -> Self {
        self.each(Scalar::sqrt)
    }
    #[inline(always)]
    fn sign(self) -> Self {
        self.each(Scalar::sgn)
    }
    #[inline(always)]
    fn times_plus(self, a: Self, b: Self) -> Self {
        self.mul(a).add(b)
    }
}
super::lane!([T: Float + Bits<Number = T>, const W: usize] Portable<T, W>);

impl<T: Float + Bits<Number = T>, const W: usize> From<T> for Portable<T, W> {
    #[inline(always)]
    fn from(x: T) -> Self {
        Portable([x; W])
    }
}

impl<T: Float + Bits<Number = T>, const W: usize> Bits for Portable<T, W> {
    type Number = T;
    #[inline(always)]
    fn constant(x: T) -> Self {
        x.into()
    }
    #[inline(always)]
    fn xor(self, other: Self) -> Self {
        self.pairs(other, Bits::xor)
    }
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        self.pairs(other, Bits::and)
    }
    #[inline(always)]
    fn lowest_everywhere(self) -> Self {
        self.each(Bits::lowest_everywhere)
    }
    #[inline(always)]
    fn second_lowest_as_sign(self) -> Self {
        self.each(Bits::second_lowest_as_sign)
    }
}

impl<T: Float + Bits<Number = T>, const W: usize> Lane for Portable<T, W> {
    const WIDTH: usize = W;

    #[inline(always)]
    fn load(from: &[T]) -> Self {
        Portable(core::array::from_fn(|k| from[k]))
    }
    #[inline(always)]
    fn store(self, to: &mut [T]) {
        to[..W].copy_from_slice(&self.0);
    }
    fn numbers(registers: &[Self]) -> &[T] {
        // SAFETY: the type is a transparent array.
        unsafe { core::slice::from_raw_parts(registers.as_ptr().cast(), registers.len() * W) }
    }
    fn numbers_mut(registers: &mut [Self]) -> &mut [T] {
        // SAFETY: likewise; the borrow is exclusive.
        unsafe { core::slice::from_raw_parts_mut(registers.as_mut_ptr().cast(), registers.len() * W) }
    }
    #[inline(always)]
    fn zip(self, other: Self) -> (Self, Self) {
        let of = |k: usize| if k.is_multiple_of(2) { self.0[k / 2] } else { other.0[k / 2] };
        (Portable(core::array::from_fn(of)), Portable(core::array::from_fn(|k| of(k + W))))
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.pairs(other, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.pairs(other, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn within(self, bound: T) -> bool {
        self.0.into_iter().all(|x| x <= bound && -x <= bound)
    }
}
