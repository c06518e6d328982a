//! The quantities of a model at many states.

use crate::many::chunk::{Chunk, Fixed, Table, TableMut};
use crate::many::engine::Engine;
use crate::many::pool::Pool;
use crate::many::programs::{Entry, Programs};
use crate::many::request::Request;
use crate::many::threads::Threads;
use crate::many::{code, kernels};
use crate::{Arguments, BatchEnvironment, Error, Number, Refusal, Shape, is_too_long};
use mozzi::Model;
use mozzi::quantities::Query;
use std::sync::Arc;

/// A chunk's tables fill about half of a core's second cache.
const CHUNK_BYTES: usize = 1 << 18;
/// A chunk's states, except the last one's, are a multiple of this: whole registers of every shape.
const WHOLE: usize = 32;

/// A model prepared for many states.
///
/// Every method reads row-major tables of N states, where N follows from the length of θ, and fills the caller's
/// tables: the numbers of a state are contiguous, matrices by rows.
///
/// A quantity is computed by machine code as soon as that pays, else by the kernel of one state, on all cores; results
/// agree to rounding. When code is made depends only on the sizes of this batch's calls and its clones': after a call
/// their last digits may change once. [`compile`](Self::compile) makes it at once, [`kernels_only`](Self::kernels_only)
/// never. A call uses one of the two for all its states.
#[derive(Clone, Debug)]
pub struct Batch<T: Number = f64> {
    model: Arc<Model>,
    /// For simulations.
    constants: Arc<Model<T>>,
    /// That of machine code; none if the processor has none, or for kernels only.
    shape: Result<Shape, Refusal>,
    threads: Threads,
    /// True if dry friction sticks in simulations.
    sticks: bool,
    /// Workers left by earlier calls.
    pool: Pool,
    programs: Programs,
    /// Makes no further code: see [`Batch::for_job_of`].
    is_decided: bool,
}

impl Batch {
    /// A batch in `f64`, on all cores.
    pub fn new(model: &Model) -> Self {
        Self::of(model)
    }
}

impl<T: Number> Batch<T> {
    /// As [`new`](Batch::new), with this number type: `Batch::<f32>::of(&model)`. Tables of `f32` that no machine code
    /// computes are computed in `f64` and converted.
    pub fn of(model: &Model) -> Self {
        Batch {
            model: Arc::new(model.clone()),
            constants: Arc::new(model.map(T::from_f64)),
            shape: T::shape().ok_or_else(T::refusal),
            threads: Threads::All,
            sticks: true,
            pool: Pool::default(),
            programs: Programs::default(),
            is_decided: false,
        }
    }

    /// Never makes machine code: results are those of the kernels at one state, to the bit. Compiled quantities are
    /// discarded.
    pub fn kernels_only(self) -> Self {
        Batch { shape: Err(Refusal::NotAsked), programs: Programs::default(), ..self }
    }

    /// Machine code has this shape instead of the widest one; [compiled](Self::compile) quantities are discarded.
    ///
    /// # Errors
    /// [`Error::Shape`] if it is not one for several states in `T`, or if the processor cannot run it.
    pub fn with_shape(self, shape: Shape) -> Result<Self, Error> {
        Ok(Batch { shape: Ok(T::checked(shape)?), programs: Programs::default(), ..self })
    }

    /// Uses at most this many threads, at most eight for each core, and at most one for each piece of work. With one
    /// thread, the caller's thread does the work. Results are the same to the bit for any number of threads.
    ///
    /// # Errors
    /// [`Error::Threads`] for 0 threads.
    pub fn with_threads(self, threads: usize) -> Result<Self, Error> {
        Ok(Batch { threads: Threads::new(threads)?, ..self })
    }

    /// Chooses whether dry friction sticks in [`simulate`](Self::simulate). By default it does, and robots that have it
    /// are moved one by one. With `false` it is μ sgn θ̇, under which joints creep and chatter; all robots are then
    /// moved together.
    pub fn with_sticking(self, sticks: bool) -> Self {
        Batch { sticks, ..self }
    }

    pub(crate) fn sticks(&self) -> bool {
        self.sticks
    }

    /// The model.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The largest number of threads.
    pub fn threads(&self) -> usize {
        self.threads.count()
    }

    pub(crate) fn constants(&self) -> &Model<T> {
        &self.constants
    }

    pub(crate) fn workers(&self) -> &Threads {
        &self.threads
    }

    pub(crate) fn programs(&self) -> &Programs {
        &self.programs
    }

    pub(crate) fn pool(&self) -> &Pool {
        &self.pool
    }

    /// A copy of the batch that runs on these threads.
    pub(crate) fn on(&self, threads: Threads) -> Self {
        Batch { threads, ..self.clone() }
    }

    /// Computes a quantity at many states: fills the outputs from tables of its inputs, in their order. The number N of
    /// states follows from the length of the first table (for a robot without joints, of the first table that has
    /// numbers for each state). Parts of the environment that the quantity does not use have no effect. See
    /// [`LIST`](mozzi::quantities::LIST).
    ///
    /// # Errors
    /// A table has the wrong length (the error names it), a frame is missing or belongs to another model, or a state
    /// fails (the error carries its index). For a singular mass matrix or a singular task, the first such state is
    /// reported after all states are computed.
    ///
    /// # Panics
    /// If the number of inputs or outputs is not the quantity's.
    pub fn compute<'q>(
        &self,
        query: impl Into<Query<'q>>,
        inputs: &[&[T]],
        environment: &BatchEnvironment<T>,
        outputs: &mut [&mut [T]],
    ) -> Result<(), Error> {
        let query = query.into();
        query.check_subject(&self.model)?;
        let (name, declaration) = (query.name(), query.declaration());
        assert!(inputs.len() == declaration.inputs.len(), "{name} takes {} inputs", declaration.inputs.len());
        assert!(outputs.len() == declaration.outputs.len(), "{name} has {} outputs", declaration.outputs.len());
        let request = Request::new(query, &self.model, environment);
        let tables = request.tables(inputs);
        let widths: Fixed<usize> = query.output_lengths(&*self.model).collect();
        let sizes = declaration.outputs.iter().zip(&*outputs).zip(&*widths);
        let sizes = sizes.map(|((output, table), &width)| (output.name, table.len(), width));
        let states = self.check(&tables, sizes, &request.environment, request.frames())?;
        let outputs = outputs.iter_mut().zip(&*widths).map(|(table, &width)| (&mut **table, width)).collect();
        let chunks = cut(states, &tables, outputs);
        let mut frames = Vec::new();
        let arguments = request.arguments(&mut frames);
        let entry = self.code(&query, &arguments, states)?;
        let errors = match entry.as_ref().and_then(|entry| entry.made()) {
            Some(Ok(code)) => {
                let own = declaration.inputs.iter().map(|_| None);
                let given: Vec<Option<Vec<f64>>> = own.chain(request.constants(&arguments)).collect();
                let recompute = |chunk: &mut Chunk<T>, state: usize| chunk.recompute(&request, state);
                self.threads.map(
                    chunks,
                    || self.pool.lend::<code::Worker<T>>(),
                    |lent, chunk| code::run(code, &given, &recompute, lent.get(code::Worker::default), chunk),
                )
            }
            _ => self.threads.map(
                chunks,
                || self.pool.lend::<kernels::Worker>(),
                |lent, chunk| kernels::run(&request, lent.get(|| kernels::Worker::new(&self.model)), chunk),
            ),
        };
        Error::of_first(errors)
    }

    /// The machine code for a call of so many states, made now if it pays; `None` if the kernels compute it.
    pub(crate) fn code(
        &self,
        query: &Query,
        arguments: &Arguments,
        states: usize,
    ) -> Result<Option<Arc<Entry>>, Error> {
        let Ok(shape) = self.shape else { return Ok(None) };
        let entry = self.programs.entry(query, arguments, false);
        let made = match entry.made() {
            Some(made) => made,
            None if self.is_decided => return Ok(None),
            None if entry.pays(states) => entry.make(&self.model, *query, *arguments, shape)?,
            None => return Ok(None),
        };
        Ok(made.is_ok().then_some(entry))
    }

    /// A copy of the batch for a job of several calls, whose choice of engine is fixed: each of these quantities in
    /// this environment is computed by the engine that a single call of `states` states would use, and every other
    /// quantity as earlier calls have decided. Calls from several threads do not change the choice.
    ///
    /// # Errors
    /// [`Error::Model`] if a frame is missing or belongs to another model.
    pub fn for_job_of(
        &self,
        queries: &[Query],
        environment: &BatchEnvironment<T>,
        states: usize,
    ) -> Result<Self, Error> {
        let mut entries = Vec::new();
        for &query in queries {
            let request = Request::new(query, &self.model, environment);
            entries.extend(self.code(&query, &request.arguments(&mut Vec::new()), states)?);
        }
        Ok(Batch { programs: Programs::of(entries), is_decided: true, ..self.clone() })
    }

    /// Compiles these quantities to machine code now, in the robot's own environment, if there is code for this machine
    /// and the batch is not [kernels only](Self::kernels_only): see [`engine`](Self::engine). Clones share the code.
    ///
    /// # Errors
    /// [`Error::Model`] if the frame is missing or belongs to another model.
    pub fn compile(self, queries: &[Query]) -> Result<Self, Error> {
        for query in queries {
            query.check_subject(&self.model)?;
            if let Ok(shape) = self.shape {
                let arguments = alone(query);
                self.programs.entry(query, &arguments, true).make(&self.model, *query, arguments, shape)?;
            }
        }
        Ok(self)
    }

    /// The engine that computes this quantity in the robot's own environment, as far as calls have decided.
    pub fn engine<'q>(&self, query: impl Into<Query<'q>>) -> Engine {
        let query = query.into();
        self.engine_with(&query, &alone(&query))
    }

    /// The engine that computes this quantity in this environment, as far as calls have decided.
    pub fn engine_in<'q>(&self, query: impl Into<Query<'q>>, environment: &BatchEnvironment<T>) -> Engine {
        let query = query.into();
        let mut frames = Vec::new();
        self.engine_with(&query, &Request::new(query, &self.model, environment).arguments(&mut frames))
    }

    fn engine_with(&self, query: &Query, arguments: &Arguments) -> Engine {
        let entry = match self.shape {
            Ok(_) => self.programs.find(query, arguments),
            Err(refusal) => return Engine::Kernels(refusal),
        };
        match entry.as_ref().and_then(|entry| entry.made()) {
            Some(Ok(code)) => Engine::MachineCode(code.kernel.shape(), code.kernel.code_bytes()),
            Some(Err(refusal)) => Engine::Kernels(*refusal),
            None if query.check_subject(&self.model).is_ok() && is_too_long(&self.model, *query) => {
                Engine::Kernels(Refusal::Long)
            }
            None => Engine::Kernels(Refusal::NotYet),
        }
    }
}

/// Cuts the tables into pieces for the cache, and for the threads.
pub(crate) fn cut<'a, T: Number>(
    states: usize,
    inputs: &'a [Table<'a, T>],
    mut outputs: Fixed<TableMut<'a, T>>,
) -> Vec<Chunk<'a, T>> {
    let width: usize = inputs.iter().map(|table| table.width).chain(outputs.iter().map(|&(_, width)| width)).sum();
    let most = (CHUNK_BYTES / (width * size_of::<T>()).max(1)).max(1).next_multiple_of(WHOLE);
    let mut chunks = Vec::with_capacity(states.div_ceil(most));
    for first in (0..states).step_by(most) {
        let count = most.min(states - first);
        let own = |(table, width): &mut TableMut<'a, T>| {
            let (this, rest) = core::mem::take(table).split_at_mut(count * *width);
            *table = rest;
            (this, *width)
        };
        chunks.push(Chunk { first, states: count, inputs, outputs: outputs.iter_mut().map(own).collect() });
    }
    chunks
}

/// The arguments of a quantity's program in the robot's own environment: only the point, if there is one.
fn alone(query: &Query) -> Arguments<'static> {
    Arguments { about: query.subject.point != mozzi::Vec3([0.0; 3]), ..Arguments::default() }
}
