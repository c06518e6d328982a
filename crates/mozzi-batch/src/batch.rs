//! The quantities of a model at many states.

use crate::chunk::{Chunk, Fixed, Table, TableMut};
use crate::columns::{Layout, place};
use crate::engine::Engine;
use crate::pool::Pool;
use crate::programmed::{Cache, Key, Programmed, Programs, find};
use crate::registers::has_registers;
use crate::request::Request;
use crate::run::Run;
use crate::threads::Threads;
use crate::{BatchEnvironment, Error, InstructionSet, Number};
use mozzi::quantities::Query;
use mozzi::{Environment, FrameId, Freedom, Model};
use mozzi_codegen::{Arguments, Refusal, is_too_long};
use std::sync::Arc;

/// A chunk's tables fill about half of a core's second cache.
const CHUNK_BYTES: usize = 1 << 18;

/// A table's name, its length and its number of columns for each state.
type Size = (&'static str, usize, usize);

/// A model prepared for many states: constants as `T`, registers, threads, the tables' layout.
///
/// Every method reads tables of N states, where N follows from the length of θ, and fills the caller's tables. The
/// numbers of a state are contiguous (see [`Layout`]); matrices by rows.
#[derive(Clone, Debug)]
pub struct Batch<T: Number = f64> {
    model: Arc<Model>,
    constants: Arc<Model<T>>,
    set: InstructionSet,
    layout: Layout,
    threads: Threads,
    /// Does dry friction stick in simulations?
    sticks: bool,
    /// Workers left by earlier calls.
    pool: Pool,
    /// The quantities compiled to machine code.
    compiled: Arc<Programs>,
    /// Programs left by earlier calls.
    programs: Cache,
}

impl Batch {
    /// A batch in `f64`, on the machine's widest registers and all its cores, with row-major tables.
    pub fn new(model: &Model) -> Self {
        Self::of(model)
    }
}

impl<T: Number> Batch<T> {
    /// As [`new`](Batch::new), with this number type: `Batch::<f32>::of(&model)`.
    pub fn of(model: &Model) -> Self {
        Batch {
            model: Arc::new(model.clone()),
            constants: Arc::new(model.map(T::from_f64)),
            set: InstructionSet::best(),
            layout: Layout::Rows,
            threads: Threads::All,
            sticks: true,
            pool: Pool::default(),
            compiled: Arc::default(),
            programs: Cache::default(),
        }
    }

    /// Uses registers of this kind; [compiled](Self::compile) quantities are discarded.
    ///
    /// # Errors
    /// [`Error::UnsupportedInstructionSet`].
    pub fn with_instruction_set(self, set: InstructionSet) -> Result<Self, Error> {
        let (compiled, programs) = (Arc::default(), Cache::default());
        if set.is_available() {
            Ok(Batch { set, compiled, programs, ..self })
        } else {
            Err(Error::UnsupportedInstructionSet { set })
        }
    }

    /// Uses at most this many threads, at most eight for each core, and at most one for each piece of work. With one
    /// thread, the caller's thread does the work. Results are the same to the bit for any number of threads.
    ///
    /// # Errors
    /// [`Error::Threads`] for 0 threads.
    pub fn with_threads(self, threads: usize) -> Result<Self, Error> {
        Ok(Batch { threads: Threads::new(threads)?, ..self })
    }

    /// Sets the layout of the tables.
    pub fn with_layout(self, layout: Layout) -> Self {
        Batch { layout, ..self }
    }

    /// Chooses whether dry friction sticks in [`simulate`](Self::simulate). By default it does, and robots that have it
    /// are moved one by one. With `false` it is μ sgn θ̇, under which joints creep and chatter; all robots are then
    /// moved together in registers.
    pub fn with_sticking(self, sticks: bool) -> Self {
        Batch { sticks, ..self }
    }

    pub(crate) fn sticks(&self) -> bool {
        self.sticks
    }

    /// The tables' layout.
    pub fn layout(&self) -> Layout {
        self.layout
    }

    /// The model.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The instruction set in use.
    pub fn instruction_set(&self) -> InstructionSet {
        self.set
    }

    /// The number of states in a register, and in a block of [`Layout::Blocks`].
    pub fn lanes(&self) -> usize {
        self.set.lanes::<T>()
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

    pub(crate) fn pool(&self) -> &Pool {
        &self.pool
    }

    /// The same batch with these threads.
    pub(crate) fn on(&self, threads: Threads) -> Self {
        Batch { threads, ..self.clone() }
    }

    /// Converts a row-major table to [`Layout::Blocks`]; the last block is filled with its last state.
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

    /// The inverse of [`to_blocks`](Self::to_blocks), for the first states.
    pub fn to_rows(&self, blocks: &[T], width: usize, states: usize) -> Vec<T> {
        let lanes = self.lanes();
        (0..states).flat_map(|state| (0..width).map(move |column| blocks[place(state, column, width, lanes)])).collect()
    }

    /// The number of states, from the length of the first table; for a robot without joints, of the first table that
    /// has numbers for each state.
    fn states(&self, mut tables: impl Iterator<Item = Size>) -> Result<usize, Error> {
        let lanes = self.block();
        match tables.find(|&(_, _, width)| width > 0) {
            Some((what, found, width)) if !found.is_multiple_of(width * lanes) => {
                Err(Error::IncompleteState { what, found, width, lanes })
            }
            Some((_, found, width)) => Ok(found / width),
            None => Ok(0),
        }
    }

    /// States in an indivisible block.
    fn block(&self) -> usize {
        match self.layout {
            Layout::Rows => 1,
            Layout::Blocks => self.lanes(),
        }
    }

    /// The numbers of this state in a table.
    fn at(&self, &Table { numbers, width, .. }: &Table<T>, state: usize) -> Vec<f64> {
        (0..width).map(|column| numbers[place(state, column, width, self.block())].into()).collect()
    }

    /// The number of states. Returns an error if a table's length does not match it, or a frame belongs to another
    /// model.
    pub(crate) fn check(
        &self,
        inputs: &[Table<T>],
        outputs: impl Iterator<Item = Size> + Clone,
        environment: &Environment,
        frames: impl Iterator<Item = FrameId>,
    ) -> Result<usize, Error> {
        let (model, lanes) = (&*self.model, self.block());
        let all = inputs.iter().map(|table| (table.name, table.numbers.len(), table.width)).chain(outputs);
        let states = self.states(all.clone())?;
        let wrong = |what, found, width| {
            let expected = states * width;
            if found == expected {
                Ok(())
            } else {
                Err(Error::WrongLength { what, found, expected, states, width, lanes })
            }
        };
        all.clone().try_for_each(|(what, found, width)| wrong(what, found, width))?;
        frames.into_iter().try_for_each(|frame| model.check_frame(frame))?;
        model.check_environment(environment)?;
        if inputs[0].name == "theta" {
            self.check_quaternions(&inputs[0], states)?;
        }
        Ok(states)
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
        let declaration = query.declaration();
        assert!(inputs.len() == declaration.inputs.len(), "{} takes {} inputs", query.name(), declaration.inputs.len());
        assert!(
            outputs.len() == declaration.outputs.len(),
            "{} has {} outputs",
            query.name(),
            declaration.outputs.len()
        );
        let request = Request::new(query, &self.model, environment);
        let state = declaration.inputs.iter().zip(inputs).zip(query.input_lengths(&*self.model));
        let mut tables: Vec<Table<T>> =
            state.map(|((input, &numbers), width)| Table { name: input.name, numbers, width }).collect();
        tables.extend(request.further());
        let widths: Fixed<usize> = query.output_lengths(&*self.model).collect();
        let sizes = declaration.outputs.iter().zip(&*outputs).zip(&*widths);
        let sizes = sizes.map(|((output, table), &width)| (output.name, table.len(), width));
        let frames = request.wrenches.iter().map(|&(frame, _)| frame);
        let states = self.check(&tables, sizes, &request.environment, frames)?;
        let outputs = outputs.iter_mut().zip(&*widths).map(|(table, &width)| (&mut **table, width)).collect();
        let chunks = self.cut(states, &tables, outputs);
        let mut frames = Vec::new();
        let arguments = request.arguments(&mut frames);
        let constants = request.constants(&arguments);
        let programmed = self.programmed(&request, &arguments, &constants)?;
        let run = Run { model: &self.constants, threads: &self.threads, pool: &self.pool, request: &request, chunks };
        let errors = match programmed {
            Some(programmed) => T::run_program(self.set, (&programmed, &constants), run),
            None if self.layout == Layout::Rows && query.is_faster_alone(&*self.model) => {
                T::run_kernel(InstructionSet::Portable, query.index(), run)
            }
            None => T::run_kernel(self.set, query.index(), run),
        };
        match errors.into_iter().min_by_key(|(index, _)| *index) {
            Some((index, source)) => Err(Error::State { index, source }),
            None => Ok(()),
        }
    }

    /// The program that computes this request, or `None` if a kernel computes it. A program is used for a compiled
    /// quantity in the robot's own environment, for inertial parameters that differ between states, and for a quantity
    /// without a kernel on registers.
    fn programmed(
        &self,
        request: &Request<T>,
        arguments: &Arguments,
        constants: &[Option<Vec<f64>>],
    ) -> Result<Option<Arc<Programmed>>, Error> {
        let query = &request.query;
        let compiled = if self.compiled.is_empty() { None } else { find(&self.compiled, query, arguments) };
        let compiled = compiled.filter(|_| request.is_own());
        match compiled.filter(|programmed| programmed.code(self.layout, constants).is_ok()) {
            Some(programmed) => Ok(Some(programmed.clone())),
            None if has_registers(query.index()) && request.parameters.is_none() => Ok(None),
            None => self.program(query, arguments).map(Some),
        }
    }

    fn program(&self, query: &Query, arguments: &Arguments) -> Result<Arc<Programmed>, Error> {
        let make = || Programmed::new::<T>(&self.model, *query, *arguments, self.set);
        Ok(self.programs.get_or_make(query, arguments, make)?)
    }

    /// The same batch with these quantities as machine code in the robot's own environment, if there is code for this
    /// machine: see [`engine`](Self::engine). Clones share the code.
    ///
    /// # Errors
    /// [`Error::Model`] if the frame is missing or belongs to another model.
    pub fn compile(self, queries: &[Query]) -> Result<Self, Error> {
        let mut compiled = Vec::clone(&self.compiled);
        for query in queries {
            let arguments = alone(query);
            query.check_subject(&self.model)?;
            if is_too_long(&self.model, *query) {
                continue; // left to the kernels on registers, or to a program made when it is called
            }
            let programmed = Programmed::new::<T>(&self.model, *query, arguments, self.set)?;
            let _ = programmed.code_of_own(self.layout); // now, not in the first call
            compiled.push((Key::new(query, &arguments), Arc::new(programmed)));
        }
        Ok(Batch { compiled: Arc::new(compiled), ..self })
    }

    /// The engine that computes this quantity in the robot's own environment.
    pub fn engine<'q>(&self, query: impl Into<Query<'q>>) -> Engine {
        let query = &query.into();
        let arguments = &alone(query);
        match find(&self.compiled, query, arguments) {
            Some(programmed) if has_registers(query.index()) => Engine::of(programmed.code_of_own(self.layout)),
            Some(programmed) => Engine::of_program(programmed.code_of_own(self.layout)),
            None if has_registers(query.index()) => {
                let is_long = query.check_subject(&self.model).is_ok() && is_too_long(&self.model, *query);
                Engine::Kernels(if is_long { Refusal::Long } else { Refusal::NotAsked })
            }
            None => match self.program(query, arguments) {
                Ok(programmed) => Engine::of_program(programmed.code_of_own(self.layout)),
                Err(_) => Engine::Kernels(Refusal::NotAsked), // the frame belongs to another model
            },
        }
    }

    /// Cuts the tables into pieces for the cache, and for the threads.
    fn cut<'a>(
        &self,
        states: usize,
        inputs: &'a [Table<'a, T>],
        mut outputs: Fixed<TableMut<'a, T>>,
    ) -> Vec<Chunk<'a, T>> {
        let width: usize = inputs.iter().map(|table| table.width).chain(outputs.iter().map(|&(_, w)| w)).sum();
        let most = (CHUNK_BYTES / (width * size_of::<T>()).max(1)).max(1).next_multiple_of(self.lanes().max(32));
        let mut chunks = Vec::with_capacity(states.div_ceil(most));
        for first in (0..states).step_by(most) {
            let count = most.min(states - first);
            let own = |(table, width): &mut TableMut<'a, T>| {
                let (this, rest) = core::mem::take(table).split_at_mut(count * *width);
                *table = rest;
                (this, *width)
            };
            let own = outputs.iter_mut().map(own).collect();
            chunks.push(Chunk { first, states: count, layout: self.layout, inputs, outputs: own });
        }
        chunks
    }

    /// Checks the length of each quaternion, of a floating base, balls and free joints.
    fn check_quaternions(&self, theta: &Table<T>, states: usize) -> Result<(), Error> {
        let (near, one) = (T::from_f64(1e-4), T::one());
        let joints = self.model.configuration_space().places().iter().filter(|joint| joint.freedom != Freedom::One);
        let first: Vec<usize> = joints.map(|joint| joint.q).collect();
        for index in 0..states {
            let square = |first: usize| {
                (first..first + 4).fold(T::zero(), |sum, k| {
                    let x = theta.numbers[place(index, k, theta.width, self.block())];
                    sum + x * x
                })
            };
            let is_unit = |square: T| (square - one) <= near && (one - square) <= near;
            if !first.iter().all(|&first| is_unit(square(first))) {
                let source = self.model.check_configuration(&self.at(theta, index));
                source.map_err(|source| Error::State { index, source })?;
            }
        }
        Ok(())
    }
}

/// The arguments of a quantity's program in the robot's own environment: only the point, if there is one.
fn alone(query: &Query) -> Arguments<'static> {
    Arguments { about: query.subject.point != mozzi::Vec3([0.0; 3]), ..Arguments::default() }
}
