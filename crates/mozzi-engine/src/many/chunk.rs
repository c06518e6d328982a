//! The tables of a call, and the part of them that one thread computes.

use crate::Number;
use crate::many::request::Request;
use core::ops::{Deref, DerefMut};
use mozzi::quantities::MOST_OUTPUTS;

/// A table with its name and its number of columns for each state. The numbers of a state are contiguous.
#[derive(Clone, Copy)]
pub(crate) struct Table<'a, T> {
    pub name: &'static str,
    pub numbers: &'a [T],
    pub width: usize,
}

impl<'a, T> Table<'a, T> {
    /// The numbers of this state.
    #[inline(always)]
    pub fn row(&self, state: usize) -> &'a [T] {
        &self.numbers[state * self.width..][..self.width]
    }
}

/// A table of this thread's states, and its number of columns for each state.
pub(crate) type TableMut<'a, T> = (&'a mut [T], usize);

/// A thread's states.
pub(crate) struct Chunk<'a, T> {
    /// The index of the first state.
    pub first: usize,
    pub states: usize,
    /// The inputs of the whole call: the quantity's, then those of the environment.
    pub inputs: &'a [Table<'a, T>],
    /// One table for each output of the quantity.
    pub outputs: Fixed<TableMut<'a, T>>,
}

impl<T: Number> Chunk<'_, T> {
    /// Computes a state of this chunk alone, in `f64`, with all checks, and replaces its outputs.
    ///
    /// # Errors
    /// The error that names the joint or the task.
    #[cold]
    #[inline(never)]
    pub fn recompute(&mut self, request: &Request<T>, state: usize) -> Result<(), mozzi::Error> {
        let row = |table: &Table<T>| table.row(self.first + state).iter().map(|&x| x.into()).collect();
        let found = request.at_one_state(&self.inputs.iter().map(row).collect::<Vec<_>>())?;
        for ((table, width), values) in self.outputs.iter_mut().zip(found) {
            table[state * *width..][..*width].iter_mut().zip(values).for_each(|(to, x)| *to = T::from_f64(x));
        }
        Ok(())
    }
}

/// The most tables of outputs: values, and their derivatives along a direction.
pub(crate) const MOST_TABLES: usize = 2 * MOST_OUTPUTS;

/// An array with room for the outputs of any quantity and their derivatives, without heap memory.
pub(crate) struct Fixed<X> {
    all: [X; MOST_TABLES],
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
impl<X> IntoIterator for Fixed<X> {
    type Item = X;
    type IntoIter = core::iter::Take<core::array::IntoIter<X, MOST_TABLES>>;
    fn into_iter(self) -> Self::IntoIter {
        self.all.into_iter().take(self.count)
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
