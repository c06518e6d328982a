//! The number types of files.

use mozzi_engine::Number;

/// A number type of files, batches and GPUs.
pub trait Precision: Number + mozzi_gpu::Number {
    /// "f64" or "f32".
    const NAME: &'static str;

    fn write(self, bytes: &mut Vec<u8>);
    /// A column of a table.
    #[cfg(feature = "arrow")]
    fn column(values: Vec<Self>) -> arrow_array::ArrayRef;
}

macro_rules! precision {
    ($T:ty, $name:literal, $Array:ident) => {
        impl Precision for $T {
            const NAME: &'static str = $name;

            fn write(self, bytes: &mut Vec<u8>) {
                bytes.extend(self.to_le_bytes());
            }

            #[cfg(feature = "arrow")]
            fn column(values: Vec<Self>) -> arrow_array::ArrayRef {
                std::sync::Arc::new(arrow_array::$Array::from(values))
            }
        }
    };
}
precision!(f64, "f64", Float64Array);
precision!(f32, "f32", Float32Array);
