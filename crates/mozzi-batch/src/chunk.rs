//! Some states on one thread: rows into registers, the kernel, registers into rows.

use crate::columns::{Layout, read_block, read_rows, write_block, write_rows};
use crate::lanes::{Lane, MOST};
use crate::quantity::{Memory, Quantity};
use mozzi::scalar::Float;
use mozzi::{Environment, FrameId, Model, Scalar, Wrench};

/// A table of this thread's states, and its numbers a state.
pub(crate) type Table<'a, T> = (&'a [T], usize);
pub(crate) type TableMut<'a, T> = (&'a mut [T], usize);

/// This thread's states.
pub(crate) struct Chunk<'a, T> {
    /// The number of the first.
    pub first: usize,
    pub states: usize,
    pub layout: Layout,
    /// The quantity's inputs, then the wrenches of each of `frames`.
    pub inputs: Vec<Table<'a, T>>,
    pub outputs: Vec<TableMut<'a, T>>,
    pub environment: &'a Environment<'a>,
    /// Frames with a wrench of their own in every state.
    pub frames: &'a [FrameId],
}

/// One thread's memory.
pub(crate) struct Worker<L: Lane> {
    memory: Memory<L>,
    input: Vec<L>,
    output: Vec<L>,
    applied: Vec<(FrameId, Wrench<L>)>,
    /// States whose pivots spread so far that the mass matrix may be singular.
    pub suspects: Vec<usize>,
}

impl<L: Lane> Worker<L> {
    pub fn new(model: &Model<L::Number>) -> Self {
        let memory = Memory::new(model);
        Worker { memory, input: Vec::new(), output: Vec::new(), applied: Vec::new(), suspects: Vec::new() }
    }

    #[inline(always)]
    pub fn run<Q: Quantity>(&mut self, q: &Q, model: &Model<L::Number>, mut chunk: Chunk<L::Number>) {
        let Worker { memory, input, output, applied, suspects } = self;
        let number = |x: f64| L::from_f64(x);
        let given = chunk.environment;
        applied.clear();
        applied.extend(given.applied.iter().map(|&(frame, F)| (frame, F.map(number))));
        applied.extend(chunk.frames.iter().map(|&frame| (frame, Wrench::zero())));
        input.resize(chunk.inputs.iter().map(|&(_, width)| width).sum(), L::zero());
        output.resize(chunk.outputs.iter().map(|&(_, width)| width).sum(), L::zero());
        let own = input.len() - 6 * chunk.frames.len();
        let around = Environment {
            gravity: given.gravity.map(number),
            base_twist: given.base_twist.map(number),
            base_acceleration: given.base_acceleration.map(number),
            applied: &[],
        };

        for block in 0..chunk.states.div_ceil(L::WIDTH) {
            let first = block * L::WIDTH;
            let rows = (chunk.states - first).min(L::WIDTH);
            let mut rest = &mut input[..];
            for &(table, width) in &chunk.inputs {
                let (columns, further) = rest.split_at_mut(width);
                match chunk.layout {
                    Layout::Rows => read_rows(table, first, rows, columns),
                    Layout::Blocks => read_block(table, block, columns),
                }
                rest = further;
            }
            for (F, columns) in applied[given.applied.len()..].iter_mut().zip(input[own..].as_chunks().0) {
                F.1 = Wrench::from_array(*columns);
            }
            q.evaluate(model, &input[..own], &Environment { applied, ..around }, memory, output);
            if Q::PIVOTS {
                look_at_pivots(memory.workspace.pivots(), chunk.first + first, rows, suspects);
                if let Some((_, task)) = &memory.task {
                    look_at_pivots(&task.pivots, chunk.first + first, rows, suspects);
                }
            }
            let mut rest = &output[..];
            for (table, width) in &mut chunk.outputs {
                let (columns, further) = rest.split_at(*width);
                match chunk.layout {
                    Layout::Rows => write_rows(table, first, rows, columns),
                    Layout::Blocks => write_block(table, block, columns),
                }
                rest = further;
            }
        }
    }
}

/// Notes the states whose smallest pivot is below √ε of the largest: they are computed again, by the method that names the
/// joint if it is one.
#[inline(always)]
fn look_at_pivots<L: Lane>(pivots: &[L], first: usize, rows: usize, suspects: &mut Vec<usize>) {
    let Some((&pivot, rest)) = pivots.split_first() else { return };
    let (mut least, mut most) = (pivot, pivot);
    for &pivot in rest {
        (least, most) = (least.min(pivot), most.max(pivot));
    }
    let mut margin = [L::Number::zero(); MOST];
    (least - L::constant(L::Number::EPSILON.sqrt()) * most).store(&mut margin);
    for (row, &margin) in margin[..rows].iter().enumerate() {
        if !(margin > L::Number::zero()) {
            suspects.push(first + row);
        }
    }
}
