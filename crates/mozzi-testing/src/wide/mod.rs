//! Numbers wider than `f64`, as scalars for mozzi's kernels and as entries of nalgebra's matrices.

mod double;
mod octuple;

pub use double::Double;
pub use octuple::Octuple;

use mozzi::Entry;

/// A number with more digits than `f64`.
pub trait Wide: Entry + Send + Sync {
    /// Its decimal digits, rounded down.
    const DIGITS: usize;

    /// The number nearest to a decimal one, `-1.5e-3`.
    fn parse(text: &str) -> Option<Self>;

    /// π.
    fn pi() -> Self;
}

/// The part that both types share: the operators that follow from the plain ones, and nalgebra's 0 and 1.
macro_rules! further_operators {
    ($t:ty) => {
        impl core::ops::AddAssign for $t {
            fn add_assign(&mut self, other: Self) {
                *self = *self + other;
            }
        }
        impl core::ops::SubAssign for $t {
            fn sub_assign(&mut self, other: Self) {
                *self = *self - other;
            }
        }
        impl core::ops::MulAssign for $t {
            fn mul_assign(&mut self, other: Self) {
                *self = *self * other;
            }
        }
        impl num_traits::Zero for $t {
            fn zero() -> Self {
                mozzi::Scalar::zero()
            }
            fn is_zero(&self) -> bool {
                *self == mozzi::Scalar::zero()
            }
        }
        impl num_traits::One for $t {
            fn one() -> Self {
                mozzi::Scalar::one()
            }
        }
        impl From<f64> for $t {
            fn from(x: f64) -> Self {
                mozzi::Scalar::from_f64(x)
            }
        }
    };
}
use further_operators;
