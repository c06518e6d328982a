//! How rows get from global memory to a thread and back.

use super::super::Precision;
use super::kernels::CudaLayout;
use super::parts::{self, parts};
use crate::program::{Output, Program, Step, Value};
use std::collections::BTreeMap;

/// Shared memory that a kernel may have without asking the driver for more.
const SHARED_BYTES: usize = 48 * 1024;

/// Threads of a block by columns, few: the next block begins when all warps of one have ended.
pub(super) const BY_COLUMNS: usize = 64;

/// The block of a kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Block {
    /// The largest number of threads, a multiple of 32; smaller multiples of 32 are allowed.
    pub threads: usize,
    /// Bytes of shared memory, through which rows pass.
    pub shared_bytes: usize,
    /// States that a thread computes together if there are many: more than one if the program is in parts.
    pub states: usize,
}

impl Block {
    /// The block of a program's kernel.
    pub fn of(program: &Program, layout: CudaLayout, precision: Precision) -> Block {
        match layout {
            CudaLayout::Rows => plan(program, precision).0,
            CudaLayout::Columns => {
                let states = if parts(program).is_some() { parts::STATES } else { 1 };
                Block { threads: BY_COLUMNS, shared_bytes: 0, states }
            }
        }
    }
}

/// How the rows of an array pass between global memory and a thread.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Staging {
    /// They are read and written where they are.
    InPlace,
    /// Through shared memory, as they lie.
    Whole,
    /// Through shared memory, where only different numbers are.
    Slots(Slots),
}

/// The numbers of a result that differ: of a symmetric matrix those of a half, of a sparse one those not 0.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Slots {
    /// That of each entry; none if it is 0.
    pub of: Vec<Option<usize>>,
    pub count: usize,
}

impl Slots {
    /// None unless they save a quarter.
    fn new(program: &Program, output: &Output) -> Option<Slots> {
        let mut known: BTreeMap<Value, usize> = BTreeMap::new();
        let slot = |value: &Value| {
            if matches!(program.steps[*value as usize], Step::Constant(x) if x == 0.0) {
                return None;
            }
            let next = known.len();
            Some(*known.entry(*value).or_insert(next))
        };
        let of: Vec<Option<usize>> = output.values.iter().map(slot).collect();
        let count = known.len();
        (4 * count <= 3 * of.len()).then_some(Slots { of, count })
    }

    /// Whether this entry is the one that stores its slot.
    pub fn is_first(&self, entry: usize) -> bool {
        self.of[entry].is_some() && !self.of[..entry].contains(&self.of[entry])
    }
}

impl Staging {
    /// Numbers of shared memory for the row of a thread.
    pub fn width(&self, length: usize) -> usize {
        match self {
            Staging::InPlace => 0,
            Staging::Whole => padded(length),
            Staging::Slots(slots) => padded(slots.count),
        }
    }
}

/// An odd number of entries: 32 rows then begin in 32 banks.
fn padded(length: usize) -> usize {
    length | 1
}

/// By rows: the block, and the staging of each input, then of each output. Rows that do not fit into shared memory with
/// 32 threads get slots if they are results, and are read and written in place if that is not enough, the
/// longest first.
pub(super) fn plan(program: &Program, precision: Precision) -> (Block, Vec<Staging>) {
    let is_read = |k: usize| program.steps.iter().any(|step| matches!(step, Step::Input(a, _) if *a as usize == k));
    let inputs = program.inputs.iter().enumerate().map(|(k, x)| if is_read(k) { x.length } else { 0 });
    let lengths: Vec<usize> = inputs.chain(program.outputs.iter().map(|output| output.values.len())).collect();
    let whole = |&n: &usize| if n > 1 { Staging::Whole } else { Staging::InPlace };
    let mut staging: Vec<Staging> = lengths.iter().map(whole).collect();
    let block = |staging: &[Staging]| {
        let row = staging.iter().zip(&lengths).map(|(staging, &n)| staging.width(n)).sum::<usize>();
        let of_thread = row * if precision.is_f64() { 8 } else { 4 };
        let threads = [128, 64, 32].into_iter().find(|threads| threads * of_thread <= SHARED_BYTES);
        threads.map(|threads| Block { threads, shared_bytes: threads * of_thread, states: 1 })
    };
    if block(&staging).is_none() {
        for (staging, output) in staging[program.inputs.len()..].iter_mut().zip(&program.outputs) {
            if let Some(slots) = Slots::new(program, output) {
                *staging = Staging::Slots(slots);
            }
        }
    }
    loop {
        if let Some(block) = block(&staging) {
            return (block, staging);
        }
        let longest = (0..staging.len()).rev().max_by_key(|&k| staging[k].width(lengths[k]));
        longest.into_iter().for_each(|k| staging[k] = Staging::InPlace);
    }
}
