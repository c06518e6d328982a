//! Many states by machine code, which reads and writes the rows of the tables itself.

use crate::many::chunk::{Chunk, MOST_TABLES, Table};
use crate::{Extent, Form, Kernel, MOST_ARRAYS, Number, Program, Refusal, Shape, pivot_names};
use mozzi::least_is_clear;
use mozzi::quantities::Query;
use std::sync::Arc;

/// Registers of states in a call of the code; then their angles and pivots are tested.
const RUNS: usize = 16;

/// The most kinds of pivots: of the mass matrix, of a task.
const KINDS: usize = 2;

/// A quantity's machine code for tables.
#[derive(Debug)]
pub(crate) struct Code {
    pub kernel: Arc<Kernel>,
    /// The number of its inputs, of its own outputs, and of the kinds of pivots, which are condensed to the least and
    /// the sum.
    inputs: usize,
    own: usize,
    kinds: usize,
}

impl Code {
    /// The code of a quantity's program.
    ///
    /// # Errors
    /// [`Refusal`] with the reason why there is none.
    pub fn new(program: &Program, query: Query, shape: Shape) -> Result<Self, Refusal> {
        let kinds = pivot_names(&query).len();
        let (inputs, own) = (program.inputs().len(), program.outputs().len() - kinds);
        let kernel = Kernel::shared(program, shape, Form::Rows, own)?;
        Ok(Code { kernel, inputs, own, kinds })
    }
}

/// One thread's memory; its content means nothing between calls.
pub(crate) struct Worker<T> {
    /// The inputs that are the same in all states, repeated.
    constants: Vec<Vec<T>>,
    /// The last rows, where the tables are too short for the code.
    inputs: Vec<Vec<T>>,
    outputs: Vec<Vec<T>>,
    /// For each run and state the squares of the angles, and for each kind of pivots the least and the sum.
    squares: Vec<T>,
    pivots: [Vec<T>; KINDS],
}

impl<T> Default for Worker<T> {
    fn default() -> Self {
        Worker {
            constants: Vec::new(),
            inputs: Vec::new(),
            outputs: Vec::new(),
            squares: Vec::new(),
            pivots: [const { Vec::new() }; KINDS],
        }
    }
}

/// An input of the code.
#[derive(Clone, Copy)]
enum Source {
    /// The table at this place.
    Table(usize),
    /// The repeated constant at this place.
    Constant(usize),
}

/// The runs that an array of this length allows.
fn fitting(extent: Extent, length: usize) -> usize {
    match extent.step {
        0 => usize::MAX,
        _ if length < extent.size => 0,
        step => (length - extent.size) / step + 1,
    }
}

/// Computes a state of a chunk alone and replaces its outputs.
pub(crate) type Recompute<'r, T> = &'r (dyn Fn(&mut Chunk<T>, usize) -> Result<(), mozzi::Error> + Sync);

/// Computes a chunk's states; returns the errors of those that failed. Each input is the same in all states, or `None`:
/// the next table of the chunk.
pub(crate) fn run<T: Number>(
    code: &Code,
    given: &[Option<Vec<f64>>],
    recompute: Recompute<T>,
    worker: &mut Worker<T>,
    mut chunk: Chunk<T>,
) -> Vec<(usize, mozzi::Error)> {
    let (lanes, extents) = (code.kernel.shape().lanes(), code.kernel.extents());
    let sources = worker.prepare(code, given, chunk.states.div_ceil(lanes).min(RUNS));
    let sources = &sources[..code.inputs];
    // the runs for which what is read or written beyond the rows is in the tables, too
    let mut direct = chunk.states / lanes;
    for (source, &extent) in sources.iter().zip(extents) {
        if let Source::Table(k) = *source {
            let Table { numbers, width, .. } = chunk.inputs[k];
            direct = direct.min(fitting(extent, numbers.len() - chunk.first * width));
        }
    }
    for ((table, _), &extent) in chunk.outputs.iter().zip(&extents[code.inputs..]) {
        direct = direct.min(fitting(extent, table.len()));
    }
    let mut errors = Vec::new();
    let mut block = 0;
    while block < direct {
        let (runs, first) = (RUNS.min(direct - block), block * lanes);
        let mut inputs: [&[T]; MOST_ARRAYS] = [&[]; MOST_ARRAYS];
        for (place, source) in inputs.iter_mut().zip(sources) {
            *place = match *source {
                Source::Table(k) => &chunk.inputs[k].numbers[(chunk.first + first) * chunk.inputs[k].width..],
                Source::Constant(k) => &worker.constants[k],
            };
        }
        let mut outputs: [&mut [T]; MOST_TABLES + KINDS] = Default::default();
        for (place, (table, width)) in outputs.iter_mut().zip(&mut *chunk.outputs) {
            *place = &mut table[first * *width..];
        }
        call(code, runs, &inputs[..code.inputs], outputs, &mut worker.squares, &mut worker.pivots);
        worker.test(code, recompute, &mut chunk, first..first + runs * lanes, &mut errors);
        block += runs;
    }
    for first in (direct * lanes..chunk.states).step_by(lanes) {
        let rows = (chunk.states - first).min(lanes);
        worker.run_padded(code, sources, &mut chunk, first, rows);
        worker.test(code, recompute, &mut chunk, first..first + rows, &mut errors);
    }
    errors
}

/// Runs the code on these tables.
fn call<'t, T: Number>(
    code: &Code,
    runs: usize,
    inputs: &[&[T]],
    mut outputs: [&'t mut [T]; MOST_TABLES + KINDS],
    squares: &mut [T],
    pivots: &'t mut [Vec<T>; KINDS],
) {
    for (place, pivots) in outputs[code.own..].iter_mut().zip(pivots).take(code.kinds) {
        *place = pivots;
    }
    code.kernel.run(runs, inputs, &mut outputs[..code.own + code.kinds], squares);
}

impl<T: Number> Worker<T> {
    /// Where the code finds its inputs; constants are repeated for this many runs.
    fn prepare(&mut self, code: &Code, given: &[Option<Vec<f64>>], runs: usize) -> [Source; MOST_ARRAYS] {
        let (lanes, extents) = (code.kernel.shape().lanes(), code.kernel.extents());
        self.squares.resize(RUNS * lanes, T::zero());
        self.pivots.iter_mut().for_each(|pivots| pivots.resize(RUNS * 2 * lanes, T::zero()));
        let (mut sources, mut tables) = ([Source::Table(0); MOST_ARRAYS], 0);
        self.constants.resize(given.len(), Vec::new());
        for (k, (source, constant)) in sources.iter_mut().zip(given).enumerate() {
            *source = match constant {
                None => {
                    tables += 1;
                    Source::Table(tables - 1)
                }
                Some(numbers) => {
                    let (repeated, length) = (&mut self.constants[k], extents[k].of(runs));
                    repeated.clear();
                    repeated.extend(numbers.iter().map(|&x| T::from_f64(x)).cycle().take(length));
                    repeated.resize(length, T::zero());
                    Source::Constant(k)
                }
            };
        }
        sources
    }

    /// Computes at most a register of states, from `first` on, in tables that are long enough.
    fn run_padded(&mut self, code: &Code, sources: &[Source], chunk: &mut Chunk<T>, first: usize, rows: usize) {
        let (lanes, extents) = (code.kernel.shape().lanes(), code.kernel.extents());
        self.inputs.resize(sources.len(), Vec::new());
        for ((source, to), extent) in sources.iter().zip(&mut self.inputs).zip(extents) {
            let Source::Table(k) = *source else { continue };
            to.clear();
            (0..lanes)
                .for_each(|row| to.extend_from_slice(chunk.inputs[k].row(chunk.first + first + row.min(rows - 1))));
            to.resize(extent.size, T::zero());
        }
        self.outputs.resize(code.own, Vec::new());
        let own = &extents[code.inputs..][..code.own];
        self.outputs.iter_mut().zip(own).for_each(|(to, extent)| to.resize(extent.size, T::zero()));
        let mut inputs: [&[T]; MOST_ARRAYS] = [&[]; MOST_ARRAYS];
        for ((place, source), table) in inputs.iter_mut().zip(sources).zip(&self.inputs) {
            *place = match *source {
                Source::Table(_) => table,
                Source::Constant(k) => &self.constants[k],
            };
        }
        let mut outputs: [&mut [T]; MOST_TABLES + KINDS] = Default::default();
        outputs.iter_mut().zip(&mut self.outputs).for_each(|(place, table)| *place = table);
        call(code, 1, &inputs[..code.inputs], outputs, &mut self.squares, &mut self.pivots);
        for ((table, width), found) in chunk.outputs.iter_mut().zip(&self.outputs) {
            table[first * *width..][..rows * *width].copy_from_slice(&found[..rows * *width]);
        }
    }

    /// Computes those of these states alone whose angles were not reduced exactly or whose pivots are near rounding
    /// error.
    #[inline(always)]
    fn test(
        &self,
        code: &Code,
        recompute: Recompute<T>,
        chunk: &mut Chunk<T>,
        states: core::ops::Range<usize>,
        errors: &mut Vec<(usize, mozzi::Error)>,
    ) {
        let (lanes, limit) = (code.kernel.shape().lanes(), T::from_f64(code.kernel.angle_limit()));
        // without a branch for each state; a NaN is not sound
        let is_exact = |square: &T| *square <= limit;
        let mut are_sound = self.squares[..states.len()].iter().fold(true, |all, square| all & is_exact(square));
        for pivots in &self.pivots[..code.kinds] {
            let registers = pivots.chunks_exact(2 * lanes).take(states.len().div_ceil(lanes));
            for (least, sum) in registers.map(|register| register.split_at(lanes)) {
                are_sound &= least.iter().zip(sum).fold(true, |all, (&least, &sum)| all & least_is_clear(least, sum));
            }
        }
        if are_sound {
            return;
        }
        for (k, state) in states.enumerate() {
            let least = k / lanes * 2 * lanes + k % lanes;
            let pivots = |pivots: &Vec<T>| least_is_clear(pivots[least], pivots[least + lanes]);
            if is_exact(&self.squares[k]) && self.pivots[..code.kinds].iter().all(pivots) {
                continue;
            }
            if let Err(error) = recompute(chunk, state) {
                errors.push((chunk.first + state, error));
            }
        }
    }
}
