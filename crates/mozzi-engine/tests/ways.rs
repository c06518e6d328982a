//! The ways to compute many states on this machine.

use mozzi::Model;
use mozzi::quantities::Query;
use mozzi_engine::{Batch, Number};

/// The kernels, and machine code of these quantities in each shape that the processor runs, each with its name.
pub fn ways<T: Number>(model: &Model, queries: &[Query]) -> Vec<(String, Batch<T>)> {
    let kernels = ("kernels".to_string(), Batch::<T>::of(model).kernels_only());
    let shapes = T::SHAPES.into_iter().filter(|shape| shape.is_supported());
    let codes = shapes.map(|shape| {
        let batch = Batch::<T>::of(model).with_shape(shape).expect("supported");
        (format!("{shape:?}"), batch.compile(queries).expect("its own frames"))
    });
    std::iter::once(kernels).chain(codes).collect()
}
