//! The number types of kernels.

use mozzi_engine::Precision;

/// `f32` or `f64`.
pub trait Number: Copy + Default + private::Sealed + 'static {
    /// Its name in kernels.
    const PRECISION: Precision;
}

impl Number for f32 {
    const PRECISION: Precision = Precision::F32;
}

impl Number for f64 {
    const PRECISION: Precision = Precision::F64;
}

mod private {
    /// Kernels know no other types, and any bits are a number.
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}
