//! The numbers of an Arrow column.

use arrow_array::types::{
    Float32Type, Float64Type, Int8Type, Int16Type, Int32Type, Int64Type, TimestampMicrosecondType,
    TimestampMillisecondType, TimestampNanosecondType, TimestampSecondType, UInt8Type, UInt16Type, UInt32Type,
    UInt64Type,
};
use arrow_array::{Array, ArrowPrimitiveType, PrimitiveArray};

/// The numbers, or an error and its row, if it has one.
pub fn numbers(column: &dyn Array, to: &mut Vec<f64>) -> Result<(), (Option<usize>, String)> {
    if let Some(row) = (0..column.len()).find(|&row| column.is_null(row)) {
        return Err((Some(row), "is null, expected a number".into()));
    }
    let is_read = of::<Float64Type>(column, to, |x| x)
        || of::<Float32Type>(column, to, f64::from)
        || of::<Int8Type>(column, to, f64::from)
        || of::<Int16Type>(column, to, f64::from)
        || of::<Int32Type>(column, to, f64::from)
        || of::<Int64Type>(column, to, |x| x as f64)
        || of::<UInt8Type>(column, to, f64::from)
        || of::<UInt16Type>(column, to, f64::from)
        || of::<UInt32Type>(column, to, f64::from)
        || of::<UInt64Type>(column, to, |x| x as f64)
        // s since 1970
        || of::<TimestampSecondType>(column, to, |x| x as f64)
        || of::<TimestampMillisecondType>(column, to, |x| x as f64 * 1e-3)
        || of::<TimestampMicrosecondType>(column, to, |x| x as f64 * 1e-6)
        || of::<TimestampNanosecondType>(column, to, |x| x as f64 * 1e-9);
    match is_read {
        true => Ok(()),
        false => {
            Err((None, format!("has type {}, expected Float64, Float32, integers or timestamps", column.data_type())))
        }
    }
}

/// If the column has this type, appends its numbers; returns whether it has.
fn of<T: ArrowPrimitiveType>(column: &dyn Array, to: &mut Vec<f64>, convert: impl Fn(T::Native) -> f64) -> bool {
    let found = column.as_any().downcast_ref::<PrimitiveArray<T>>();
    to.extend(found.into_iter().flat_map(|found| found.values().iter().copied()).map(convert));
    found.is_some()
}
