//! The numbers of an Arrow column.

use arrow_array::types::{
    Float32Type, Float64Type, Int8Type, Int16Type, Int32Type, Int64Type, TimestampMicrosecondType,
    TimestampMillisecondType, TimestampNanosecondType, TimestampSecondType, UInt8Type, UInt16Type, UInt32Type,
    UInt64Type,
};
use arrow_array::{Array, ArrowPrimitiveType, PrimitiveArray};

/// The numbers, or an error and its row, if it has one. A null is NaN if numbers may be missing.
pub fn numbers(column: &dyn Array, may_miss: bool, to: &mut Vec<f64>) -> Result<(), (Option<usize>, String)> {
    if let Some(row) = (0..column.len()).find(|&row| !may_miss && column.is_null(row)) {
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
    to.extend(found.into_iter().flatten().map(|x| x.map_or(f64::NAN, &convert)));
    found.is_some()
}

#[cfg(test)]
mod tests {
    use super::numbers;
    use arrow_array::{Float64Array, Int32Array};

    #[test]
    fn nulls_are_missing_numbers_of_logs() {
        let (mut to, column) = (Vec::new(), Float64Array::from(vec![Some(1.5), None]));
        assert!(numbers(&column, false, &mut to).is_err_and(|(row, _)| row == Some(1)));
        numbers(&column, true, &mut to).expect("numbers");
        numbers(&Int32Array::from(vec![None, Some(2)]), true, &mut to).expect("numbers");
        assert!(to[0] == 1.5 && to[1].is_nan() && to[2].is_nan() && to[3] == 2.0, "{to:?}");
    }
}
