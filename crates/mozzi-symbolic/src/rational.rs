//! Exact rational numbers: in 64 bits while they fit, else of any size.

use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Signed, ToPrimitive, Zero};
use std::cmp::Ordering;
use std::fmt;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A fraction in lowest terms, with a positive denominator. Numbers that fit into 64 bits are
/// [`Small`](Rational::Small).
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Rational {
    /// Numerator and denominator.
    Small(i64, i64),
    /// Likewise, too large for 64 bits.
    Big(Box<(BigInt, BigInt)>),
}

impl Rational {
    /// 0.
    pub const ZERO: Rational = Rational::Small(0, 1);
    /// 1.
    pub const ONE: Rational = Rational::Small(1, 1);

    /// a / b, for b ≠ 0.
    pub fn new(a: i64, b: i64) -> Self {
        Self::of_i128(i128::from(a), i128::from(b))
    }

    fn of_i128(mut a: i128, mut b: i128) -> Self {
        let divisor = gcd(a.unsigned_abs(), b.unsigned_abs());
        if divisor > 1 {
            (a, b) = (a / divisor as i128, b / divisor as i128);
        }
        if b < 0 {
            (a, b) = (-a, -b);
        }
        match (i64::try_from(a), i64::try_from(b)) {
            (Ok(a), Ok(b)) => Rational::Small(a, b),
            _ => Rational::Big(Box::new((a.into(), b.into()))),
        }
    }

    /// a / b, for b ≠ 0.
    pub(crate) fn of_big(a: BigInt, b: BigInt) -> Self {
        let divisor = a.gcd(&b);
        let (mut a, mut b) = if divisor.is_one() { (a, b) } else { (a / &divisor, b / &divisor) };
        if b.is_negative() {
            (a, b) = (-a, -b);
        }
        match (a.to_i64(), b.to_i64()) {
            (Some(a), Some(b)) => Rational::Small(a, b),
            _ => Rational::Big(Box::new((a, b))),
        }
    }

    /// Numerator and denominator.
    pub fn parts(&self) -> (BigInt, BigInt) {
        match self {
            Rational::Small(a, b) => ((*a).into(), (*b).into()),
            Rational::Big(parts) => (**parts).clone(),
        }
    }

    /// The exact value of a decimal number, `-1.5e-3`; `None` for other text, or an exponent beyond ±400.
    pub fn decimal(text: &str) -> Option<Self> {
        let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
        let mut exponent: i32 = exponent.parse().ok().filter(|e: &i32| e.abs() <= 400)?;
        let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        let digits = format!("{whole}{fraction}");
        let plain = digits.trim_start_matches(['+', '-']);
        if plain.is_empty() || plain.len() + 1 < digits.len() || !plain.bytes().all(|c| c.is_ascii_digit()) {
            return None;
        }
        exponent -= fraction.len() as i32;
        let digits: BigInt = digits.parse().ok()?;
        let power = BigInt::from(10).pow(exponent.unsigned_abs());
        Some(if exponent < 0 { Self::of_big(digits, power) } else { Self::of_big(digits * power, BigInt::one()) })
    }

    /// The exact value of a finite binary number; `None` for NaN and ±∞.
    pub fn binary(x: f64) -> Option<Self> {
        if !x.is_finite() {
            return None;
        }
        let bits = x.to_bits();
        let (stored, fraction) = ((bits >> 52) as i32 & 0x7ff, bits & ((1 << 52) - 1));
        let (m, e) = if stored == 0 { (fraction, -1074) } else { (fraction | 1 << 52, stored - 1075) };
        let m = if x < 0.0 { -BigInt::from(m) } else { BigInt::from(m) };
        let power = BigInt::one() << e.unsigned_abs();
        Some(if e < 0 { Self::of_big(m, power) } else { Self::of_big(m * power, BigInt::one()) })
    }

    /// True for 0.
    pub fn is_zero(&self) -> bool {
        matches!(self, Rational::Small(0, _))
    }

    /// True for 1.
    pub fn is_one(&self) -> bool {
        matches!(self, Rational::Small(1, 1))
    }

    /// True below 0.
    pub fn is_negative(&self) -> bool {
        match self {
            Rational::Small(a, _) => *a < 0,
            Rational::Big(parts) => parts.0.is_negative(),
        }
    }

    /// |x|.
    pub fn abs(&self) -> Self {
        if self.is_negative() { -self } else { self.clone() }
    }

    /// 1/x; 1/0 is 0, which callers exclude.
    pub fn inverse(&self) -> Self {
        if self.is_zero() {
            return Self::ZERO;
        }
        let (a, b) = self.parts();
        Self::of_big(b, a)
    }

    /// xᵏ.
    pub fn power(&self, k: i32) -> Self {
        let one = (0..k.unsigned_abs()).fold(Self::ONE, |product, _| &product * self);
        if k < 0 { one.inverse() } else { one }
    }

    /// The whole number, if it is one of at most 32 bits.
    pub fn integer(&self) -> Option<i32> {
        match self {
            Rational::Small(a, 1) => i32::try_from(*a).ok(),
            _ => None,
        }
    }

    /// The nearest `f64`, to two roundings.
    pub fn to_f64(&self) -> f64 {
        match self {
            Rational::Small(a, b) if a.unsigned_abs() < 1 << 53 && *b < 1 << 53 => *a as f64 / *b as f64,
            _ => {
                // 64 digits of the quotient
                let (a, b) = self.parts();
                let shift = 64 + b.bits() as i64 - a.bits() as i64;
                let quotient = if shift > 0 { (a << shift) / b } else { a / (b << -shift) };
                let (half, rest) = (shift / 2, shift - shift / 2);
                quotient.to_f64().unwrap_or(f64::NAN) * 2.0_f64.powi(-half as i32) * 2.0_f64.powi(-rest as i32)
            }
        }
    }

    /// As a decimal number, if its digits end: all digits, never an exponent.
    pub fn to_decimal(&self) -> Option<String> {
        let (a, b) = self.parts();
        let (mut rest, mut places) = (b.clone(), 0_usize);
        let mut count = |prime: u32| {
            let (prime, mut times) = (BigInt::from(prime), 0);
            while (&rest % &prime).is_zero() {
                (rest, times) = (&rest / &prime, times + 1);
            }
            places = places.max(times);
        };
        count(2);
        count(5);
        if !rest.is_one() {
            return None;
        }
        let digits = (a.abs() * BigInt::from(10).pow(places as u32) / b).to_string();
        let digits = format!("{digits:0>width$}", width = places + 1);
        let (whole, fraction) = digits.split_at(digits.len() - places);
        let sign = if a.is_negative() { "-" } else { "" };
        Some(if fraction.is_empty() { format!("{sign}{whole}") } else { format!("{sign}{whole}.{fraction}") })
    }
}

fn gcd(mut a: u128, mut b: u128) -> u128 {
    if let (Ok(a), Ok(b)) = (u64::try_from(a), u64::try_from(b)) {
        return a.gcd(&b).into();
    }
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

impl Add for &Rational {
    type Output = Rational;
    fn add(self, other: Self) -> Rational {
        if let (Rational::Small(a, b), Rational::Small(c, d)) = (self, other) {
            let [a, b, c, d] = [*a, *b, *c, *d].map(i128::from);
            if b == d {
                return Rational::of_i128(a + c, b);
            }
            if let (Some(numerator), Some(denominator)) = ((a * d).checked_add(c * b), b.checked_mul(d)) {
                return Rational::of_i128(numerator, denominator);
            }
        }
        let ((a, b), (c, d)) = (self.parts(), other.parts());
        Rational::of_big(a * &d + c * &b, b * d)
    }
}
impl Mul for &Rational {
    type Output = Rational;
    fn mul(self, other: Self) -> Rational {
        if let (Rational::Small(a, b), Rational::Small(c, d)) = (self, other) {
            return Rational::of_i128(i128::from(*a) * i128::from(*c), i128::from(*b) * i128::from(*d));
        }
        let ((a, b), (c, d)) = (self.parts(), other.parts());
        Rational::of_big(a * c, b * d)
    }
}
impl Neg for &Rational {
    type Output = Rational;
    fn neg(self) -> Rational {
        match self {
            Rational::Small(a, b) if *a != i64::MIN => Rational::Small(-a, *b),
            _ => {
                let (a, b) = self.parts();
                Rational::of_big(-a, b)
            }
        }
    }
}
impl Sub for &Rational {
    type Output = Rational;
    fn sub(self, other: Self) -> Rational {
        self + &-other
    }
}
impl Div for &Rational {
    type Output = Rational;
    fn div(self, other: Self) -> Rational {
        self * &other.inverse()
    }
}

impl Ord for Rational {
    fn cmp(&self, other: &Self) -> Ordering {
        match self - other {
            difference if difference.is_zero() => Ordering::Equal,
            difference if difference.is_negative() => Ordering::Less,
            _ => Ordering::Greater,
        }
    }
}
impl PartialOrd for Rational {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// A decimal number if its digits end after at most twenty places, else a fraction.
impl fmt::Display for Rational {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.to_decimal() {
            Some(text) => f.write_str(&text),
            None => {
                let (a, b) = self.parts();
                write!(f, "{a}/{b}")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals_are_exact() {
        for (text, back) in [("0.10", "0.1"), ("-1.5e-3", "-0.0015"), ("2E3", "2000"), (".5", "0.5"), ("+7.", "7")] {
            assert_eq!(Rational::decimal(text).expect(text).to_string(), back);
        }
        for text in ["", "-", "1e", "1e9999", "0x1", "1.2.3", "--1", "nan"] {
            assert_eq!(Rational::decimal(text), None, "{text}");
        }
        assert_eq!(Rational::binary(0.375), Some(Rational::new(3, 8)));
        assert!(Rational::binary(0.1) != Rational::decimal("0.1"));
        assert_eq!(Rational::new(1, 3).to_string(), "1/3");
    }

    #[test]
    fn sums_and_products_leave_64_bits_and_come_back() {
        let x = Rational::decimal("123456789.123456789123").expect("a number");
        let y = &(&x * &x) * &x;
        assert!(matches!(y, Rational::Big(_)));
        let back = &(&y / &x) / &x;
        assert_eq!(back, x);
        assert_eq!(&y - &y, Rational::ZERO);
        assert!((y.to_f64() / 123_456_789.123_456_79_f64.powi(3) - 1.0).abs() < 1e-15);
        assert!(Rational::new(-1, 2) < Rational::new(1, 3));
        assert_eq!(Rational::new(-2, 3).power(-3), Rational::new(-27, 8));
    }
}
