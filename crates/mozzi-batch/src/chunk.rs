//! Some states on one thread: reads rows into registers, computes, writes registers into rows.

use crate::columns::{Layout, place, read_block, read_rows, write_block, write_rows};
use crate::lanes::Lane;
use crate::request::Request;
use core::ops::{Deref, DerefMut};
use mozzi::quantities::MOST_OUTPUTS;

/// A table with its name and its number of columns for each state.
#[derive(Clone, Copy)]
pub struct Table<'a, T> {
    pub name: &'static str,
    pub numbers: &'a [T],
    pub width: usize,
}

/// A table of this thread's states, and its number of columns for each state.
pub(crate) type TableMut<'a, T> = (&'a mut [T], usize);

/// This thread's states.
pub struct Chunk<'a, T> {
    /// The index of the first state.
    pub first: usize,
    pub states: usize,
    pub layout: Layout,
    /// The inputs of the whole call, in the order of [`Request::tables`].
    pub inputs: &'a [Table<'a, T>],
    /// One table for each output of the quantity.
    pub outputs: Fixed<TableMut<'a, T>>,
}

/// An array with room for the outputs of any quantity, without heap memory.
pub struct Fixed<X> {
    all: [X; MOST_OUTPUTS],
    count: usize,
}

impl<X: Default> FromIterator<X> for Fixed<X> {
    fn from_iter<I: IntoIterator<Item = X>>(items: I) -> Self {
        let mut fixed = Fixed { all: Default::default(), count: 0 };
        for item in items {
            fixed.all[fixed.count] = item;
            fixed.count += 1;
        }
        fixed
    }
}
impl<X> Deref for Fixed<X> {
    type Target = [X];
    #[inline(always)]
    fn deref(&self) -> &[X] {
        &self.all[..self.count]
    }
}
impl<X> DerefMut for Fixed<X> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [X] {
        &mut self.all[..self.count]
    }
}

impl<T: crate::Number> Chunk<'_, T> {
    /// Reads `rows` states of every input, from `first` on, as columns of registers.
    #[inline(always)]
    pub fn read<L: Lane<Number = T>>(&self, first: usize, rows: usize, columns: &mut [L]) {
        let mut rest = columns;
        for (k, table) in self.inputs.iter().enumerate() {
            let (columns, further) = rest.split_at_mut(table.width);
            self.read_input(k, first, rows, columns);
            rest = further;
        }
    }

    /// Reads one input.
    #[inline(always)]
    pub fn read_input<L: Lane<Number = T>>(&self, input: usize, first: usize, rows: usize, columns: &mut [L]) {
        let (table, first) = (self.inputs[input].numbers, self.first + first);
        match self.layout {
            Layout::Rows => read_rows(table, first, rows, columns),
            Layout::Blocks => read_block(table, first / L::WIDTH, columns),
        }
    }

    /// The inverse of [`read`](Self::read), for the outputs.
    #[inline(always)]
    pub fn write<L: Lane<Number = T>>(&mut self, first: usize, rows: usize, columns: &[L]) {
        let mut rest = columns;
        for (table, width) in &mut *self.outputs {
            let (columns, further) = rest.split_at(*width);
            match self.layout {
                Layout::Rows => write_rows(table, first, rows, columns),
                Layout::Blocks => write_block(table, first / L::WIDTH, columns),
            }
            rest = further;
        }
    }

    /// Recomputes a state that failed the quick tests, alone and in `f64`. Returns the error that names the joint or
    /// the task, if there is one. With `replace`, its outputs are replaced by the recomputed ones.
    #[cold]
    #[inline(never)]
    pub fn recheck(
        &mut self,
        request: &Request<T>,
        state: usize,
        lanes: usize,
        replace: bool,
    ) -> Result<(), mozzi::Error> {
        let lanes = if self.layout == Layout::Rows { 1 } else { lanes };
        let at = |&Table { numbers, width, .. }: &Table<T>| {
            (0..width).map(|column| numbers[place(self.first + state, column, width, lanes)].into()).collect()
        };
        let numbers = self.inputs.iter().map(at);
        let found = request.at_one_state(&numbers.collect::<Vec<_>>())?;
        for ((table, width), values) in self.outputs.iter_mut().zip(found).filter(|_| replace) {
            for (column, value) in values.into_iter().enumerate() {
                table[place(state, column, *width, lanes)] = T::from_f64(value);
            }
        }
        Ok(())
    }
}
