//! Dual numbers: a value with its derivative in one direction.

use super::{Real, Scalar, assign_ops};
use alloc::vec::Vec;
use core::cmp::Ordering;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// `value + derivative·ε` with ε² = 0: a kernel that runs on dual numbers returns each value with its exact derivative
/// in the direction given by the inputs' derivatives. `Dual<Dual<f64>>` gives second derivatives.
///
/// ```
/// use mozzi::scalar::{Dual, Scalar};
/// let x = Dual { value: 0.5, derivative: 1.0 };
/// let (sin, _) = (x * x).sin_cos();
/// assert_eq!(sin.derivative, 2.0 * 0.5 * 0.25_f64.cos()); // d sin(x²)/dx = 2x cos x²
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Dual<S = f64> {
    /// The function's value.
    pub value: S,
    /// Its derivative.
    pub derivative: S,
}

impl<S: Scalar> Dual<S> {
    /// A constant: derivative 0.
    pub fn constant(value: S) -> Self {
        Dual { value, derivative: S::zero() }
    }

    /// Constants: derivatives 0.
    pub fn constants(values: &[S]) -> Vec<Self> {
        values.iter().map(|&value| Self::constant(value)).collect()
    }

    /// Each value with its derivative.
    ///
    /// # Panics
    /// If the lengths differ.
    pub fn list(values: &[S], derivatives: &[S]) -> Vec<Self> {
        assert!(values.len() == derivatives.len(), "a derivative for each value");
        values.iter().zip(derivatives).map(|(&value, &derivative)| Dual { value, derivative }).collect()
    }

    /// f(value) with the chain rule: f′(value) · derivative.
    #[inline(always)]
    fn chain(self, f: S, slope: S) -> Self {
        Dual { value: f, derivative: slope * self.derivative }
    }
}

impl<S: Scalar + From<f64>> From<f64> for Dual<S> {
    fn from(x: f64) -> Self {
        Dual::constant(S::from(x))
    }
}

/// The value.
impl<S: Into<f64>> From<Dual<S>> for f64 {
    fn from(x: Dual<S>) -> f64 {
        x.value.into()
    }
}

impl<S: Scalar> Add for Dual<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Dual { value: self.value + o.value, derivative: self.derivative + o.derivative }
    }
}
impl<S: Scalar> Sub for Dual<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Dual { value: self.value - o.value, derivative: self.derivative - o.derivative }
    }
}
impl<S: Scalar> Mul for Dual<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        Dual { value: self.value * o.value, derivative: self.derivative * o.value + self.value * o.derivative }
    }
}
impl<S: Scalar> Div for Dual<S> {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        let value = self.value / o.value;
        Dual { value, derivative: (self.derivative - value * o.derivative) / o.value }
    }
}
impl<S: Scalar> Neg for Dual<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Dual { value: -self.value, derivative: -self.derivative }
    }
}
assign_ops!([S: Scalar] Dual<S>);
impl<S: Scalar> core::ops::MulAssign for Dual<S> {
    fn mul_assign(&mut self, o: Self) {
        *self = *self * o;
    }
}

/// For matrices of nalgebra.
impl<S: Scalar + PartialEq> num_traits::Zero for Dual<S> {
    fn zero() -> Self {
        Scalar::zero()
    }
    fn is_zero(&self) -> bool {
        self.value == S::zero() && self.derivative == S::zero()
    }
}
impl<S: Scalar> num_traits::One for Dual<S> {
    fn one() -> Self {
        Scalar::one()
    }
}

impl<S: PartialEq> PartialEq for Dual<S> {
    fn eq(&self, o: &Self) -> bool {
        self.value == o.value
    }
}
impl<S: PartialOrd> PartialOrd for Dual<S> {
    fn partial_cmp(&self, o: &Self) -> Option<Ordering> {
        self.value.partial_cmp(&o.value)
    }
}

impl<S: Scalar> Scalar for Dual<S> {
    type Lanes<const L: usize> = [Self; L];
    const DIGITS: u32 = S::DIGITS;
    const IS_FUSED: bool = S::IS_FUSED;
    fn from_f64(x: f64) -> Self {
        Dual::constant(S::from_f64(x))
    }
    fn sin_cos(self) -> (Self, Self) {
        let (s, c) = self.value.sin_cos();
        (self.chain(s, c), self.chain(c, -s))
    }
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, S::from_f64(0.5) / root)
    }
    fn tanh(self) -> Self {
        let t = self.value.tanh();
        self.chain(t, S::one() - t * t)
    }
    fn sgn(self) -> Self {
        Dual::constant(self.value.sgn())
    }
}

impl<S: Real> Real for Dual<S> {
    fn epsilon() -> Self {
        Dual::constant(S::epsilon())
    }
    fn atan2(self, x: Self) -> Self {
        let (y, r2) = (self, self.value * self.value + x.value * x.value);
        Dual { value: y.value.atan2(x.value), derivative: (y.derivative * x.value - y.value * x.derivative) / r2 }
    }
    fn is_identically_zero(self) -> bool {
        self.value.is_identically_zero() && self.derivative.is_identically_zero()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[allow(clippy::type_complexity)] // a table of functions
    fn every_function_has_its_derivative() {
        let functions: [(&str, fn(Dual) -> Dual); 7] = [
            ("sin", |x| x.sin_cos().0),
            ("cos", |x| x.sin_cos().1),
            ("sqrt", Scalar::sqrt),
            ("tanh", Scalar::tanh),
            ("abs", |x| Real::abs(Dual::from_f64(0.3) - x)),
            ("atan2", |x| (x * x).atan2(Dual::from_f64(0.3) - x)),
            ("quotient", |x| (x - Dual::from_f64(2.0)) / (x * x + Dual::one())),
        ];
        let (x, step) = (0.7, 1e-5);
        let at = |f: fn(Dual) -> Dual, x| f(Dual { value: x, derivative: 1.0 });
        for (name, f) in functions {
            let difference = (at(f, x + step).value - at(f, x - step).value) / (2.0 * step);
            assert!((at(f, x).derivative - difference).abs() < 1e-9, "{name}");
        }
    }

    #[test]
    fn nested_duals_give_second_derivatives() {
        let x = Dual { value: Dual { value: 0.4, derivative: 1.0 }, derivative: Dual::one() };
        let (s, _) = x.sin_cos();
        assert_eq!(s.derivative.derivative, -0.4_f64.sin_cos().0);
    }
}
