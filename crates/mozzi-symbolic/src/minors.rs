//! Minors of a matrix of expressions, by expansion: nothing is divided.

use crate::symbol::Symbol;
use mozzi::Scalar;
use std::collections::HashMap;

/// A square matrix, and its minors that are known by their rows and columns.
pub(crate) struct Minors {
    size: usize,
    entries: Vec<Symbol>,
    known: HashMap<(u32, u32), Symbol>,
}

impl Minors {
    /// [M Aᵀ; A 0] for M, n × n, and A, k × n.
    pub fn saddle(n: usize, M: &[Symbol], A: &[Symbol]) -> Self {
        let size = n + A.len().checked_div(n).unwrap_or(0);
        let entry = |i: usize, j: usize| match (i < n, j < n) {
            (true, true) => M[i * n + j],
            (false, true) => A[(i - n) * n + j],
            (true, false) => A[(j - n) * n + i],
            (false, false) => Symbol::zero(),
        };
        let entries = (0..size * size).map(|k| entry(k / size, k % size)).collect();
        Minors { size, entries, known: HashMap::new() }
    }

    /// The entries.
    pub fn entries(&self) -> &[Symbol] {
        &self.entries
    }

    fn all(&self) -> u32 {
        (1 << self.size) - 1
    }

    /// The determinant.
    pub fn determinant(&mut self) -> Symbol {
        self.minor(self.all(), self.all())
    }

    /// The entry of the adjugate: the matrix times it is the determinant times 1.
    pub fn adjugate(&mut self, i: usize, j: usize) -> Symbol {
        let minor = self.minor(self.all() & !(1 << j), self.all() & !(1 << i));
        if (i + j).is_multiple_of(2) { minor } else { -minor }
    }

    /// The determinant of these rows and columns, along the last row.
    fn minor(&mut self, rows: u32, columns: u32) -> Symbol {
        let Some(row) = rows.checked_ilog2() else { return Symbol::one() };
        if let Some(&known) = self.known.get(&(rows, columns)) {
            return known;
        }
        let (mut sum, mut is_even) = (Symbol::zero(), rows.count_ones() % 2 == 1);
        for column in (0..self.size).filter(|column| columns >> column & 1 == 1) {
            let entry = self.entries[row as usize * self.size + column];
            if entry != Symbol::zero() {
                let product = entry * self.minor(rows & !(1 << row), columns & !(1 << column));
                sum += if is_even { product } else { -product };
            }
            is_even = !is_even;
        }
        self.known.insert((rows, columns), sum);
        sum
    }
}
