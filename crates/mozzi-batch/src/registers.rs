//! Kernels on registers: the table of functions, instantiated here once for each kind of registers.

use crate::Number;
use crate::chunk::Chunk;
use crate::lanes::{Lane, MOST};
use crate::request::Request;
use crate::worker::Worker;
use mozzi::quantities::{self, Call, Kernel, MOST_INPUTS, MOST_OUTPUTS, Memory, Quantity};
use mozzi::scalar::Bits;
use mozzi::{Environment, Model, Scalar, Vec3, Wrench, least_is_clear};

/// A chunk of states, on registers of one kind: the errors of its states.
pub(crate) type Entry<L> =
    fn(&Request<<L as Bits>::Number>, &Model<<L as Bits>::Number>, &mut Worker<L>, Chunk<<L as Bits>::Number>);

/// Does this quantity have a kernel on registers?
pub(crate) fn has_registers(index: usize) -> bool {
    macro_rules! answers {
        ($($Q:ident)*) => { &[$(<quantities::$Q as Quantity>::Registers::HAS_REGISTERS),*] };
    }
    const ANSWERS: &[bool] = mozzi::quantities!(answers);
    ANSWERS[index]
}

/// The states of a chunk by a kernel, inlined into an entry.
#[inline(always)]
pub(crate) fn run<K: Kernel, L: Lane>(
    request: &Request<L::Number>,
    model: &Model<L::Number>,
    worker: &mut Worker<L>,
    mut chunk: Chunk<L::Number>,
) where
    L::Number: Number,
{
    let Worker { memory, input, output, applied, errors, zeros, .. } = worker;
    let declaration = request.query.declaration();
    let number = |x: f64| L::from_f64(x);
    let given = &request.environment;
    applied.clear();
    applied.extend(given.applied.iter().map(|&(frame, F)| (frame, F.map(number))));
    applied.extend(request.wrenches.iter().map(|&(frame, _)| (frame, Wrench::zero())));
    let widths: [usize; MOST_INPUTS] =
        core::array::from_fn(|k| declaration.inputs.get(k).map_or(0, |_| chunk.inputs[k].1));
    input.resize(chunk.inputs.iter().map(|&(_, width)| width).sum(), L::zero());
    output.resize(chunk.outputs.iter().map(|&(_, width)| width).sum(), L::zero());
    zeros.resize(model.n(), L::zero());
    let own: usize = widths.iter().sum();
    let point = request.query.subject.point.map(number);
    let around = Environment {
        gravity: given.gravity.map(number),
        base_twist: given.base_twist.map(number),
        base_acceleration: given.base_acceleration.map(number),
        applied: &[],
    };

    for first in (0..chunk.states).step_by(L::WIDTH) {
        let rows = (chunk.states - first).min(L::WIDTH);
        chunk.read(first, rows, input);
        let (state, mut further) = input.split_at(own);
        let mut environment = around;
        if request.gravity.is_some() {
            let (gravity, wrenches) = further.split_at(3);
            (environment.gravity, further) = (Vec3([gravity[0], gravity[1], gravity[2]]), wrenches);
        }
        for (F, columns) in applied[given.applied.len()..].iter_mut().zip(further.as_chunks().0) {
            F.1 = Wrench::from_array(*columns);
        }
        let mut rest = state;
        let inputs: [&[L]; MOST_INPUTS] = core::array::from_fn(|k| match widths[k] {
            0 => &zeros[..],
            width => {
                let (this, further) = rest.split_at(width);
                rest = further;
                this
            }
        });
        let mut outputs: [&mut [L]; MOST_OUTPUTS] = Default::default();
        let mut rest = &mut output[..];
        for (place, &(_, width)) in outputs[declaration.first_output()..].iter_mut().zip(&chunk.outputs) {
            (*place, rest) = rest.split_at_mut(width);
        }
        let environment = &Environment { applied, ..environment };
        K::run(Call { of: &request.query.subject, model, point, inputs, environment, memory, outputs });
        chunk.write(first, rows, output);
        if declaration.divides {
            let unclear = unclear_rows(memory, rows);
            for row in (0..rows).filter(|row| unclear[*row]) {
                if let Err(error) = chunk.recheck(request, first + row, L::WIDTH, false) {
                    errors.push((chunk.first + first + row, error));
                }
            }
        }
    }
}

/// The states whose pivots do not pass the quick test.
#[inline(always)]
fn unclear_rows<L: Lane>(memory: &Memory<L>, rows: usize) -> [bool; MOST] {
    let mut unclear = [false; MOST];
    for pivots in memory.pivots() {
        let Some((&pivot, rest)) = pivots.split_first() else { continue };
        let (mut least, mut sum) = (pivot, pivot);
        for &pivot in rest {
            (least, sum) = (least.min(pivot), sum + pivot);
        }
        let mut numbers = [[L::Number::zero(); MOST]; 2];
        least.store(&mut numbers[0]);
        sum.store(&mut numbers[1]);
        for row in 0..rows {
            unclear[row] |= !least_is_clear(numbers[0][row], numbers[1][row]);
        }
    }
    unclear
}
