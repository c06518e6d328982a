//! Small vectors and matrices over any [`Scalar`], and the sparse factorisation of the mass matrix.

pub(crate) mod dense_ldlt;
pub mod ldlt;
mod mat3;
mod pattern;
mod skew;
mod square;
mod sym3;
mod vec3;

pub use mat3::Mat3;
pub(crate) use skew::Skew;
pub(crate) use square::Square;
pub use sym3::Sym3;
pub use vec3::Vec3;

use crate::scalar::Scalar;

/// A ← A + Aᵀ, n × n.
#[cfg_attr(not(debug_assertions), inline(always))]
pub fn add_transpose<S: Scalar>(n: usize, A: &mut [S]) {
    for i in 0..n {
        for j in 0..=i {
            let sum = A[i * n + j] + A[j * n + i];
            (A[i * n + j], A[j * n + i]) = (sum, sum);
        }
    }
}

/// Implements +, −, negation, · number and the assigning forms for a type that consists of components, each with +, −,
/// ….
macro_rules! linear_space {
    ($T:ident { $($field:tt),* }) => {
        impl<S: $crate::scalar::Scalar> core::ops::Add for $T<S> {
            type Output = Self;
            #[inline(always)]
            fn add(self, o: Self) -> Self { $T { $($field: self.$field + o.$field),* } }
        }
        impl<S: $crate::scalar::Scalar> core::ops::Sub for $T<S> {
            type Output = Self;
            #[inline(always)]
            fn sub(self, o: Self) -> Self { $T { $($field: self.$field - o.$field),* } }
        }
        impl<S: $crate::scalar::Scalar> core::ops::Neg for $T<S> {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self { $T { $($field: -self.$field),* } }
        }
        impl<S: $crate::scalar::Scalar> core::ops::Mul<S> for $T<S> {
            type Output = Self;
            #[inline(always)]
            fn mul(self, k: S) -> Self { $T { $($field: self.$field * k),* } }
        }
        $crate::scalar::assign_ops!([S: $crate::scalar::Scalar] $T<S>);
    };
}
pub(crate) use linear_space;
