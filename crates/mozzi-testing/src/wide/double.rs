//! Double-double: the unevaluated sum of two `f64`, 106 bits, 31 digits. For millions of states.
//!
//! The algorithms are those of Joldes, Muller and Popescu, "Tight and rigorous error bounds for basic building blocks
//! of double-word arithmetic" (2017): 1 to 4 units of 2⁻¹⁰⁶ for each operation, even if leading digits cancel.

use super::{Octuple, Wide, further_operators};
use core::cmp::Ordering;
use core::ops::{Add, Div, Mul, Neg, Sub};
use mozzi::{Real, Scalar};
use std::sync::LazyLock;

/// A number of 31 digits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Double {
    /// The nearest `f64`.
    high: f64,
    /// The remainder.
    low: f64,
}
further_operators!(Double);

/// a + b and its rounding error.
#[inline(always)]
fn two_sum(a: f64, b: f64) -> Double {
    let high = a + b;
    let b_there = high - a;
    Double { high, low: (a - (high - b_there)) + (b - b_there) }
}

/// [`two_sum`] for |a| ≥ |b|.
#[inline(always)]
fn fast_two_sum(a: f64, b: f64) -> Double {
    let high = a + b;
    Double { high, low: b - (high - a) }
}

/// a b and its rounding error.
#[inline(always)]
fn two_product(a: f64, b: f64) -> Double {
    let high = a * b;
    Double { high, low: f64::mul_add(a, b, -high) }
}

// No operation is inlined: otherwise forty kernels would take minutes to compile.

impl Add for Double {
    type Output = Self;
    #[inline(never)]
    fn add(self, other: Self) -> Self {
        let (s, t) = (two_sum(self.high, other.high), two_sum(self.low, other.low));
        let v = fast_two_sum(s.high, s.low + t.high);
        fast_two_sum(v.high, t.low + v.low)
    }
}
impl Sub for Double {
    type Output = Self;
    #[inline(never)]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}
impl Mul for Double {
    type Output = Self;
    #[inline(never)]
    fn mul(self, other: Self) -> Self {
        let c = two_product(self.high, other.high);
        let cross = f64::mul_add(self.low, other.high, f64::mul_add(self.high, other.low, self.low * other.low));
        fast_two_sum(c.high, c.low + cross)
    }
}
impl Div for Double {
    type Output = Self;
    #[inline(never)]
    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let rest = self - other * Double { high: first, low: 0.0 };
        let second = rest.high / other.high;
        let rest = rest - other * Double { high: second, low: 0.0 };
        let third = rest.high / other.high;
        let q = fast_two_sum(first, second);
        fast_two_sum(q.high, q.low + third)
    }
}
impl Neg for Double {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Double { high: -self.high, low: -self.low }
    }
}

impl PartialOrd for Double {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        match self.high.partial_cmp(&other.high) {
            Some(Ordering::Equal) => self.low.partial_cmp(&other.low),
            unequal => unequal,
        }
    }
}

/// π/2 as a sum of four numbers, and 1/k!.
struct Constants {
    half_pi: [f64; 4],
    inverse_factorials: [Double; 30],
}

static CONSTANTS: LazyLock<Constants> = LazyLock::new(|| {
    let mut rest = Octuple::pi() * Octuple::from_f64(0.5);
    let half_pi = [0; 4].map(|_| {
        let part = f64::from(rest);
        rest -= Octuple::from_f64(part);
        part
    });
    let mut inverse = Octuple::one();
    let inverse_factorials = core::array::from_fn(|k| {
        inverse = if k > 0 { inverse / Octuple::from_f64(k as f64) } else { inverse };
        Double::from(inverse)
    });
    Constants { half_pi, inverse_factorials }
});

/// Σ (±1)ᵏ zᵏ / (first + 2k)!, with enough terms for |z| ≤ (π/4)².
fn series(z: Double, first: usize) -> Double {
    let coefficients = CONSTANTS.inverse_factorials[first..].iter().step_by(2).enumerate().rev();
    coefficients.fold(Scalar::zero(), |sum: Double, (k, &c)| sum * z + if k % 2 == 0 { c } else { -c })
}

impl Scalar for Double {
    type Lanes<const L: usize> = [Self; L];
    const DIGITS: u32 = 107;
    fn from_f64(x: f64) -> Self {
        Double { high: x, low: 0.0 }
    }

    /// For |x| ≤ 2³⁰: x = k π/2 + r, and the Taylor series of r; beyond, by [`Octuple`].
    #[inline(never)]
    fn sin_cos(self) -> (Self, Self) {
        if !(self.high.abs() <= 1073741824.0) {
            let (s, c) = Octuple::from(self).sin_cos();
            return (s.into(), c.into());
        }
        let k = (self.high * core::f64::consts::FRAC_2_PI).round();
        let r = CONSTANTS.half_pi.iter().fold(self, |r, &part| r - two_product(k, part));
        let z = r * r;
        let (s, c) = (r * series(z, 1), series(z, 0));
        match (k as i64).rem_euclid(4) {
            0 => (s, c),
            1 => (c, -s),
            2 => (-s, -c),
            _ => (-c, s),
        }
    }

    fn sqrt(self) -> Self {
        if !(self.high > 0.0) {
            return Double::from_f64(self.high.sqrt());
        }
        let root = self.high.sqrt();
        let rest = self - two_product(root, root);
        fast_two_sum(root, rest.high / (2.0 * root))
    }

    fn tanh(self) -> Self {
        Octuple::from(self).tanh().into()
    }

    fn sgn(self) -> Self {
        Double::from_f64(self.high.sgn())
    }
}

impl Real for Double {
    fn epsilon() -> Self {
        Double::from_f64(2.0_f64.powi(-105))
    }
    fn atan2(self, x: Self) -> Self {
        Octuple::from(self).atan2(x.into()).into()
    }
}

impl Wide for Double {
    const DIGITS: usize = 31;
    fn parse(text: &str) -> Option<Self> {
        Octuple::parse(text).map(Double::from)
    }
    fn pi() -> Self {
        Octuple::pi().into()
    }
}

impl From<Double> for f64 {
    fn from(x: Double) -> f64 {
        x.high
    }
}
impl From<Octuple> for Double {
    fn from(x: Octuple) -> Self {
        let high = f64::from(x);
        Double { high, low: f64::from(x - Octuple::from_f64(high)) }
    }
}
impl From<Double> for Octuple {
    fn from(x: Double) -> Self {
        Octuple::from_f64(x.high) + Octuple::from_f64(x.low)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mozzi::random::Random;

    /// |x − reference| in units of 2⁻¹⁰⁶ of the reference.
    fn units(x: Double, reference: Octuple) -> f64 {
        let error = f64::from((Octuple::from(x) - reference).abs());
        error / (2.0_f64.powi(-106) * f64::from(reference.abs()))
    }

    #[test]
    fn arithmetic_is_octuple_arithmetic_rounded() {
        let mut random = Random(1);
        let mut number = |size: f64| {
            let [high, low]: [f64; 2] = random.array();
            Double::from(Octuple::from_f64(high * size) + Octuple::from_f64(low * size * 1e-17))
        };
        let mut worst = [0.0_f64; 5];
        for k in 0..20_000 {
            let (a, b) = (number(1.0), number([1.0, 1e3, 1e-5][k % 3]));
            let near = Double { high: -a.high, low: b.low }; // leading digits cancel
            let (x, y) = (Octuple::from(a), Octuple::from(b));
            let found = [
                units(a + b, x + y),
                units(a + near, x + Octuple::from(near)),
                units(a * b, x * y),
                units(a / b, x / y),
                units((a * a).sqrt(), Octuple::from(a * a).sqrt()),
            ];
            worst = core::array::from_fn(|k| worst[k].max(found[k]));
        }
        assert!(
            worst[0] <= 4.0 && worst[1] <= 4.0 && worst[2] <= 5.0 && worst[3] <= 10.0 && worst[4] <= 4.0,
            "{worst:?}"
        );
    }

    #[test]
    fn sine_and_cosine_keep_thirty_digits() {
        let mut random = Random(2);
        for k in 0..3000 {
            let size = [1.0, 30.0, 1e6, 1e9][k % 4];
            let x = Double { high: random.next() * size, low: random.next() * size * 1e-17 };
            let (found, reference) = (x.sin_cos(), Octuple::from(x).sin_cos());
            for (found, reference) in [(found.0, reference.0), (found.1, reference.1)] {
                let error = f64::from((Octuple::from(found) - reference).abs());
                assert!(error < 1e-31, "{x:?}: {error}");
            }
        }
        let near = Double::from_f64(core::f64::consts::FRAC_PI_2); // its cosine is 6e-17, to all digits
        assert!(units(near.sin_cos().1, Octuple::from(near).sin_cos().1) < 8.0);
        assert!(Double::from_f64(f64::NAN).sin_cos().0.high.is_nan());
        assert!(units(Double::from_f64(0.3).tanh(), Octuple::from_f64(0.3).tanh()) < 2.0);
    }
}
