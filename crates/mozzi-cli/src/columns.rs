//! CSV out: every digit, so that what is read back is the same number.

use crate::failure::{Failure, Result};
use std::fmt::Write;

/// A table by columns.
#[derive(Default)]
pub struct Columns {
    names: Vec<String>,
    values: Vec<Vec<f64>>,
}

impl Columns {
    pub fn add(&mut self, name: impl Into<String>, values: Vec<f64>) {
        self.names.push(name.into());
        self.values.push(values);
    }

    /// `group_1` … `group_n` of rows.
    pub fn add_group(&mut self, group: &str, n: usize, rows: &[Vec<f64>]) {
        for j in 0..n {
            self.add(format!("{group}_{}", j + 1), rows.iter().map(|row| row[j]).collect());
        }
    }

    pub fn rows(&self) -> usize {
        self.values.first().map_or(0, Vec::len)
    }

    pub fn text(&self) -> String {
        let mut text = self.names.join(",") + "\n";
        for row in 0..self.rows() {
            for (c, column) in self.values.iter().enumerate() {
                // writing to a String cannot fail; {:?} is the shortest text that reads back as the same number
                let _ = write!(text, "{}{:?}", if c == 0 { "" } else { "," }, column[row]);
            }
            text.push('\n');
        }
        text
    }
}

/// Writes a text to a file.
pub fn save(file: &str, text: &str) -> Result<()> {
    std::fs::write(file, text).map_err(|error| Failure::wrong(format!("{file} cannot be written: {error}")))
}
