//! Many states by the kernel of one state, state after state. Tables of `f32` are computed in `f64` and converted.

use crate::Number;
use crate::many::chunk::{Chunk, Fixed, Table};
use crate::many::request::Request;
use mozzi::quantities::{MOST_INPUTS, MOST_OUTPUTS};
use mozzi::{Environment, FrameId, Model, Vec3, Wrench, fast};

/// One thread's memory; its content means nothing between calls.
pub(crate) struct Worker {
    workspace: fast::Workspace,
    /// A state's inputs and outputs in `f64`.
    input: Vec<f64>,
    output: Vec<f64>,
    applied: Vec<(FrameId, Wrench)>,
}

impl Worker {
    pub fn new(model: &Model) -> Self {
        Worker { workspace: fast::Workspace::new(model), input: Vec::new(), output: Vec::new(), applied: Vec::new() }
    }
}

/// Computes a chunk's states; returns the errors of those that failed.
pub(crate) fn run<T: Number>(
    request: &Request<T>,
    worker: &mut Worker,
    mut chunk: Chunk<T>,
) -> Vec<(usize, mozzi::Error)> {
    let divides = request.query.declaration().divides;
    let mut errors = Vec::new();
    for state in 0..chunk.states {
        let is_clear = one(request, worker, &mut chunk, state);
        if divides
            && !is_clear
            && let Err(error) = chunk.recompute(request, state)
        {
            errors.push((chunk.first + state, error));
        }
    }
    errors
}

/// Computes one state; returns whether its pivots are well above rounding error.
fn one<T: Number>(request: &Request<T>, worker: &mut Worker, chunk: &mut Chunk<T>, state: usize) -> bool {
    let Worker { workspace, input, output, applied } = worker;
    let place = chunk.first + state;
    let (own, mut further) = chunk.inputs.split_at(request.query.declaration().inputs.len());
    let mut next = |is_given: bool| {
        let (table, rest) = if is_given { further.split_first()? } else { return None };
        further = rest;
        Some(table.row(place))
    };
    let changed = next(request.parameters.is_some()).map(|row| {
        let parameters: Vec<f64> = row.iter().map(|&x| x.into()).collect();
        request.model.with_parameters(&parameters)
    });
    let gravity =
        next(request.gravity.is_some()).map_or(request.environment.gravity, |g| Vec3([0, 1, 2].map(|k| g[k].into())));
    let environment = if request.wrenches.is_empty() {
        Environment { gravity, ..request.environment }
    } else {
        applied.clear();
        applied.extend_from_slice(request.environment.applied);
        for (&(frame, _), table) in request.wrenches.iter().zip(further) {
            applied.push((frame, Wrench::from_array(core::array::from_fn(|k| table.row(place)[k].into()))));
        }
        Environment { gravity, applied, ..request.environment }
    };
    let model = changed.as_ref().unwrap_or(request.model);

    let mut inputs: [&[f64]; MOST_INPUTS] = [&[]; MOST_INPUTS];
    if own.iter().all(|table| T::as_f64(table.numbers).is_some()) {
        for (to, table) in inputs.iter_mut().zip(own) {
            *to = T::as_f64(table.row(place)).unwrap_or_default();
        }
        let mut outputs: [&mut [f64]; MOST_OUTPUTS] = Default::default();
        for (to, (table, width)) in outputs.iter_mut().zip(&mut *chunk.outputs) {
            *to = T::as_f64_mut(&mut table[state * *width..][..*width]).unwrap_or_default();
        }
        let count = request.query.declaration().outputs.len();
        fast::evaluate(&request.query, model, &inputs[..own.len()], &environment, workspace, &mut outputs[..count]);
    } else {
        input.clear();
        own.iter().for_each(|table| input.extend(table.row(place).iter().map(|&x| -> f64 { x.into() })));
        let mut rest = &input[..];
        for (to, Table { width, .. }) in inputs.iter_mut().zip(own) {
            (*to, rest) = rest.split_at(*width);
        }
        output.resize(chunk.outputs.iter().map(|&(_, width)| width).sum(), 0.0);
        let mut rest = &mut output[..];
        let split = |&(_, width): &(&mut [T], usize)| {
            let (own, further) = core::mem::take(&mut rest).split_at_mut(width);
            rest = further;
            own
        };
        let mut outputs: Fixed<&mut [f64]> = chunk.outputs.iter().map(split).collect();
        fast::evaluate(&request.query, model, &inputs[..own.len()], &environment, workspace, &mut outputs);
        for ((table, width), found) in chunk.outputs.iter_mut().zip(&*outputs) {
            table[state * *width..][..*width].iter_mut().zip(&**found).for_each(|(to, &x)| *to = T::from_f64(x));
        }
    }
    workspace.are_pivots_clear(&request.query)
}
