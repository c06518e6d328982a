//! Arrow's IPC files: columns by name, as in CSV tables. pandas, polars and pyarrow call them Feather.

use super::precision::Precision;
use super::samples::Samples;
use crate::csv::Places;
use crate::failure::{Failure, Result};
use crate::interrupt::Writing;
use arrow_array::{Array, Float32Array, Float64Array, Int64Array, RecordBatch};
use arrow_ipc::reader::FileReader;
use arrow_ipc::writer::FileWriter;
use arrow_schema::{ArrowError, Field, Schema};
use mozzi::Model;
use std::fs::File;
use std::sync::Arc;

pub fn read(file: &str, model: &Model) -> Result<Samples> {
    let cannot = |error: &dyn std::fmt::Display| Failure::wrong(format!("{file} cannot be read: {error}"));
    let opened = File::open(file).map_err(|error| cannot(&error))?;
    let reader = FileReader::try_new_buffered(opened, None).map_err(|error| cannot(&error))?;
    let header: Vec<String> = reader.schema().fields().iter().map(|field| field.name().clone()).collect();
    let places = Places::find(file, &header, model)?;
    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); header.len()];
    let mut rows = 0;
    for batch in reader {
        let batch = batch.map_err(|error| cannot(&error))?;
        for c in places.all() {
            numbers(batch.column(c).as_ref(), &mut columns[c]).map_err(|(row, what)| {
                Failure::wrong(format!("{file}: column `{}`{}", header[c], at(row, rows, what)))
            })?;
        }
        rows += batch.num_rows();
    }
    Ok(places.samples(file, rows, |row, column| columns[column][row]))
}

fn at(row: Option<usize>, before: usize, what: String) -> String {
    row.map_or(format!(" {what}"), |row| format!(", row {} (counted from 0) {what}", before + row))
}

/// A column's numbers, or the row and its error.
fn numbers(column: &dyn Array, to: &mut Vec<f64>) -> std::result::Result<(), (Option<usize>, String)> {
    if let Some(row) = (0..column.len()).find(|&row| column.is_null(row)) {
        return Err((Some(row), "is null, expected a number".into()));
    }
    let any = column.as_any();
    if let Some(column) = any.downcast_ref::<Float64Array>() {
        to.extend(column.values());
    } else if let Some(column) = any.downcast_ref::<Float32Array>() {
        to.extend(column.values().iter().map(|&x| f64::from(x)));
    } else if let Some(column) = any.downcast_ref::<Int64Array>() {
        to.extend(column.values().iter().map(|&x| x as f64));
    } else {
        return Err((None, format!("has type {}, expected Float64, Float32 or Int64", column.data_type())));
    }
    Ok(())
}

/// Columns, each with its name.
pub fn batch<T: Precision>(columns: Vec<(String, Vec<T>)>) -> std::result::Result<RecordBatch, ArrowError> {
    let (names, arrays): (Vec<String>, Vec<_>) =
        columns.into_iter().map(|(name, values)| (name, T::column(values))).unzip();
    let field = |(name, array): (String, &Arc<dyn Array>)| Field::new(name, array.data_type().clone(), false);
    let schema = Arc::new(Schema::new(names.into_iter().zip(&arrays).map(field).collect::<Vec<_>>()));
    RecordBatch::try_new(schema, arrays)
}

/// The same into a file.
pub fn write<T: Precision>(file: &str, columns: Vec<(String, Vec<T>)>) -> Result<()> {
    let cannot = |error: &dyn std::fmt::Display| Failure::wrong(format!("{file} cannot be written: {error}"));
    let batch = batch(columns).map_err(|error| cannot(&error))?;
    let _writing = Writing::to(file);
    let to = File::create(file).map_err(|error| cannot(&error))?;
    let mut writer = FileWriter::try_new_buffered(to, &batch.schema()).map_err(|error| cannot(&error))?;
    writer.write(&batch).and_then(|()| writer.finish()).map_err(|error| cannot(&error))
}
