//! Arrow's IPC files: columns by name, as in CSV tables. pandas, polars and pyarrow call them Feather.

mod blocks;
mod column;

use super::bound::caught;
use super::precision::Precision;
use super::samples::Samples;
use super::{How, recognised};
use crate::failure::{Failure, Result};
use crate::input::cannot;
use crate::output::Output;
use crate::recogniser::Recognised;
use arrow_array::{Array, RecordBatch};
use arrow_ipc::reader::FileReader;
use arrow_ipc::writer::FileWriter;
use arrow_schema::{ArrowError, Field, Schema};
use mozzi::Model;
use mozzi_urdf::files;
use std::path::Path;
use std::sync::Arc;

/// The robot is chosen by the columns' names.
pub fn read<'m>(file: &str, choose: &dyn Fn(&[String]) -> &'m Model, how: &How) -> Result<Samples> {
    let damaged = |why: String| cannot(file, &why);
    let mut opened = files::open(Path::new(file)).map_err(|error| cannot(file, &error))?;
    blocks::check(&mut opened).map_err(damaged)?;
    caught(file, || {
        let reader = |columns: Option<Vec<usize>>| {
            let opened = files::open(Path::new(file)).map_err(|error| cannot(file, &error))?;
            FileReader::try_new_buffered(opened, columns).map_err(|error| cannot(file, &error))
        };
        let names: Vec<String> = reader(None)?.schema().fields().iter().map(|field| field.name().clone()).collect();
        let found = recognised(file, &names, choose(&names), how)?;
        let used = found.used(file)?;
        columns(file, &names, &found, &used, how.may_miss, reader(Some(used.clone()))?)
    })
}

/// The tables of batches that contain only the used columns of a file.
pub fn columns(
    file: &str,
    names: &[String],
    found: &Recognised,
    used: &[usize],
    may_miss: bool,
    batches: impl Iterator<Item = std::result::Result<RecordBatch, ArrowError>>,
) -> Result<Samples> {
    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); names.len()];
    let mut rows = 0;
    for batch in batches {
        let batch = batch.map_err(|error| cannot(file, &error))?;
        for (&c, array) in used.iter().zip(batch.columns()) {
            column::numbers(array.as_ref(), may_miss, &mut columns[c]).map_err(|(row, what)| {
                Failure::wrong(format!("{file}: column `{}`{}", names[c], at(row, rows, &what)))
            })?;
        }
        rows += batch.num_rows();
    }
    let samples = found.samples(file, rows, |row, column| columns[column][row]);
    Ok(Samples { columns: found.rows.clone(), ..samples })
}

fn at(row: Option<usize>, before: usize, what: &str) -> String {
    row.map_or(format!(" {what}"), |row| format!(", row {} (counted from 0) {what}", before + row))
}

/// Columns, each with its name.
pub fn batch<T: Precision>(columns: Vec<(String, Vec<T>)>) -> std::result::Result<RecordBatch, ArrowError> {
    let (names, arrays): (Vec<String>, Vec<_>) =
        columns.into_iter().map(|(name, values)| (name, T::column(values))).unzip();
    let field = |(name, array): (String, &Arc<dyn Array>)| Field::new(name, array.data_type().clone(), false);
    let schema = Arc::new(Schema::new(names.into_iter().zip(&arrays).map(field).collect::<Vec<_>>()));
    RecordBatch::try_new(schema, arrays)
}

/// Writes an Arrow table into a file.
pub fn write<T: Precision>(file: &str, columns: Vec<(String, Vec<T>)>) -> Result<()> {
    Output::create(file)?.write(|to| {
        let batch = batch(columns).map_err(std::io::Error::other)?;
        let mut writer = FileWriter::try_new_buffered(to, &batch.schema()).map_err(std::io::Error::other)?;
        writer.write(&batch).and_then(|()| writer.finish()).map_err(std::io::Error::other)
    })
}
