//! CSV, row by row, with every digit.

use super::{Row, Rows};
use mozzi_sim::Sample;
use std::io::{Result, Write};

pub struct Csv<'m, W> {
    to: W,
    columns: Row<'m>,
}

impl<'m, W: Write> Csv<'m, W> {
    /// Writes the header; `shown` is what its names look like.
    pub fn new(mut to: W, columns: Row<'m>, shown: fn(&str) -> String) -> Result<Self> {
        let names: Vec<String> = columns.names().iter().map(|name| shown(name)).collect();
        writeln!(to, "{}", names.join(","))?;
        Ok(Csv { to, columns })
    }
}

/// A row as a line.
pub fn line(mut to: impl Write, columns: &Row, row: &Sample) -> Result<()> {
    for (c, x) in columns.values(row).enumerate() {
        // {:?} is the shortest text that reads back as the same number
        write!(to, "{}{x:?}", if c == 0 { "" } else { "," })?;
    }
    writeln!(to)
}

impl<W: Write> Rows for Csv<'_, W> {
    fn row(&mut self, row: &Sample) -> Result<()> {
        line(&mut self.to, &self.columns, row)
    }

    fn finish(mut self: Box<Self>) -> Result<()> {
        self.to.flush()
    }
}
