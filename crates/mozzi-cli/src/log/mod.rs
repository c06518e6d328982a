//! A motion as a file, row by row as it is simulated; its ending chooses the format.

#[cfg(feature = "arrow")]
mod arrow;
#[cfg(feature = "mcap")]
mod cdr;
mod csv;
#[cfg(feature = "mcap")]
mod mcap;
mod npy;
mod npz;
#[cfg(feature = "mcap")]
mod ros;
mod row;

pub use csv::line;
pub use row::Row;

use crate::failure::Result;
use crate::output::{Output, failed};
use crate::tables::format::{Format, MOTION};
use crate::terminal;
use mozzi_sim::{Recorder, Sample};
use std::io::{self, BufWriter};
use std::ops::ControlFlow;

/// Takes the rows of a motion.
pub trait Rows {
    fn row(&mut self, row: &Sample) -> io::Result<()>;
    /// Writes the end of the format.
    fn finish(self: Box<Self>) -> io::Result<()>;
}

/// The format of the file for a motion.
pub fn format(file: &str) -> Result<Format> {
    Format::of(file, &MOTION)
}

/// A file to which rows are written. An older file stays until this one is [finished](Self::finish).
pub struct Log<'m> {
    file: String,
    format: Format,
    columns: Option<Row<'m>>,
    expected: usize,
    rows: Option<Box<dyn Rows + 'm>>,
    error: Option<io::Error>,
    output: Option<Output>,
}

impl<'m> Log<'m> {
    /// `expected` is the number of expected rows; "-" is standard output.
    pub fn new(file: &str, columns: Row<'m>, expected: usize) -> Result<Self> {
        let format = format(file)?;
        let output = if file == "-" { None } else { Some(Output::create(file)?) };
        Ok(Log { file: file.to_string(), format, columns: Some(columns), expected, rows: None, error: None, output })
    }

    fn open(&mut self) -> io::Result<Box<dyn Rows + 'm>> {
        let Some(columns) = self.columns.take() else { return Err(io::Error::other("the file is open")) };
        let Some(output) = &self.output else {
            return Ok(Box::new(csv::Csv::new(BufWriter::new(io::stdout().lock()), columns, terminal::result)?));
        };
        let to = output.handle()?;
        Ok(match self.format {
            Format::Csv => Box::new(csv::Csv::new(BufWriter::new(to), columns, str::to_string)?),
            Format::Npy => Box::new(npy::Npy::new(to, columns, self.expected)?),
            Format::Npz => Box::new(npz::Npz::new(to, &self.file, columns)?),
            #[cfg(feature = "arrow")]
            Format::Arrow => Box::new(arrow::Batches::to_arrow(to, columns)?),
            #[cfg(feature = "parquet")]
            Format::Parquet => Box::new(arrow::Batches::to_parquet(to, columns)?),
            #[cfg(feature = "mcap")]
            Format::Mcap => Box::new(mcap::Mcap::new(to, columns.model)?),
            #[cfg(not(all(feature = "arrow", feature = "parquet", feature = "mcap")))]
            _ => return Err(io::Error::other("this program was built without its format")),
        })
    }

    /// Completes the file.
    pub fn finish(mut self) -> Result<()> {
        let rows = self.rows.take();
        let error = self.error.take().or_else(|| rows?.finish().err());
        match (error, self.output.take()) {
            // the reader of the pipe has closed it
            (Some(error), None) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
            (Some(error), _) => {
                let name = if self.file == "-" { "standard output" } else { &self.file };
                Err(failed(name, &error))
            }
            (None, Some(output)) => output.finish(),
            (None, None) => Ok(()),
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
