//! Some states on one thread: rows into registers, the computation, registers into rows.

use crate::columns::{Layout, place, read_block, read_rows, write_block, write_rows};
use crate::lanes::Lane;
use crate::request::Request;

/// A table of this thread's states, and its numbers a state.
pub(crate) type Table<'a, T> = (&'a [T], usize);
pub(crate) type TableMut<'a, T> = (&'a mut [T], usize);

/// This thread's states.
pub struct Chunk<'a, T> {
    /// The number of the first.
    pub first: usize,
    pub states: usize,
    pub layout: Layout,
    /// In the order of [`Request::tables`].
    pub inputs: Vec<Table<'a, T>>,
    pub outputs: Vec<TableMut<'a, T>>,
}

impl<T: crate::Number> Chunk<'_, T> {
    /// As many states of every input from `first` on, as columns of registers.
    #[inline(always)]
    pub fn read<L: Lane<Number = T>>(&self, first: usize, rows: usize, columns: &mut [L]) {
        let mut rest = columns;
        for (k, &(_, width)) in self.inputs.iter().enumerate() {
            let (columns, further) = rest.split_at_mut(width);
            self.read_input(k, first, rows, columns);
            rest = further;
        }
    }

    /// Of one input.
    #[inline(always)]
    pub fn read_input<L: Lane<Number = T>>(&self, input: usize, first: usize, rows: usize, columns: &mut [L]) {
        let (table, _) = self.inputs[input];
        match self.layout {
            Layout::Rows => read_rows(table, first, rows, columns),
            Layout::Blocks => read_block(table, first / L::WIDTH, columns),
        }
    }

    /// The inverse of [`read`](Self::read), of the outputs.
    #[inline(always)]
    pub fn write<L: Lane<Number = T>>(&mut self, first: usize, rows: usize, columns: &[L]) {
        let mut rest = columns;
        for (table, width) in &mut self.outputs {
            let (columns, further) = rest.split_at(*width);
            match self.layout {
                Layout::Rows => write_rows(table, first, rows, columns),
                Layout::Blocks => write_block(table, first / L::WIDTH, columns),
            }
            rest = further;
        }
    }

    /// A state that the quick tests do not pass, at one state and in `f64`: the error that names the joint or the task, if there is one.
    /// With `replace`, its outputs are those of that computation.
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
        let numbers = self
            .inputs
            .iter()
            .map(|&(table, width)| (0..width).map(|column| table[place(state, column, width, lanes)].into()).collect());
        let found = request.at_one_state(&numbers.collect::<Vec<_>>())?;
        for ((table, width), values) in self.outputs.iter_mut().zip(found).filter(|_| replace) {
            for (column, value) in values.into_iter().enumerate() {
                table[place(state, column, *width, lanes)] = T::from_f64(value);
            }
        }
        Ok(())
    }
}
