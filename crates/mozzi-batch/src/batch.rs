//! The quantities of a model at many states.

use crate::chunk::{Chunk, Table, TableMut, Worker};
use crate::columns::{Layout, place};
use crate::instruction_set::{Entry, InstructionSet, Number, OnLanes, choose};
use crate::lanes::Lane;
use crate::pool::Pool;
use crate::quantity::Quantity;
use crate::threads::Threads;
use crate::{BatchEnvironment, Error};
use mozzi::{Environment, FrameId, Model, Wrench};
use std::sync::Arc;

/// A chunk's tables fill about half of a core's second cache.
const CHUNK_BYTES: usize = 1 << 18;

/// A model with what it takes to ask it of many states: constants as `T`, registers, threads, the tables' layout.
///
/// Every method takes tables of N states, N being given by θ's length, and writes tables of the caller's. Numbers of one state stand side
/// by side (see [`Layout`]); matrices by rows.
#[derive(Clone, Debug)]
pub struct Batch<T: Number = f64> {
    model: Arc<Model>,
    constants: Arc<Model<T>>,
    set: InstructionSet,
    layout: Layout,
    threads: Threads,
    /// Workers of earlier calls.
    pool: Pool,
}

impl Batch {
    /// In `f64`, on the machine's widest registers and all its cores, with row-major tables.
    pub fn new(model: &Model) -> Self {
        Self::of(model)
    }
}

impl<T: Number> Batch<T> {
    /// As [`new`](Batch::new), in numbers of this type: `Batch::<f32>::of(&model)`.
    pub fn of(model: &Model) -> Self {
        Batch {
            model: Arc::new(model.clone()),
            constants: Arc::new(model.map(T::from_f64)),
            set: InstructionSet::best(),
            layout: Layout::Rows,
            threads: Threads::All,
            pool: Pool::default(),
        }
    }

    /// On registers of this kind.
    ///
    /// # Errors
    /// [`Error::UnsupportedInstructionSet`].
    pub fn with_instruction_set(self, set: InstructionSet) -> Result<Self, Error> {
        if set.is_available() { Ok(Batch { set, ..self }) } else { Err(Error::UnsupportedInstructionSet { set }) }
    }

    /// On this many threads; on one, on the caller's. Results are the same to the bit for any number.
    ///
    /// # Errors
    /// [`Error::Threads`] for none, or where the system gives no more.
    pub fn with_threads(self, threads: usize) -> Result<Self, Error> {
        Ok(Batch { threads: Threads::new(threads)?, ..self })
    }

    /// With tables in this layout.
    pub fn with_layout(self, layout: Layout) -> Self {
        Batch { layout, ..self }
    }

    /// The tables' layout.
    pub fn layout(&self) -> Layout {
        self.layout
    }

    /// The model.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The registers in use.
    pub fn instruction_set(&self) -> InstructionSet {
        self.set
    }

    /// How many states a register holds, and a block of [`Layout::Blocks`].
    pub fn lanes(&self) -> usize {
        self.set.lanes::<T>()
    }

    /// How many threads work at once, at most.
    pub fn threads(&self) -> usize {
        self.threads.count()
    }

    pub(crate) fn workers(&self) -> &Threads {
        &self.threads
    }

    /// The same on other threads.
    pub(crate) fn on(&self, threads: Threads) -> Self {
        Batch { threads, ..self.clone() }
    }

    /// The table of rows in the layout of this batch's [`Layout::Blocks`], the last block filled up with its last state.
    pub fn to_blocks(&self, rows: &[T], width: usize) -> Vec<T> {
        let (lanes, states) = (self.lanes(), rows.len() / width.max(1));
        let mut blocks = Vec::with_capacity(states.next_multiple_of(lanes) * width);
        for first in (0..states).step_by(lanes) {
            for column in 0..width {
                blocks.extend((first..first + lanes).map(|state| rows[state.min(states - 1) * width + column]));
            }
        }
        blocks
    }

    /// The inverse of [`to_blocks`](Self::to_blocks), of the first states.
    pub fn to_rows(&self, blocks: &[T], width: usize, states: usize) -> Vec<T> {
        let lanes = self.lanes();
        (0..states).flat_map(|state| (0..width).map(move |column| blocks[place(state, column, width, lanes)])).collect()
    }

    fn states(&self, theta: &[T]) -> Result<usize, Error> {
        let (width, lanes) = (self.model.nq(), self.block());
        match theta.len() {
            0 => Ok(0),
            found if width == 0 || !found.is_multiple_of(width * lanes) => {
                Err(Error::IncompleteState { found, width, lanes })
            }
            found => Ok(found / width),
        }
    }

    /// States that cannot be divided.
    fn block(&self) -> usize {
        match self.layout {
            Layout::Rows => 1,
            Layout::Blocks => self.lanes(),
        }
    }

    /// The number at this state's place in a table.
    fn at(&self, (table, width): Table<T>, state: usize) -> Vec<f64> {
        (0..width).map(|column| table[place(state, column, width, self.block())].into()).collect()
    }

    /// The number of states; an error for tables that do not go with it, frames of other models, and quaternions that are none.
    pub(crate) fn check(
        &self,
        inputs: &[(&'static str, Table<T>)],
        outputs: &[(&'static str, usize, usize)],
        surroundings: &BatchEnvironment<T>,
    ) -> Result<usize, Error> {
        let (model, lanes) = (&*self.model, self.block());
        let states = self.states(inputs[0].1.0)?;
        let wrong = |what, found, width| {
            let expected = states * width;
            if found == expected {
                Ok(())
            } else {
                Err(Error::WrongLength { what, found, expected, states, width, lanes })
            }
        };
        for &(what, (table, width)) in inputs {
            wrong(what, table.len(), width)?;
        }
        for &(what, length, width) in outputs {
            wrong(what, length, width)?;
        }
        for &(frame, table) in surroundings.wrenches {
            model.check_frame(frame)?;
            wrong("wrenches", table.len(), 6)?;
        }
        model.check_environment(&surroundings.environment)?;
        if model.is_floating() {
            self.check_quaternions(inputs[0].1, states)?;
        }
        Ok(states)
    }

    pub(crate) fn run<Q: Quantity>(
        &self,
        quantity: &Q,
        inputs: &[(&'static str, Table<T>)],
        outputs: Vec<(&'static str, TableMut<T>)>,
        surroundings: BatchEnvironment<T>,
    ) -> Result<(), Error> {
        let sizes: Vec<_> = outputs.iter().map(|(what, (table, width))| (*what, table.len(), *width)).collect();
        let states = self.check(inputs, &sizes, &surroundings)?;
        let frames: Vec<FrameId> = surroundings.wrenches.iter().map(|&(frame, _)| frame).collect();
        let tables: Vec<Table<T>> = inputs
            .iter()
            .map(|&(_, table)| table)
            .chain(surroundings.wrenches.iter().map(|&(_, table)| (table, 6)))
            .collect();
        let outputs = outputs.into_iter().map(|(_, table)| table).collect();
        let chunks = self.cut(states, &tables, outputs, &surroundings, &frames);
        let mut suspects = choose(self.set, Run { batch: self, quantity, chunks });
        suspects.sort_unstable();
        suspects.dedup();
        for index in suspects {
            self.ask_again(quantity, index, inputs, &surroundings)?;
        }
        Ok(())
    }

    /// Cuts the tables into pieces for the cache, and for the threads.
    fn cut<'a>(
        &self,
        states: usize,
        inputs: &[Table<'a, T>],
        mut outputs: Vec<TableMut<'a, T>>,
        surroundings: &'a BatchEnvironment<'a, T>,
        frames: &'a [FrameId],
    ) -> Vec<Chunk<'a, T>> {
        let width: usize = inputs.iter().map(|&(_, w)| w).chain(outputs.iter().map(|&(_, w)| w)).sum();
        let most = (CHUNK_BYTES / (width * size_of::<T>()).max(1)).max(1).next_multiple_of(self.lanes());
        let mut chunks = Vec::with_capacity(states.div_ceil(most));
        for first in (0..states).step_by(most) {
            let count = most.min(states - first);
            let mut own = Vec::with_capacity(outputs.len());
            for (table, width) in &mut outputs {
                let (this, rest) = core::mem::take(table).split_at_mut(count * *width);
                *table = rest;
                own.push((this, *width));
            }
            let part = |&(table, width): &Table<'a, T>| (&table[first * width..][..count * width], width);
            chunks.push(Chunk {
                first,
                states: count,
                layout: self.layout,
                inputs: inputs.iter().map(part).collect(),
                outputs: own,
                environment: &surroundings.environment,
                frames,
            });
        }
        chunks
    }

    fn check_quaternions(&self, theta: Table<T>, states: usize) -> Result<(), Error> {
        let (near, one) = (T::from_f64(1e-4), T::one());
        for index in 0..states {
            let square = (0..4).fold(T::zero(), |sum, k| {
                let x = theta.0[place(index, k, theta.1, self.block())];
                sum + x * x
            });
            if !((square - one) <= near && (one - square) <= near) {
                let source = self.model.check_configuration(&self.at(theta, index));
                source.map_err(|source| Error::State { index, source })?;
            }
        }
        Ok(())
    }

    /// A state whose pivots spread far, at one state and in f64: the error that names the joint or the task, if there is one.
    fn ask_again<Q: Quantity>(
        &self,
        quantity: &Q,
        index: usize,
        inputs: &[(&'static str, Table<T>)],
        surroundings: &BatchEnvironment<T>,
    ) -> Result<(), Error> {
        let mut applied = surroundings.environment.applied.to_vec();
        for &(frame, table) in surroundings.wrenches {
            let F = self.at((table, 6), index);
            applied.push((frame, Wrench::from_array(core::array::from_fn(|k| F[k]))));
        }
        let environment = Environment { applied: &applied, ..surroundings.environment };
        let state: Vec<Vec<f64>> = inputs.iter().map(|&(_, table)| self.at(table, index)).collect();
        quantity.again(&self.model, &state, &environment).map_err(|source| Error::State { index, source })
    }
}

/// Runs every chunk on the registers chosen.
struct Run<'r, 'a, T: Number, Q> {
    batch: &'r Batch<T>,
    quantity: &'r Q,
    chunks: Vec<Chunk<'a, T>>,
}

impl<T: Number, Q: Quantity> OnLanes<T, Q> for Run<'_, '_, T, Q> {
    type Output = Vec<usize>;
    fn on<L: Lane<Number = T>>(self, entry: Entry<Q, L>) -> Vec<usize> {
        let model = &*self.batch.constants;
        let suspects = self.batch.threads.map(
            self.chunks,
            || self.batch.pool.lend::<Worker<L>>(),
            |lent, chunk| {
                let worker = lent.get(|| Worker::new(model));
                entry(self.quantity, model, worker, chunk);
                core::mem::take(&mut worker.suspects)
            },
        );
        suspects.concat()
    }
}
