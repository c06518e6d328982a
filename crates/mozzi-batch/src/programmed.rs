//! Many states by a recorded program: as machine code or by the interpreter.

use crate::chunk::Chunk;
use crate::columns::Layout;
use crate::in_place;
use crate::interpreter::Interpreter;
use crate::lanes::{Lane, MOST};
use crate::request::Request;
use crate::worker::Worker;
use crate::{InstructionSet, Number};
use mozzi::model::clearance;
use mozzi::quantities::Query;
use mozzi::scalar::Float;
use mozzi::{Error, FrameId, Model, Scalar, TaskFrame};
use mozzi_codegen::{Arguments, Form, Kernel, Program, Refusal, Shape, pivot_names, record_quantity};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// A quantity's program for registers of states. Machine code is made when it is first needed.
#[derive(Debug)]
pub struct Programmed {
    program: Program,
    /// The program's inputs and outputs; each kind of pivots is condensed to two numbers.
    pub inputs: Vec<usize>,
    outputs: Vec<usize>,
    /// The number of the quantity's own inputs.
    of_state: usize,
    /// The number of the quantity's own outputs.
    pub own: usize,
    shape: Option<Shape>,
    by_blocks: OnceLock<Code>,
    by_rows: OnceLock<Code>,
    interpreter: OnceLock<Interpreter>,
}

type Code = Result<Arc<Kernel>, Refusal>;

impl Programmed {
    pub fn new<T: Number>(
        model: &Model,
        query: Query,
        arguments: Arguments,
        set: InstructionSet,
    ) -> Result<Self, Error> {
        let program = record_quantity(model, query, arguments)?;
        let own = program.outputs().len() - pivot_names(&query).len();
        let inputs = program.inputs().iter().map(|input| input.length).collect();
        let mut outputs: Vec<usize> = program.outputs().iter().map(|output| output.values.len()).collect();
        outputs[own..].fill(2);
        let (by_blocks, by_rows, interpreter) = (OnceLock::new(), OnceLock::new(), OnceLock::new());
        let shape = shape::<T>(set);
        let of_state = query.declaration().inputs.len();
        Ok(Programmed { program, inputs, outputs, of_state, own, shape, by_blocks, by_rows, interpreter })
    }

    /// The number of the kinds of pivots.
    pub fn kinds(&self) -> usize {
        self.outputs.len() - self.own
    }

    /// The machine code for tables of this layout. Values that are the same in all states are given in blocks.
    pub fn code(&self, layout: Layout, constants: &[Option<Vec<f64>>]) -> &Code {
        self.code_in(layout, constants.iter().any(Option::is_some))
    }

    /// The machine code for the robot's own environment, where only a point is the same in all states.
    pub fn code_of_own(&self, layout: Layout) -> &Code {
        self.code_in(layout, self.inputs.len() > self.of_state)
    }

    fn code_in(&self, layout: Layout, has_constants: bool) -> &Code {
        let (code, form) = match layout {
            Layout::Rows if !has_constants => (&self.by_rows, Form::Rows),
            _ => (&self.by_blocks, Form::Blocks),
        };
        code.get_or_init(|| match self.shape {
            Some(shape) => Kernel::shared(&self.program, shape, form, self.own),
            None => Err(Refusal::Processor),
        })
    }

    fn interpreter(&self) -> &Interpreter {
        self.interpreter.get_or_init(|| Interpreter::new(&self.program, self.own))
    }
}

/// Machine code for the registers of this kind.
fn shape<T: Number>(set: InstructionSet) -> Option<Shape> {
    match (set, size_of::<T>()) {
        (InstructionSet::Avx512, 8) => Some(Shape::EightF64),
        (InstructionSet::Avx512, _) => Some(Shape::SixteenF32),
        (InstructionSet::Avx2, 8) => Some(Shape::FourF64),
        (InstructionSet::Avx2, _) => Some(Shape::EightF32),
        (InstructionSet::Portable | InstructionSet::Neon, _) => None,
    }
}

/// A program, and the values of its inputs that are the same in all states.
pub type ProgramCall<'p> = (&'p Programmed, &'p [Option<Vec<f64>>]);

/// Computes the states of a chunk; inlined into an entry.
#[inline(always)]
pub(crate) fn run<L: Lane>(
    (programmed, constants): ProgramCall,
    request: &Request<L::Number>,
    worker: &mut Worker<L>,
    mut chunk: Chunk<L::Number>,
) where
    L::Number: Number,
{
    let code = programmed.code(chunk.layout, constants);
    if let (Ok(kernel), true) = (code, constants.iter().all(Option::is_none)) {
        return in_place::run(programmed, kernel, request, worker, chunk);
    }
    let Programmed { inputs, outputs, own, .. } = programmed;
    // registers side by side in a column: one for machine code, those of 32 states for the interpreter
    let abreast = if code.is_ok() { 1 } else { 32 / L::WIDTH };
    let Worker { input, output, values, errors, scratch, .. } = worker;
    input.resize(inputs.iter().sum::<usize>() * abreast, L::zero());
    output.resize(outputs.iter().sum::<usize>() * abreast, L::zero());
    let own_columns: usize = chunk.outputs.iter().map(|&(_, width)| width).sum();
    // the first input column of each table; values that are the same in all states are written once
    let (mut places, mut place) = (Vec::with_capacity(chunk.inputs.len()), 0);
    for (k, &width) in inputs.iter().enumerate() {
        match k.checked_sub(inputs.len() - constants.len()).and_then(|k| constants[k].as_ref()) {
            Some(numbers) => {
                let columns = input[place * abreast..].chunks_exact_mut(abreast);
                columns.zip(numbers).for_each(|(column, &x)| column.fill(L::from_f64(x)));
            }
            None => places.push(place..place + width),
        }
        place += width;
    }
    scratch.resize(own_columns.max(inputs.iter().copied().max().unwrap_or(0)), L::zero());

    let all = chunk.states;
    for block in (0..all).step_by(abreast * L::WIDTH) {
        let registers = (all - block).div_ceil(L::WIDTH).min(abreast);
        let states = |r: usize| (block + r * L::WIDTH, (all - block - r * L::WIDTH).min(L::WIDTH));
        let mut squares = [L::zero()];
        match code {
            Ok(kernel) => {
                for (k, place) in places.iter().enumerate() {
                    chunk.read_input(k, block, states(0).1, &mut input[place.clone()]);
                }
                kernel.call_joined(L::numbers(input), L::numbers_mut(output), L::numbers_mut(&mut squares));
            }
            Err(_) => {
                for r in 0..registers {
                    for (k, place) in places.iter().enumerate() {
                        let columns = &mut scratch[..place.len()];
                        chunk.read_input(k, states(r).0, states(r).1, columns);
                        let to = input[place.start * abreast..].chunks_exact_mut(abreast);
                        to.zip(columns).for_each(|(to, &mut from)| to[r] = from);
                    }
                }
                programmed.interpreter().run(abreast, input, values, output);
            }
        }
        for r in 0..registers {
            let (first, rows) = states(r);
            if abreast == 1 {
                chunk.write(first, rows, &output[..own_columns]);
            } else {
                let columns = &mut scratch[..own_columns];
                columns.iter_mut().zip(output.chunks_exact(abreast)).for_each(|(to, from)| *to = from[r]);
                chunk.write(first, rows, columns);
            }
            // quick test for all states at once: all angles are reduced exactly, and pivots are clear
            let limit = L::Number::from_f64(code.as_ref().map_or(f64::INFINITY, |kernel| kernel.angle_limit()));
            let mut clear = None;
            for kind in 0..outputs.len() - own {
                let least = (own_columns + 2 * kind) * abreast + r;
                // a NaN is kept as in `registers::clearances`
                let this = clearance(output[least], output[least + abreast], L::Number::EPSILON);
                clear = Some(clear.map_or(this, |clear: L| clear.min(this)));
            }
            if !are_sound(squares[0], limit, clear) {
                recheck(squares[0], limit, clear, request, &mut chunk, (first, rows), errors);
            }
        }
    }
}

/// True if all angles are reduced exactly and all pivots are clear, in every lane.
#[inline(always)]
pub(crate) fn are_sound<L: Lane>(squares: L, limit: L::Number, clear: Option<L>) -> bool
where
    L::Number: Number,
{
    let mut clearances = [L::Number::one(); MOST];
    if let Some(clear) = clear {
        clear.store(&mut clearances);
    }
    squares.within(limit) && (clear.is_none() || clearances[..L::WIDTH].iter().all(|&x| x > L::Number::zero()))
}

/// Computes the states, those of `rows` lanes from the chunk's `first` on, that are not sound by themselves.
#[cold]
#[inline(never)]
pub(crate) fn recheck<L: Lane>(
    squares: L,
    limit: L::Number,
    clear: Option<L>,
    request: &Request<L::Number>,
    chunk: &mut Chunk<L::Number>,
    (first, rows): (usize, usize),
    errors: &mut Vec<(usize, Error)>,
) where
    L::Number: Number,
{
    let clear = [clear.unwrap_or(L::one())];
    for row in 0..rows {
        let passes = L::numbers(&[squares])[row] <= limit && L::numbers(&clear)[row] > L::Number::zero();
        if passes {
            continue;
        }
        if let Err(error) = chunk.recheck(request, first + row, L::WIDTH, true) {
            errors.push((chunk.first + first + row, error));
        }
    }
}

/// Programs, each with its key.
pub(crate) type Programs = Vec<(Key, Arc<Programmed>)>;

/// The program of this query with these arguments.
pub(crate) fn find<'p>(programs: &'p Programs, query: &Query, arguments: &Arguments) -> Option<&'p Arc<Programmed>> {
    programs.iter().find(|(key, _)| key.is_of(query, arguments)).map(|(_, programmed)| programmed)
}

/// The programs of earlier calls: the latest [`KEPT`]. Clones share them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Cache(Arc<Mutex<Programs>>);

/// The number of programs that are kept.
const KEPT: usize = 64;

/// Identifies a program.
#[derive(Clone, Debug)]
pub(crate) struct Key {
    index: usize,
    frame: Option<FrameId>,
    coordinates: TaskFrame,
    rows: Vec<usize>,
    arguments: Arguments<'static>,
    frames: Vec<FrameId>,
}

impl Key {
    pub fn new(query: &Query, arguments: &Arguments) -> Self {
        let subject = query.subject;
        Key {
            index: query.index(),
            frame: subject.frame,
            coordinates: subject.coordinates,
            rows: subject.rows.to_vec(),
            arguments: Arguments { wrenches: &[], ..*arguments },
            frames: arguments.wrenches.to_vec(),
        }
    }

    fn is_of(&self, query: &Query, arguments: &Arguments) -> bool {
        let subject = &query.subject;
        self.index == query.index()
            && (self.frame, self.coordinates) == (subject.frame, subject.coordinates)
            && self.rows == subject.rows
            && self.frames == arguments.wrenches
            && self.arguments == Arguments { wrenches: &[], ..*arguments }
    }
}

impl Cache {
    /// The program; it is made if there is none.
    pub fn get_or_make(
        &self,
        query: &Query,
        arguments: &Arguments,
        make: impl FnOnce() -> Result<Programmed, Error>,
    ) -> Result<Arc<Programmed>, Error> {
        let list = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(programmed) = find(&list(), query, arguments) {
            return Ok(programmed.clone());
        }
        let programmed = Arc::new(make()?);
        let mut list = list();
        if list.len() == KEPT {
            list.remove(0);
        }
        list.push((Key::new(query, arguments), programmed.clone()));
        Ok(programmed)
    }
}
