//! A motion as a file, row by row as it is simulated; its ending chooses the format.

mod arrow;
#[cfg(feature = "mcap")]
mod cdr;
mod csv;
mod format;
#[cfg(feature = "mcap")]
mod mcap;
mod npy;
mod npz;
#[cfg(feature = "mcap")]
mod ros;
mod row;

pub use csv::line;
pub use format::Format;
pub use row::names;

use crate::failure::{Failure, Result};
use crate::interrupt::Writing;
use mozzi::Model;
use mozzi::simulation::{Recorder, Sample};
use std::fs::File;
use std::io::{self, BufWriter};
use std::ops::ControlFlow;

/// Takes the rows of a motion.
pub trait Rows {
    fn row(&mut self, row: &Sample) -> io::Result<()>;
    /// What the format has at its end.
    fn finish(self: Box<Self>) -> io::Result<()>;
}

/// A file to which rows go. It is made at the first row, so that wrong arguments leave an older file as it is, and
/// removed if it is not [finished](Self::finish).
pub struct Log<'m> {
    file: String,
    format: Format,
    model: &'m Model,
    expected: usize,
    rows: Option<Box<dyn Rows + 'm>>,
    error: Option<io::Error>,
    writing: Option<Writing>,
}

impl<'m> Log<'m> {
    /// As many rows are expected; "-" is standard output.
    pub fn new(file: &str, model: &'m Model, expected: usize) -> Result<Self> {
        let format = Format::of(file)?;
        Ok(Log { file: file.to_string(), format, model, expected, rows: None, error: None, writing: None })
    }

    fn open(&mut self) -> io::Result<Box<dyn Rows + 'm>> {
        let model = self.model;
        if self.file == "-" {
            return Ok(Box::new(csv::Csv::new(BufWriter::new(io::stdout().lock()), model)?));
        }
        let to = File::create(&self.file)?;
        self.writing = Some(Writing::to(&self.file));
        Ok(match self.format {
            Format::Csv => Box::new(csv::Csv::new(BufWriter::new(to), model)?),
            Format::Npy => Box::new(npy::Npy::new(to, model, self.expected)?),
            Format::Npz => Box::new(npz::Npz::new(to, &self.file, model)?),
            Format::Arrow => Box::new(arrow::Batches::to_arrow(to, model)?),
            #[cfg(feature = "parquet")]
            Format::Parquet => Box::new(arrow::Batches::to_parquet(to, model)?),
            #[cfg(feature = "mcap")]
            Format::Mcap => Box::new(mcap::Mcap::new(to, model)?),
            #[cfg(not(all(feature = "parquet", feature = "mcap")))]
            _ => return Err(io::Error::other("this program was built without its format")),
        })
    }

    /// The whole file is written.
    pub fn finish(mut self) -> Result<()> {
        let rows = self.rows.take();
        let error = self.error.take().or_else(|| rows?.finish().err());
        match error {
            // who reads has seen enough
            Some(error) if self.file == "-" && error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
            Some(error) => {
                self.remove();
                let name = if self.file == "-" { "standard output" } else { &self.file };
                Err(Failure::wrong(format!("{name} cannot be written: {error}")))
            }
            None => Ok(()),
        }
    }

    /// Files alone: a pipe or a device is not ours to remove.
    fn remove(&self) {
        if self.writing.is_some() && std::fs::metadata(&self.file).is_ok_and(|found| found.is_file()) {
            let _ = std::fs::remove_file(&self.file); // the error itself is already reported
        }
    }
}

impl Drop for Log<'_> {
    fn drop(&mut self) {
        if self.rows.is_some() {
            self.remove();
        }
    }
}

impl Recorder for Log<'_> {
    fn take(&mut self, row: &Sample) -> ControlFlow<()> {
        let written = match &mut self.rows {
            Some(rows) => rows.row(row),
            None => self.open().and_then(|rows| self.rows.insert(rows).row(row)),
        };
        match written {
            Ok(()) => ControlFlow::Continue(()),
            Err(error) => {
                self.error.get_or_insert(error);
                ControlFlow::Break(())
            }
        }
    }
}
