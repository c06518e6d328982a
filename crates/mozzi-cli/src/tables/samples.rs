//! The contents of a table: states by rows, poses, or a reference to follow.

use crate::columns::names;
use crate::failure::{Failure, Result};
use crate::numbers::WRENCH;
use mozzi::Model;
use std::collections::BTreeMap;

/// A column with its meaning.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    pub column: String,
    pub meaning: String,
    pub unit: String,
    pub joint: String,
}

/// The range of a position or velocity of a joint that is locked, by its column.
#[derive(Clone, Debug)]
pub struct LockedRange {
    pub joint: String,
    pub meaning: &'static str,
    pub column: String,
    pub low: f64,
    pub high: f64,
}

/// A column of a mimic joint beside its source joint's.
#[derive(Clone, Debug)]
pub struct Following {
    pub joint: String,
    pub source: String,
    /// "3 · a + 0.2".
    pub law: String,
    pub column: String,
    pub found: Followed,
}

/// How a mimic joint's column fits its source joint's.
#[derive(Clone, Debug)]
pub enum Followed {
    /// The median distance of positions from the law, and the law's own motion (root mean square), rad or m.
    Differs([f64; 2]),
    /// Rows in which only the source has a force.
    Lacks(usize),
}

/// Numbers by name: those of the inputs, `wrench` of the tip; for .npz also `gravity`, `parameters` and `wrench_FRAME`.
#[derive(Debug, Default)]
pub struct Samples {
    /// Its name in messages.
    pub file: String,
    /// Rows.
    pub count: usize,
    /// The line of each row in a CSV file.
    pub lines: Vec<u64>,
    /// Times, s.
    pub t: Option<Vec<f64>>,
    /// The time of the first row, if `t` is counted from it, else 0.
    pub start: f64,
    /// By name, each by rows.
    pub tables: BTreeMap<String, Vec<f64>>,
    /// Whether the unit of `t` is named, or follows from its size.
    pub is_time_certain: bool,
    /// The meaning of each column.
    pub columns: Vec<Row>,
    /// The ranges of locked joints.
    pub locked: Vec<LockedRange>,
    /// Likewise mimic joints.
    pub followers: Vec<Following>,
}

impl Samples {
    /// "table.csv:7", the place of a row.
    pub fn place(&self, row: usize) -> String {
        match self.lines.get(row) {
            Some(line) => format!("{}:{line}", self.file),
            None => format!("{}: state {row} (counted from 0)", self.file),
        }
    }

    /// Keeps these rows, which increase.
    pub fn keep(&mut self, rows: &[usize]) {
        let N = self.count.max(1);
        for table in self.tables.values_mut().chain(&mut self.t) {
            let width = table.len() / N;
            for (to, &row) in rows.iter().enumerate() {
                table.copy_within(row * width..(row + 1) * width, to * width);
            }
            table.truncate(rows.len() * width);
        }
        if !self.lines.is_empty() {
            self.lines = rows.iter().map(|&row| self.lines[row]).collect();
        }
        self.count = rows.len();
    }

    /// The times, which the command requires.
    pub fn times(&self) -> Result<&[f64]> {
        self.t.as_deref().ok_or_else(|| self.missing("column t", "is needed here"))
    }

    /// A table that the command requires.
    pub fn need(&self, name: &str, model: &Model) -> Result<&[f64]> {
        let table = self.tables.get(name).map(Vec::as_slice);
        table.ok_or_else(|| self.missing(&format!("column {}", columns_of(model, name)), "is needed here"))
    }

    /// "table.csv has no column t, which is needed here"
    pub fn missing(&self, what: &str, why: &str) -> Failure {
        Failure::wrong(format!("{} has no {what}, which {why}", self.file))
    }
}

/// The name of a table's columns in messages.
pub fn columns_of(model: &Model, name: &str) -> String {
    if name == "wrench" {
        return WRENCH.join(" ");
    }
    let names = names(model, name);
    format!("{} …", names.first().map_or(name, |name| name))
}
