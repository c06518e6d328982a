//! The number types of files.

use arrow_array::{ArrayRef, Float32Array, Float64Array};
use mozzi_batch::Number;
use std::sync::Arc;

/// A number type of files, batches and GPUs.
pub trait Precision: Number + mozzi_gpu::Number {
    /// "f64" or "f32".
    const NAME: &'static str;

    fn write(self, bytes: &mut Vec<u8>);
    fn column(values: Vec<Self>) -> ArrayRef;
}

macro_rules! precision {
    ($T:ty, $name:literal, $Array:ty) => {
        impl Precision for $T {
            const NAME: &'static str = $name;

            fn write(self, bytes: &mut Vec<u8>) {
                bytes.extend(self.to_le_bytes());
            }

            fn column(values: Vec<Self>) -> ArrayRef {
                Arc::new(<$Array>::from(values))
            }
        }
    };
}
precision!(f64, "f64", Float64Array);
precision!(f32, "f32", Float32Array);
