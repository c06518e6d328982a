//! NumPy's .npy, row by row: a structured array with the column names of CSV.

use super::Rows;
use super::row::{names, values};
use crate::tables::npy::structured_header;
use mozzi::Model;
use mozzi_sim::Sample;
use std::fs::File;
use std::io::{BufWriter, Result, Seek, SeekFrom, Write};

pub struct Npy {
    to: BufWriter<File>,
    names: Vec<String>,
    expected: usize,
    rows: usize,
}

impl Npy {
    /// The header contains the expected number of rows; it is rewritten if the actual number differs.
    pub fn new(to: File, model: &Model, expected: usize) -> Result<Self> {
        let names = names(model);
        let mut to = BufWriter::new(to);
        to.write_all(&structured_header(&names, expected))?;
        Ok(Npy { to, names, expected, rows: 0 })
    }
}

impl Rows for Npy {
    fn row(&mut self, row: &Sample) -> Result<()> {
        self.rows += 1;
        values(row).try_for_each(|x| self.to.write_all(&x.to_le_bytes()))
    }

    fn finish(mut self: Box<Self>) -> Result<()> {
        if self.rows != self.expected {
            self.to.seek(SeekFrom::Start(0))?;
            self.to.write_all(&structured_header(&self.names, self.rows))?;
        }
        self.to.flush()
    }
}
