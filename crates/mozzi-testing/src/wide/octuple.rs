//! IEEE 754's binary256: 237 bits, 71 digits. The crate `f256` does the arithmetic, correctly rounded.

use super::{Wide, further_operators};
use core::cmp::Ordering;
use core::ops::{Add, Div, Mul, Neg, Sub};
use f256::f256;
use mozzi::{Real, Scalar};

/// A number of 71 digits.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Octuple(pub f256);
further_operators!(Octuple);

/// Bits of the significand that are stored, and the exponent of 1.
const STORED: u32 = 236;
const BIAS: i32 = 0x3FFFF;

// No operation is inlined: otherwise forty kernels would take minutes to compile. Most entries of the stacked matrices
// are zeros: a sum or product with zero needs no arithmetic.

impl Add for Octuple {
    type Output = Self;
    #[inline(never)]
    fn add(self, other: Self) -> Self {
        match (self.0.eq_zero(), other.0.eq_zero()) {
            (true, _) => other,
            (_, true) => self,
            _ => Octuple(self.0 + other.0),
        }
    }
}
impl Sub for Octuple {
    type Output = Self;
    #[inline(never)]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}
impl Mul for Octuple {
    type Output = Self;
    #[inline(never)]
    fn mul(self, other: Self) -> Self {
        let product_is_zero = |a: f256, b: f256| a.eq_zero() && b.is_finite();
        if product_is_zero(self.0, other.0) || product_is_zero(other.0, self.0) {
            return Octuple(f256::ZERO);
        }
        Octuple(self.0 * other.0)
    }
}
impl Div for Octuple {
    type Output = Self;
    #[inline(never)]
    fn div(self, other: Self) -> Self {
        Octuple(self.0 / other.0)
    }
}
impl Neg for Octuple {
    type Output = Self;
    #[inline(never)]
    fn neg(self) -> Self {
        Octuple(-self.0)
    }
}

impl Scalar for Octuple {
    type Lanes<const L: usize> = [Self; L];
    const DIGITS: u32 = 237;
    fn from_f64(x: f64) -> Self {
        Octuple(f256::from(x))
    }
    fn sin_cos(self) -> (Self, Self) {
        let (s, c) = self.0.sin_cos();
        (Octuple(s), Octuple(c))
    }
    fn sqrt(self) -> Self {
        Octuple(self.0.sqrt())
    }
    fn tanh(self) -> Self {
        // (1 − e⁻²ˣ) / (1 + e⁻²ˣ) for |x|, by e⁻²ˣ − 1, which keeps the digits of small x
        let less_one = (f256::from(-2.0) * self.0.abs()).exp_m1();
        let size = -less_one / (less_one + f256::from(2.0));
        Octuple(size.copysign(self.0))
    }
    fn sgn(self) -> Self {
        match self.0.partial_cmp(&f256::ZERO) {
            Some(Ordering::Equal) => Octuple(f256::ZERO),
            Some(_) => Octuple(f256::ONE.copysign(self.0)),
            None => self,
        }
    }
}

impl Real for Octuple {
    fn epsilon() -> Self {
        Octuple(f256::EPSILON)
    }
    fn atan2(self, x: Self) -> Self {
        Octuple(self.0.atan2(&x.0))
    }
}

impl Wide for Octuple {
    const DIGITS: usize = 71;
    fn parse(text: &str) -> Option<Self> {
        text.parse().ok().map(Octuple)
    }
    fn pi() -> Self {
        Octuple(::f256::consts::PI)
    }
}

/// The nearest `f64`.
impl From<Octuple> for f64 {
    fn from(x: Octuple) -> f64 {
        let x = x.0;
        let sign = if x.is_sign_negative() { -1.0 } else { 1.0 };
        if x.is_nan() || x.is_infinite() || x.eq_zero() {
            return sign
                * if x.is_nan() {
                    f64::NAN
                } else if x.is_infinite() {
                    f64::INFINITY
                } else {
                    0.0
                };
        }
        let (high, low) = x.to_bits();
        let stored_high = STORED - 128;
        let exponent = ((high >> stored_high) & 0x7FFFF) as i32 - BIAS;
        let significand = (high & ((1 << stored_high) - 1)) | (1 << stored_high); // 109 bits; what is below them is sticky
        let rounded = ((significand << 1) | u128::from(low != 0)) as f64; // to the nearest, 110 bits
        let exponent = exponent - stored_high as i32 - 1;
        // in two steps: the power alone may be out of range, and subnormal results are rounded by the last product
        sign * rounded * 2.0_f64.powi(exponent / 2) * 2.0_f64.powi(exponent - exponent / 2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_goes_to_f64_and_back() {
        for x in [0.0, 1.0, -1.5, 0.1, 1e300, -1e-300, f64::MAX, f64::MIN_POSITIVE, 5e-324, f64::INFINITY] {
            assert_eq!(f64::from(Octuple::from_f64(x)), x);
        }
        assert!(f64::from(Octuple::from_f64(f64::NAN)).is_nan());
        let tenth = Octuple::parse("0.1").expect("a number");
        assert_eq!(f64::from(tenth), 0.1);
        let rest = f64::from(tenth - Octuple::from_f64(0.1));
        assert!((rest + 5.551115123125783e-18).abs() < 1e-33, "{rest}"); // the rounding error of 0.1 in f64
    }

    #[test]
    fn functions_keep_their_digits() {
        let close = |a: Octuple, b: Octuple| f64::from((a - b).abs()) < 1e-70;
        let x = Octuple::parse("0.73").expect("a number");
        let (s, c) = x.sin_cos();
        assert!(close(s * s + c * c, Octuple::one()));
        assert!(close(Octuple::from_f64(2.0).sqrt() * Octuple::from_f64(2.0).sqrt(), Octuple::from_f64(2.0)));
        assert!(close(s.atan2(c), x));
        // tanh 2x = 2 tanh x / (1 + tanh² x)
        let (t, two) = (x.tanh(), Octuple::from_f64(2.0));
        assert!(close((x * two).tanh(), t * two / (Octuple::one() + t * t)));
        assert!(close(Octuple::pi().sin_cos().1, -Octuple::one()));
        assert_eq!([x.sgn(), (-x).sgn(), Octuple::zero().sgn()].map(f64::from), [1.0, -1.0, 0.0]);
    }
}
