//! CSV, row by row, with every digit.

use super::Rows;
use super::row::values;
use mozzi_sim::Sample;
use std::io::{Result, Write};

pub struct Csv<W>(W);

impl<W: Write> Csv<W> {
    /// Writes the header.
    pub fn new(mut to: W, names: &[String]) -> Result<Self> {
        writeln!(to, "{}", names.join(","))?;
        Ok(Csv(to))
    }
}

/// A row as a line.
pub fn line(mut to: impl Write, row: &Sample) -> Result<()> {
    for (c, x) in values(row).enumerate() {
        // {:?} is the shortest text that reads back as the same number
        write!(to, "{}{x:?}", if c == 0 { "" } else { "," })?;
    }
    writeln!(to)
}

impl<W: Write> Rows for Csv<W> {
    fn row(&mut self, row: &Sample) -> Result<()> {
        line(&mut self.0, row)
    }

    fn finish(self: Box<Self>) -> Result<()> {
        let Csv(mut to) = *self;
        to.flush()
    }
}
