//! Programs whose results are NaN where a pivot is not regular, and packed matrices.

use crate::Error;
use mozzi::quantities::{Dim, Of, Query};
use mozzi::{Model, Scalar};
use mozzi_engine::{Arguments, Precision, Program, Traced, pivot_names, record, record_quantity};

/// States at which the inertias of joints are computed.
const STATES: u64 = 32;

/// The program of a quantity for a GPU: the quantity's own outputs alone. If it divides by pivots, they are NaN in
/// states where a pivot is at most 64 ε of its joint's largest inertia, joints beyond it locked, in [`STATES`] states:
/// the rule of [`Pivots`](mozzi::Pivots) with an upper bound of M_jj, and with ε of the number type. If `is_packed`, a
/// symmetric matrix is its lower triangle by rows: entry (i, j), i ≥ j, at i(i + 1)/2 + j.
pub(crate) fn program(model: &Model, query: Query, precision: Precision, is_packed: bool) -> Result<Program, Error> {
    let declaration = query.declaration();
    let unsupported = |reason| Err(Error::Unsupported { quantity: declaration.name, reason });
    if declaration.of == Of::Task {
        return unsupported("tasks are judged state by state");
    }
    if is_packed && !declaration.outputs.iter().any(|output| output.is_symmetric) {
        return unsupported("it has no symmetric matrix to be packed");
    }
    let program = record_quantity(model, query, Arguments::default())?;
    let kinds = pivot_names(&query).len();
    if kinds == 0 && !is_packed {
        return Ok(program);
    }
    let limits = if kinds > 0 { limits(model, precision)? } else { Vec::new() };
    let inputs: Vec<(&str, usize)> = program.inputs().iter().map(|x| (x.name.as_str(), x.length)).collect();
    let program = record(program.name(), &inputs, |arrays| {
        let slices: Vec<&[Traced]> = arrays.iter().map(Vec::as_slice).collect();
        let mut outputs = program.evaluate(&slices);
        let pivots = outputs.split_off(outputs.len() - kinds);
        if let Some(pivots) = pivots.first() {
            let regular = are_regular(pivots, &limits);
            outputs.iter_mut().flatten().for_each(|x| *x = *x * regular);
        }
        if is_packed {
            for (output, declared) in outputs.iter_mut().zip(declaration.outputs).filter(|(_, x)| x.is_symmetric) {
                let n = declared.dims.first().map_or(1, |dim: &Dim| dim.size(model, &query.subject));
                *output = (0..n).flat_map(|i| output[i * n..=i * n + i].to_vec()).collect();
            }
        }
        program.outputs().iter().map(|output| output.name.as_str()).zip(outputs).collect()
    });
    program.map_err(|error| Error::TooLong { quantity: declaration.name, error })
}

/// 1 if each pivot is above its limit, else NaN. The signs of the differences add up to n, or to n − 1 or less.
fn are_regular(pivots: &[Traced], limits: &[f64]) -> Traced {
    let number = Traced::from;
    let above = pivots.iter().zip(limits).map(|(&pivot, &limit)| (pivot - number(limit)).sgn());
    let sum = above.fold(number(0.0), |sum, sign| sum + sign);
    let n = pivots.len() as f64;
    sum.mul_add(number(2.0), number(1.0 - 2.0 * n)).sqrt()
}

/// 64 ε of each joint's largest inertia in some states.
fn limits(model: &Model, precision: Precision) -> Result<Vec<f64>, Error> {
    let epsilon = if precision == Precision::F64 { f64::EPSILON } else { f32::EPSILON.into() };
    let mut largest = vec![0.0_f64; model.n()];
    for seed in 1..=STATES {
        let M = model.mass_matrix(&mozzi::random::state(model, seed)[0])?;
        largest.iter_mut().enumerate().for_each(|(j, largest)| *largest = largest.max(M[(j, j)]));
    }
    Ok(largest.into_iter().map(|x| 64.0 * epsilon * x).collect())
}
