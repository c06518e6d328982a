//! Kernels on registers: the table of functions, instantiated here once for each kind of registers.

use crate::Number;
use crate::chunk::Chunk;
use crate::lanes::{Lane, MOST};
use crate::request::Request;
use crate::worker::Worker;
use mozzi::model::clearance;
use mozzi::quantities::{self, Call, Kernel, MOST_INPUTS, MOST_OUTPUTS, Memory, Quantity};
use mozzi::scalar::Bits;
use mozzi::scalar::Float;
use mozzi::{Environment, Model, Scalar, Vec3, Wrench};

/// Computes a chunk of states on registers of one kind. Returns the errors of its states.
pub(crate) type Entry<L> =
    fn(&Request<<L as Bits>::Number>, &Model<<L as Bits>::Number>, &mut Worker<L>, Chunk<<L as Bits>::Number>);

/// True if this quantity has a kernel on registers.
pub(crate) fn has_registers(index: usize) -> bool {
    macro_rules! answers {
        ($($Q:ident)*) => { &[$(<quantities::$Q as Quantity>::Registers::HAS_REGISTERS),*] };
    }
    const ANSWERS: &[bool] = mozzi::quantities!(answers);
    ANSWERS[index]
}

/// Computes the states of a chunk by a kernel; inlined into an entry.
#[inline(always)]
pub(crate) fn run<K: Kernel, L: Lane>(
    request: &Request<L::Number>,
    model: &Model<L::Number>,
    worker: &mut Worker<L>,
    mut chunk: Chunk<L::Number>,
) where
    L::Number: Number,
{
    let Worker { memory, input, output, applied, errors, .. } = worker;
    let declaration = request.query.declaration();
    let number = |x: f64| L::from_f64(x);
    let given = &request.environment;
    applied.clear();
    applied.extend(given.applied.iter().map(|&(frame, F)| (frame, F.map(number))));
    applied.extend(request.wrenches.iter().map(|&(frame, _)| (frame, Wrench::zero())));
    let around = Environment {
        gravity: given.gravity.map(number),
        base_twist: given.base_twist.map(number),
        base_acceleration: given.base_acceleration.map(number),
        applied: &[],
    };
    let point = request.query.subject.point.map(number);
    // the columns of each input, of the environment, and n zeros for inputs that the quantity does not have
    let own = declaration.inputs.len();
    let mut ends = [0; MOST_INPUTS + 1];
    for k in 0..MOST_INPUTS {
        ends[k + 1] = ends[k] + if k < own { chunk.inputs[k].width } else { 0 };
    }
    let read = chunk.inputs.iter().map(|table| table.width).sum();
    let missing = if declaration.is_at_rest { read..read + model.n() } else { 0..0 };
    let place = |k: usize| if k < own { ends[k]..ends[k + 1] } else { missing.clone() };
    let places = [place(0), place(1), place(2), place(3)];
    input.resize(read + model.n(), L::zero());
    input[read..].fill(L::zero());
    let mut widths = [0; MOST_OUTPUTS];
    widths[declaration.first_output()..].iter_mut().zip(&*chunk.outputs).for_each(|(width, output)| *width = output.1);
    output.resize(widths.iter().sum(), L::zero());

    for first in (0..chunk.states).step_by(L::WIDTH) {
        let rows = (chunk.states - first).min(L::WIDTH);
        chunk.read(first, rows, &mut input[..read]);
        let mut gravity = around.gravity;
        let mut wrenches = &input[ends[MOST_INPUTS]..read];
        if request.gravity.is_some() {
            (gravity, wrenches) = (Vec3([wrenches[0], wrenches[1], wrenches[2]]), &wrenches[3..]);
        }
        for (F, columns) in applied[given.applied.len()..].iter_mut().zip(wrenches.as_chunks().0) {
            F.1 = Wrench::from_array(*columns);
        }
        let environment = &Environment { gravity, applied, ..around };
        // no closures or loops here: a function that is not inlined is not compiled for the instruction set
        let [a, b, c, d] = &places;
        let inputs = [&input[a.clone()], &input[b.clone()], &input[c.clone()], &input[d.clone()]];
        let (first_output, rest) = output.split_at_mut(widths[0]);
        let (second, rest) = rest.split_at_mut(widths[1]);
        let (third, fourth) = rest.split_at_mut(widths[2]);
        let outputs = [first_output, second, third, fourth];
        K::run(Call { of: &request.query.subject, model, point, inputs, environment, memory, outputs });
        chunk.write(first, rows, output);
        if declaration.divides {
            let clearance = clearances(memory);
            for row in 0..rows {
                if clearance[row] > L::Number::zero() {
                    continue;
                }
                if let Err(error) = chunk.recheck(request, first + row, L::WIDTH, false) {
                    errors.push((chunk.first + first + row, error));
                }
            }
        }
    }
}

/// Positive for each state whose pivots pass the quick test.
#[inline(always)]
fn clearances<L: Lane>(memory: &Memory<L>) -> [L::Number; MOST]
where
    L::Number: Number,
{
    let mut all = L::one();
    for pivots in memory.pivots() {
        let Some((&pivot, rest)) = pivots.split_first() else { continue };
        let (mut least, mut sum) = (pivot, pivot);
        for &pivot in rest {
            (least, sum) = (least.min(pivot), sum + pivot);
        }
        // as the second operand, a NaN is kept; a NaN pivot of the mass matrix makes the task's pivots NaN, too
        all = all.min(clearance(least, sum, L::Number::EPSILON));
    }
    let mut numbers = [L::Number::zero(); MOST];
    all.store(&mut numbers);
    numbers
}
