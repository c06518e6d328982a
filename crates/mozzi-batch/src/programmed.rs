//! Many states by a recorded program: as machine code, or by an interpreter.

use crate::chunk::Chunk;
use crate::interpreter::Interpreter;
use crate::lanes::Lane;
use crate::request::Request;
use crate::worker::Worker;
use crate::{InstructionSet, Number};
use mozzi::quantities::Query;
use mozzi::{Error, FrameId, Model, TaskFrame, least_is_clear};
use mozzi_codegen::{Arguments, Kernel, Refusal, Shape, pivot_names, record_quantity};
use std::sync::{Arc, Mutex, PoisonError};

/// A quantity's program for blocks of states.
#[derive(Debug)]
pub struct Programmed {
    /// The program's inputs and outputs, the pivots of each kind as two numbers.
    inputs: Vec<usize>,
    outputs: Vec<usize>,
    /// How many outputs are the quantity's own.
    own: usize,
    pub code: Result<Kernel, Refusal>,
    interpreter: Interpreter,
}

impl Programmed {
    pub fn new<T: Number>(
        model: &Model,
        query: Query,
        arguments: Arguments,
        set: InstructionSet,
    ) -> Result<Self, Error> {
        let program = record_quantity(model, query, arguments)?;
        let own = program.outputs().len() - pivot_names(&query).len();
        let code = match shape::<T>(set) {
            Some(shape) => Kernel::condensing(&program, shape, own),
            None => Err(Refusal::Processor),
        };
        let inputs = program.inputs().iter().map(|input| input.length).collect();
        let mut outputs: Vec<usize> = program.outputs().iter().map(|output| output.values.len()).collect();
        outputs[own..].fill(2);
        Ok(Programmed { inputs, outputs, own, code, interpreter: Interpreter::new(&program, own) })
    }
}

/// Machine code for the registers of this kind.
fn shape<T: Number>(set: InstructionSet) -> Option<Shape> {
    match (set, size_of::<T>()) {
        (InstructionSet::Avx512, 8) => Some(Shape::EightF64),
        (InstructionSet::Avx512, _) => Some(Shape::SixteenF32),
        (InstructionSet::Avx2, 8) => Some(Shape::FourF64),
        (InstructionSet::Avx2, _) => Some(Shape::EightF32),
        (InstructionSet::Portable, _) => None,
    }
}

/// A program, and the numbers of its inputs after the state that are the same in all states.
pub type ProgramCall<'p> = (&'p Programmed, &'p [Option<Vec<f64>>]);

/// The most arrays of a program.
const MOST_ARRAYS: usize = 12;

/// The states of a chunk, inlined into an entry.
#[inline(always)]
pub(crate) fn run<L: Lane>(
    (programmed, constants): ProgramCall,
    request: &Request<L::Number>,
    worker: &mut Worker<L>,
    mut chunk: Chunk<L::Number>,
) where
    L::Number: Number,
{
    let Programmed { inputs, outputs, own, code, interpreter } = programmed;
    // registers a block: one for machine code, those of 32 states for the interpreter
    let abreast = if code.is_ok() { 1 } else { 32 / L::WIDTH };
    let (all_in, all_out): (usize, usize) = (inputs.iter().sum(), outputs.iter().sum());
    let Worker { input, output, values, errors, read, written, .. } = worker;
    input.resize((all_in * abreast).max(1), L::zero());
    output.resize((all_out * abreast).max(1), L::zero());
    read.resize(chunk.inputs.iter().map(|&(_, width)| width).sum(), L::zero());
    written.resize(chunk.outputs.iter().map(|&(_, width)| width).sum(), L::zero());
    let (state, own_columns) = (inputs.len() - constants.len(), written.len());
    // what is the same in all states, once
    let mut place = 0;
    for (k, &width) in inputs.iter().enumerate() {
        if let Some(Some(numbers)) = k.checked_sub(state).map(|k| &constants[k]) {
            for (column, &x) in numbers.iter().enumerate() {
                input[(place + column) * abreast..][..abreast].fill(L::from_f64(x));
            }
        }
        place += width;
    }
    for block in (0..chunk.states).step_by(abreast * L::WIDTH) {
        for r in 0..abreast {
            let first = block + r * L::WIDTH;
            if first >= chunk.states {
                break;
            }
            chunk.read(first, (chunk.states - first).min(L::WIDTH), read);
            let (mut from, mut place) = (0, 0);
            for (k, &width) in inputs.iter().enumerate() {
                if k.checked_sub(state).is_none_or(|k| constants[k].is_none()) {
                    for column in 0..width {
                        input[(place + column) * abreast + r] = read[from + column];
                    }
                    from += width;
                }
                place += width;
            }
        }
        let mut squares = [L::zero(); 1];
        match code {
            Ok(kernel) => {
                let (mut given, mut found): ([&[L::Number]; MOST_ARRAYS], [&mut [L::Number]; MOST_ARRAYS]) =
                    Default::default();
                let mut rest = &input[..];
                for (slice, &width) in given.iter_mut().zip(inputs) {
                    let (this, further) = rest.split_at(width);
                    (*slice, rest) = (L::numbers(this), further);
                }
                let mut rest = &mut output[..];
                for (slice, &width) in found.iter_mut().zip(outputs) {
                    let (this, further) = rest.split_at_mut(width);
                    (*slice, rest) = (L::numbers_mut(this), further);
                }
                let squares = L::numbers_mut(&mut squares);
                kernel.call(&given[..inputs.len()], &mut found[..outputs.len()], squares);
            }
            Err(_) => interpreter.run(abreast, input, values, output),
        }
        for r in 0..abreast {
            let first = block + r * L::WIDTH;
            if first >= chunk.states {
                break;
            }
            let rows = (chunk.states - first).min(L::WIDTH);
            for (column, written) in written.iter_mut().enumerate() {
                *written = output[column * abreast + r];
            }
            chunk.write(first, rows, written);
            for row in 0..rows {
                let number = |column: usize| L::numbers(&output[column * abreast + r..][..1])[row];
                let is_exact = match code {
                    Ok(kernel) => kernel.is_exact(L::numbers(&squares)[row]),
                    Err(_) => true,
                };
                let pivots = (0..outputs.len() - own).map(|k| own_columns + 2 * k);
                let are_clear = pivots.fold(true, |clear, k| clear & least_is_clear(number(k), number(k + 1)));
                if !(is_exact && are_clear) {
                    if let Err(error) = chunk.recheck(request, first + row, L::WIDTH, true) {
                        errors.push((chunk.first + first + row, error));
                    }
                }
            }
        }
    }
}

/// The program of each quantity that was asked for, with what it is of and its arguments. Clones share it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Cache(Arc<Mutex<Vec<(Key, Arc<Programmed>)>>>);

/// So many programs are kept.
const KEPT: usize = 64;

/// Which program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Key {
    index: usize,
    frame: Option<FrameId>,
    coordinates: TaskFrame,
    rows: Vec<usize>,
    arguments: [bool; 5],
    frames: Vec<FrameId>,
}

impl Key {
    pub fn new(query: Query, arguments: Arguments) -> Self {
        let subject = query.subject;
        let Arguments { parameters, gravity, base_twist, base_acceleration, about, wrenches } = arguments;
        Key {
            index: query.index(),
            frame: subject.frame,
            coordinates: subject.coordinates,
            rows: subject.rows.to_vec(),
            arguments: [parameters, gravity, base_twist, base_acceleration, about],
            frames: wrenches.to_vec(),
        }
    }
}

impl Cache {
    /// The same programs, in a list of its own.
    pub fn copy(&self) -> Self {
        let list = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        Cache(Arc::new(Mutex::new(list.clone())))
    }

    pub fn get(&self, key: &Key) -> Option<Arc<Programmed>> {
        let list = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        list.iter().find(|(known, _)| known == key).map(|(_, programmed)| programmed.clone())
    }

    /// The program, made if there is none.
    pub fn get_or_make(
        &self,
        key: Key,
        make: impl FnOnce() -> Result<Programmed, Error>,
    ) -> Result<Arc<Programmed>, Error> {
        if let Some(programmed) = self.get(&key) {
            return Ok(programmed);
        }
        let programmed = Arc::new(make()?);
        let mut list = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if list.len() == KEPT {
            list.remove(0);
        }
        list.push((key, programmed.clone()));
        Ok(programmed)
    }
}
