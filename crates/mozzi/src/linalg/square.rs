//! A square matrix by rows whose entries are filled in pairs (i, j) and (j, i), and in sixes.

use crate::scalar::Scalar;
use core::ops::{Index, IndexMut};

/// An n × n matrix in the caller's memory, by rows.
pub(crate) struct Square<'x, S> {
    entries: &'x mut [S],
    n: usize,
}

impl<'x, S: Scalar> Square<'x, S> {
    /// # Panics
    /// If there are not n² entries.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[track_caller]
    pub fn new(n: usize, entries: &'x mut [S]) -> Self {
        assert!(entries.len() == n * n, "a matrix has {} entries, expected n² = {}", entries.len(), n * n);
        Square { entries, n }
    }

    /// With all entries set to 0.
    ///
    /// # Panics
    /// If there are not n² entries.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[track_caller]
    pub fn zero(n: usize, entries: &'x mut [S]) -> Self {
        entries.fill(S::zero());
        Square::new(n, entries)
    }

    /// Adds to the entries (i, j) and (j, i).
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn add_pair(&mut self, i: usize, j: usize, [ij, ji]: [S; 2]) {
        self[(i, j)] += ij;
        self[(j, i)] += ji;
    }

    /// Adds to the first six entries of column j and of row j.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn add_sixes(&mut self, j: usize, column: [S; 6], row: [S; 6]) {
        for e in 0..6 {
            self.add_pair(e, j, [column[e], row[e]]);
        }
    }

    /// Sets the first six entries of column j.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn set_six(&mut self, j: usize, column: [S; 6]) {
        for e in 0..6 {
            self[(e, j)] = column[e];
        }
    }
}

impl<S> Index<(usize, usize)> for Square<'_, S> {
    type Output = S;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn index(&self, (i, j): (usize, usize)) -> &S {
        &self.entries[i * self.n + j]
    }
}
impl<S> IndexMut<(usize, usize)> for Square<'_, S> {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn index_mut(&mut self, (i, j): (usize, usize)) -> &mut S {
        &mut self.entries[i * self.n + j]
    }
}
