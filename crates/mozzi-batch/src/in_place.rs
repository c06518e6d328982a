//! Many states by machine code that reads and writes the tables itself, in rows or in blocks.

use crate::Number;
use crate::chunk::Chunk;
use crate::lanes::Lane;
use crate::programmed::{Programmed, are_sound, recheck};
use crate::request::Request;
use crate::worker::Worker;
use mozzi::Scalar;
use mozzi::model::clearance;
use mozzi::quantities::MOST_OUTPUTS;
use mozzi::scalar::Float;
use mozzi_codegen::{Extent, Kernel, MOST_ARRAYS};

/// Registers of states in a call of the code; then their angles and pivots are tested.
const RUNS: usize = 16;

/// The most kinds of pivots: of the mass matrix, of a task.
const KINDS: usize = 2;

/// The runs that an array of this length allows.
fn fitting(extent: Extent, length: usize) -> usize {
    match extent.step {
        0 => usize::MAX,
        _ if length < extent.size => 0,
        step => (length - extent.size) / step + 1,
    }
}

/// The squares of the angles, then the least pivot and their sum, of each kind, for each run.
struct Tests<'t, L> {
    squares: &'t mut [L],
    pivots: [&'t mut [L]; KINDS],
}

impl<'t, L: Lane> Tests<'t, L> {
    #[inline(always)]
    fn new(memory: &'t mut Vec<L>) -> Self {
        memory.resize(RUNS * (1 + 2 * KINDS), L::zero());
        let (squares, pivots) = memory.split_at_mut(RUNS);
        let (first, second) = pivots.split_at_mut(2 * RUNS);
        Tests { squares, pivots: [first, second] }
    }
}

/// Computes the states of a chunk; inlined into an entry.
#[inline(always)]
pub(crate) fn run<L: Lane>(
    programmed: &Programmed,
    kernel: &Kernel,
    request: &Request<L::Number>,
    worker: &mut Worker<L>,
    mut chunk: Chunk<L::Number>,
) where
    L::Number: Number,
{
    let (extents, inputs, own) = (kernel.extents(), programmed.inputs.len(), programmed.own);
    let Worker { input, output, scratch, errors, .. } = worker;
    let mut tests = Tests::new(scratch);
    // as far as what is read or written beyond the rows is in the tables, too; of blocks, all
    let mut direct = chunk.states / L::WIDTH;
    for (table, &extent) in chunk.inputs.iter().zip(extents) {
        direct = direct.min(fitting(extent, table.numbers.len() - chunk.first * table.width));
    }
    for ((table, _), &extent) in chunk.outputs.iter().zip(&extents[inputs..]) {
        direct = direct.min(fitting(extent, table.len()));
    }
    let mut block = 0;
    while block < direct {
        let (runs, first) = (RUNS.min(direct - block), block * L::WIDTH);
        let mut tables: [&[L::Number]; MOST_ARRAYS] = [&[]; MOST_ARRAYS];
        for (place, table) in tables.iter_mut().zip(chunk.inputs) {
            *place = &table.numbers[(chunk.first + first) * table.width..];
        }
        let mut found: [&mut [L::Number]; MOST_OUTPUTS + KINDS] = Default::default();
        for (place, (table, width)) in found.iter_mut().zip(&mut *chunk.outputs) {
            *place = &mut table[first * *width..];
        }
        call(programmed, kernel, runs, &tables[..inputs], found, &mut tests);
        for run in 0..runs {
            test(programmed, kernel, request, run, &tests, &mut chunk, (first + run * L::WIDTH, L::WIDTH), errors);
        }
        block += runs;
    }
    // the last rows in tables that are long enough
    let mut first = direct * L::WIDTH;
    while first < chunk.states {
        let rows = (chunk.states - first).min(L::WIDTH);
        let padded = |extent: &Extent| extent.size.next_multiple_of(L::WIDTH);
        input.resize(extents[..inputs].iter().map(padded).sum::<usize>() / L::WIDTH, L::zero());
        output.resize(extents[inputs..][..own].iter().map(padded).sum::<usize>() / L::WIDTH, L::zero());
        let mut rest = L::numbers_mut(input);
        let mut tables: [&[L::Number]; MOST_ARRAYS] = [&[]; MOST_ARRAYS];
        for ((place, table), extent) in tables.iter_mut().zip(chunk.inputs).zip(extents) {
            let (own, further) = rest.split_at_mut(padded(extent));
            for (row, to) in own.chunks_exact_mut(table.width.max(1)).take(L::WIDTH).enumerate() {
                let from = (chunk.first + first + row.min(rows - 1)) * table.width;
                to[..table.width].copy_from_slice(&table.numbers[from..][..table.width]);
            }
            (*place, rest) = (own, further);
        }
        let mut rest = L::numbers_mut(output);
        let mut found: [&mut [L::Number]; MOST_OUTPUTS + KINDS] = Default::default();
        for (place, extent) in found.iter_mut().zip(&extents[inputs..][..own]) {
            let (own, further) = rest.split_at_mut(padded(extent));
            (*place, rest) = (own, further);
        }
        call(programmed, kernel, 1, &tables[..inputs], found, &mut tests);
        let mut rest = L::numbers(output);
        for ((table, width), extent) in chunk.outputs.iter_mut().zip(&extents[inputs..]) {
            let (own, further) = rest.split_at(padded(extent));
            table[first * *width..][..rows * *width].copy_from_slice(&own[..rows * *width]);
            rest = further;
        }
        test(programmed, kernel, request, 0, &tests, &mut chunk, (first, rows), errors);
        first += rows;
    }
}

/// Runs the code on these tables.
#[inline(always)]
fn call<'t, L: Lane>(
    programmed: &Programmed,
    kernel: &Kernel,
    runs: usize,
    tables: &[&[L::Number]],
    mut found: [&'t mut [L::Number]; MOST_OUTPUTS + KINDS],
    tests: &'t mut Tests<L>,
) {
    let (own, kinds) = (programmed.own, programmed.kinds());
    let [a, b] = &mut tests.pivots;
    if kinds > 0 {
        found[own] = L::numbers_mut(a);
    }
    if kinds > 1 {
        found[own + 1] = L::numbers_mut(b);
    }
    kernel.run(runs, tables, &mut found[..own + kinds], L::numbers_mut(tests.squares));
}

/// Tests the states of a run, and computes those that fail by themselves.
#[inline(always)]
#[allow(clippy::too_many_arguments)]
fn test<L: Lane>(
    programmed: &Programmed,
    kernel: &Kernel,
    request: &Request<L::Number>,
    run: usize,
    tests: &Tests<L>,
    chunk: &mut Chunk<L::Number>,
    (first, rows): (usize, usize),
    errors: &mut Vec<(usize, mozzi::Error)>,
) where
    L::Number: Number,
{
    let mut clear = None;
    for pivots in &tests.pivots[..programmed.kinds()] {
        // a NaN is kept as in `registers::clearances`
        let this = clearance(pivots[2 * run], pivots[2 * run + 1], L::Number::EPSILON);
        clear = Some(clear.map_or(this, |clear: L| clear.min(this)));
    }
    let (squares, limit) = (tests.squares[run], L::Number::from_f64(kernel.angle_limit()));
    if !are_sound(squares, limit, clear) {
        recheck(squares, limit, clear, request, chunk, (first, rows), errors);
    }
}
