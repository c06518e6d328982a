//! Arrow's files and Parquet, in batches of rows.

use super::{Row, Rows};
use crate::tables::arrow::batch;
use arrow_array::RecordBatch;
use arrow_ipc::writer::FileWriter;
use arrow_schema::ArrowError;
use mozzi_sim::Sample;
use std::fs::File;
use std::io::{BufWriter, Error, Result};

/// Rows of a batch.
const BATCH: usize = 8192;

/// A writer of batches.
pub trait Sink {
    fn write(&mut self, batch: &RecordBatch) -> std::result::Result<(), ArrowError>;
    fn close(self) -> std::result::Result<(), ArrowError>;
}

impl Sink for FileWriter<BufWriter<File>> {
    fn write(&mut self, batch: &RecordBatch) -> std::result::Result<(), ArrowError> {
        FileWriter::write(self, batch)
    }

    fn close(mut self) -> std::result::Result<(), ArrowError> {
        self.finish()
    }
}

pub struct Batches<'m, S> {
    row: Row<'m>,
    names: Vec<String>,
    columns: Vec<Vec<f64>>,
    sink: S,
}

/// The names of the columns, and an empty batch with the columns' types.
fn empty(row: &Row) -> std::result::Result<(Vec<String>, RecordBatch), ArrowError> {
    let names = row.names();
    let none = batch::<f64>(names.iter().map(|name| (name.clone(), Vec::new())).collect())?;
    Ok((names, none))
}

impl<'m> Batches<'m, FileWriter<BufWriter<File>>> {
    pub fn to_arrow(to: File, row: Row<'m>) -> Result<Self> {
        let (names, none) = empty(&row).map_err(Error::other)?;
        let sink = FileWriter::try_new_buffered(to, &none.schema()).map_err(Error::other)?;
        Ok(Batches { row, columns: vec![Vec::new(); names.len()], names, sink })
    }
}

impl<S: Sink> Batches<'_, S> {
    fn write(&mut self) -> Result<()> {
        let columns = self.columns.iter_mut().map(|column| std::mem::replace(column, Vec::with_capacity(BATCH)));
        let batch = batch(self.names.iter().cloned().zip(columns).collect()).map_err(Error::other)?;
        self.sink.write(&batch).map_err(Error::other)
    }
}

impl<S: Sink> Rows for Batches<'_, S> {
    fn row(&mut self, row: &Sample) -> Result<()> {
        self.columns.iter_mut().zip(self.row.values(row)).for_each(|(column, x)| column.push(x));
        if self.columns.first().is_some_and(|column| column.len() == BATCH) { self.write() } else { Ok(()) }
    }

    fn finish(mut self: Box<Self>) -> Result<()> {
        if self.columns.first().is_some_and(|column| !column.is_empty()) {
            self.write()?;
        }
        self.sink.close().map_err(Error::other)
    }
}

#[cfg(feature = "parquet")]
mod parquet {
    use super::{ArrowError, Batches, Error, File, RecordBatch, Result, Row, Sink, empty};
    use parquet::arrow::ArrowWriter;

    /// Bytes that are buffered until the end of their row group.
    const WAITING: usize = 32_000_000;

    impl Sink for ArrowWriter<File> {
        fn write(&mut self, batch: &RecordBatch) -> std::result::Result<(), ArrowError> {
            ArrowWriter::write(self, batch)?;
            if self.in_progress_size() > WAITING {
                self.flush()?;
            }
            Ok(())
        }

        fn close(self) -> std::result::Result<(), ArrowError> {
            ArrowWriter::close(self)?;
            Ok(())
        }
    }

    impl<'m> Batches<'m, ArrowWriter<File>> {
        pub fn to_parquet(to: File, row: Row<'m>) -> Result<Self> {
            let (names, none) = empty(&row).map_err(Error::other)?;
            let sink = ArrowWriter::try_new(to, none.schema(), None).map_err(Error::other)?;
            Ok(Batches { row, columns: vec![Vec::new(); names.len()], names, sink })
        }
    }
}
