//! `f64` with a bound of its rounding error: what two computations of an expression may differ by.

use mozzi::Scalar;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A number, and how far rounding may have moved it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rounded {
    pub value: f64,
    pub error: f64,
}

/// A number rounded once, of operands with this error.
fn rounded(value: f64, error: f64) -> Rounded {
    Rounded { value, error: error + f64::EPSILON * value.abs() }
}

impl From<f64> for Rounded {
    fn from(x: f64) -> Self {
        rounded(x, 0.0)
    }
}
impl Add for Rounded {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        rounded(self.value + other.value, self.error + other.error)
    }
}
impl Sub for Rounded {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}
impl Mul for Rounded {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let error = self.value.abs() * other.error + other.value.abs() * self.error;
        rounded(self.value * other.value, error)
    }
}
impl Div for Rounded {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        rounded(value, (self.error + value.abs() * other.error) / other.value.abs())
    }
}
impl Neg for Rounded {
    type Output = Self;
    fn neg(self) -> Self {
        Rounded { value: -self.value, ..self }
    }
}
impl AddAssign for Rounded {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
impl SubAssign for Rounded {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Scalar for Rounded {
    type Lanes<const L: usize> = [Self; L];
    const IS_ONE: bool = false;

    fn from_f64(x: f64) -> Self {
        x.into()
    }
    fn sin_cos(self) -> (Self, Self) {
        let (s, c) = self.value.sin_cos();
        (rounded(s, self.error), rounded(c, self.error))
    }
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        rounded(root, self.error / (2.0 * root).max(f64::MIN_POSITIVE))
    }
    fn tanh(self) -> Self {
        rounded(self.value.tanh(), self.error)
    }
    fn sgn(self) -> Self {
        Rounded { value: self.value.sgn(), error: 0.0 }
    }
}
