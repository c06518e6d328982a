//! Four numbers in an array, for any processor: bit for bit the plain numbers' results.

use super::Lane;
use mozzi::Scalar;
use mozzi::scalar::{Bits, Float};

/// Four numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(transparent)]
pub struct Portable<T>(pub [T; 4]);

impl<T: Float + Bits<Number = T>> Portable<T> {
    #[inline(always)]
    fn each(self, f: impl Fn(T) -> T) -> Self {
        let [a, b, c, d] = self.0;
        Portable([f(a), f(b), f(c), f(d)])
    }

    #[inline(always)]
    fn pairs(self, other: Self, f: impl Fn(T, T) -> T) -> Self {
        let ([a, b, c, d], [e, g, h, i]) = (self.0, other.0);
        Portable([f(a, e), f(b, g), f(c, h), f(d, i)])
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
super::lane!([T: Float + Bits<Number = T>] Portable<T>);

impl<T: Float + Bits<Number = T>> From<T> for Portable<T> {
    #[inline(always)]
    fn from(x: T) -> Self {
        Portable([x; 4])
    }
}

impl<T: Float + Bits<Number = T>> Bits for Portable<T> {
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

impl<T: Float + Bits<Number = T>> Lane for Portable<T> {
    const WIDTH: usize = 4;

    #[inline(always)]
    fn load(from: &[T]) -> Self {
        Portable([from[0], from[1], from[2], from[3]])
    }
    #[inline(always)]
    fn store(self, to: &mut [T]) {
        to[..4].copy_from_slice(&self.0);
    }
    #[inline(always)]
    fn zip(self, other: Self) -> (Self, Self) {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
        (Portable([a, e, b, f]), Portable([c, g, d, h]))
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
