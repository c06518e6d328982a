//! Blocks of states for kernels from elsewhere: the transposition and the threads are a batch's own.

use crate::lanes::Lane;
use crate::quantity::{Memory, Quantity};
use crate::{Batch, BatchEnvironment, Error, Number};
use mozzi::scalar::Float;
use mozzi::{Environment, Model, Vec3};

/// What computes a block of states by its own means: as many as a register holds ([`Batch::lanes`](crate::Batch::lanes)), column by
/// column, the states of a column side by side.
pub trait BlockKernel: Sync {
    /// From the columns of all inputs to those of all outputs.
    fn evaluate<T: Float>(&self, inputs: &[T], outputs: &mut [T]);
}

struct External<'k, K>(&'k K);

impl<K: BlockKernel> Quantity for External<'_, K> {
    #[inline(always)]
    fn evaluate<L: Lane>(
        &self,
        _: &Model<L::Number>,
        input: &[L],
        _: &Environment<L>,
        _: &mut Memory<L>,
        output: &mut [L],
    ) {
        self.0.evaluate(L::numbers(input), L::numbers_mut(output));
    }
}

impl<T: Number> Batch<T> {
    /// Fills the outputs by a kernel from elsewhere, block by block, on this batch's threads and in its layout. Tables are given with their
    /// names and their numbers a state; the first input is θ, whose length tells the states.
    ///
    /// # Errors
    /// Tables of a wrong length.
    pub fn run_kernel<K: BlockKernel>(
        &self,
        kernel: &K,
        inputs: &[(&'static str, &[T], usize)],
        outputs: Vec<(&'static str, &mut [T], usize)>,
    ) -> Result<(), Error> {
        let inputs: Vec<_> = inputs.iter().map(|&(name, table, width)| (name, (table, width))).collect();
        let outputs = outputs.into_iter().map(|(name, table, width)| (name, (table, width))).collect();
        self.run(&External(kernel), &inputs, outputs, BatchEnvironment::from(Environment::with_gravity(Vec3::zero())))
    }
}
