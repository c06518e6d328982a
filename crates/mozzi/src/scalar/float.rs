//! `f64` and `f32` as scalars; elementary functions from `std`, or from `libm` without it.

use super::{Float, Real, Scalar, sin_cos};

#[cfg(feature = "std")]
mod elementary {
    macro_rules! from_std {
        ($($f:ident: $t:ty),*) => { $(pub mod $f {
            pub fn sin_cos(x: $t) -> ($t, $t) { x.sin_cos() }
            pub fn sqrt(x: $t) -> $t { x.sqrt() }
            pub fn tanh(x: $t) -> $t { x.tanh() }
            pub fn atan2(y: $t, x: $t) -> $t { y.atan2(x) }
        })* };
    }
    from_std!(f64: core::primitive::f64, f32: core::primitive::f32);
}

#[cfg(not(feature = "std"))]
mod elementary {
    pub mod f64 {
        pub use libm::{atan2, sqrt, tanh};
        pub fn sin_cos(x: f64) -> (f64, f64) {
            libm::sincos(x)
        }
    }
    pub mod f32 {
        pub use libm::{atan2f as atan2, sqrtf as sqrt, tanhf as tanh};
        pub fn sin_cos(x: f32) -> (f32, f32) {
            libm::sincosf(x)
        }
    }
}

macro_rules! float {
    ($($f:ident),*) => { $(
        impl Scalar for $f {
            type Lanes<const L: usize> = [Self; L];
            const DIGITS: u32 = $f::MANTISSA_DIGITS;
            #[inline(always)]
            fn from_f64(x: f64) -> Self { x as $f }
            #[inline(always)]
            fn sin_cos(self) -> (Self, Self) {
                if self.abs() <= $f::LARGEST { sin_cos(self) } else { elementary::$f::sin_cos(self) }
            }
            #[inline(always)]
            fn sqrt(self) -> Self { elementary::$f::sqrt(self) }
            fn tanh(self) -> Self { elementary::$f::tanh(self) }
            #[inline(always)]
            fn sgn(self) -> Self {
                // without a branch on the sign, which no processor predicts
                let sign = i8::from(self > 0.0) - i8::from(self < 0.0);
                if self.is_nan() { self } else { $f::from(sign) }
            }
        }
        impl Real for $f {
            fn epsilon() -> Self { $f::EPSILON }
            fn atan2(self, x: Self) -> Self { elementary::$f::atan2(self, x) }
            #[inline(always)]
            fn abs(self) -> Self { <$f>::abs(self) }
        }
    )* };
}
float!(f64, f32);

pub(super) use elementary::f64::{sin_cos as sin_cos_of_any, sqrt, tanh};
