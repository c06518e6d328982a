//! NumPy's .npy, row by row: a structured array with the column names of CSV.

use super::{Row, Rows};
use crate::tables::npy::structured_header;
use mozzi_sim::Sample;
use std::fs::File;
use std::io::{BufWriter, Result, Seek, SeekFrom, Write};

pub struct Npy<'m> {
    to: BufWriter<File>,
    columns: Row<'m>,
    expected: usize,
    rows: usize,
}

impl<'m> Npy<'m> {
    /// The header contains the expected number of rows; it is rewritten if the actual number differs.
    pub fn new(to: File, columns: Row<'m>, expected: usize) -> Result<Self> {
        let mut to = BufWriter::new(to);
        to.write_all(&structured_header(&columns.names(), expected))?;
        Ok(Npy { to, columns, expected, rows: 0 })
    }
}

impl Rows for Npy<'_> {
    fn row(&mut self, row: &Sample) -> Result<()> {
        self.rows += 1;
        let to = &mut self.to;
        self.columns.values(row).try_for_each(|x| to.write_all(&x.to_le_bytes()))
    }

    fn finish(mut self: Box<Self>) -> Result<()> {
        if self.rows != self.expected {
            self.to.seek(SeekFrom::Start(0))?;
            self.to.write_all(&structured_header(&self.columns.names(), self.rows))?;
        }
        self.to.flush()
    }
}
