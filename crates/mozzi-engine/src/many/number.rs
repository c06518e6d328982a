//! The number types of tables.

use crate::{Error, Refusal, Shape};
use mozzi::scalar::{Bits, Float};

/// `f64` or `f32`.
pub trait Number: Float + Bits<Number = Self> + Into<f64> + Send + Sync + 'static {
    /// The shapes of machine code for several states, the widest first.
    const SHAPES: [Shape; 3];

    /// These numbers, if they are `f64`.
    fn as_f64(numbers: &[Self]) -> Option<&[f64]>;

    /// These numbers, if they are `f64`, mutably.
    fn as_f64_mut(numbers: &mut [Self]) -> Option<&mut [f64]>;

    /// The widest shape that this processor runs.
    fn shape() -> Option<Shape> {
        Self::SHAPES.into_iter().find(|shape| shape.is_supported())
    }

    /// The reason why there is none: that of the last shape which has one of its own.
    #[doc(hidden)]
    fn refusal() -> Refusal {
        let reasons = Self::SHAPES.into_iter().filter_map(|shape| shape.check().err());
        reasons.fold(Refusal::Processor, |first, next| if next == Refusal::Processor { first } else { next })
    }

    /// This shape, if it is of this number and the processor runs it.
    ///
    /// # Errors
    /// [`Error::Shape`].
    fn checked(shape: Shape) -> Result<Shape, Error> {
        match Self::SHAPES.contains(&shape) && shape.is_supported() {
            true => Ok(shape),
            false => Err(Error::Shape { shape }),
        }
    }
}

impl Number for f64 {
    const SHAPES: [Shape; 3] = [Shape::EightF64, Shape::FourF64, Shape::TwoF64];

    #[inline(always)]
    fn as_f64(numbers: &[f64]) -> Option<&[f64]> {
        Some(numbers)
    }

    #[inline(always)]
    fn as_f64_mut(numbers: &mut [f64]) -> Option<&mut [f64]> {
        Some(numbers)
    }
}

impl Number for f32 {
    const SHAPES: [Shape; 3] = [Shape::SixteenF32, Shape::EightF32, Shape::FourF32];

    #[inline(always)]
    fn as_f64(_: &[f32]) -> Option<&[f64]> {
        None
    }

    #[inline(always)]
    fn as_f64_mut(_: &mut [f32]) -> Option<&mut [f64]> {
        None
    }
}
