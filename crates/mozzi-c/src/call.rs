//! One quantity at one state: from C's pointers to the kernel and back, without allocation.

use crate::border::{check_finite, overlap, slice, span};
use crate::environment::CEnvironment;
use crate::handle::{borrow, check_pointer};
use crate::robot::{ModelHandle, Robot, shapes};
use crate::status::{Outcome, Status, guard, refuse};
use crate::subject::Given;
use crate::workspace::{Memory, WorkspaceHandle};
use mozzi::Environment;
use mozzi::fast::{self, Singular};
use mozzi::quantities::{Dim, Of};
use std::sync::Arc;

/// Where an output goes: its address and the strides of its last three axes, in numbers.
#[derive(Clone, Copy, Debug)]
pub struct Out {
    pub data: *mut f64,
    pub strides: [isize; 3],
}

/// `mozzi_matrix`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Matrix {
    data: *mut f64,
    row_stride: isize,
    column_stride: isize,
}

/// `mozzi_tensor`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Tensor {
    data: *mut f64,
    block_stride: isize,
    row_stride: isize,
    column_stride: isize,
}

impl From<*mut f64> for Out {
    #[inline(always)]
    fn from(data: *mut f64) -> Self {
        Out { data, strides: [0, 0, 1] }
    }
}

impl From<Matrix> for Out {
    #[inline(always)]
    fn from(Matrix { data, row_stride, column_stride }: Matrix) -> Self {
        Out { data, strides: [0, row_stride, column_stride] }
    }
}

impl From<Tensor> for Out {
    #[inline(always)]
    fn from(Tensor { data, block_stride, row_stride, column_stride }: Tensor) -> Self {
        Out { data, strides: [block_stride, row_stride, column_stride] }
    }
}

/// True if these strides describe numbers by rows without gaps.
#[inline(always)]
fn is_by_rows(&[blocks, rows, columns]: &[usize; 3], &[block, row, column]: &[isize; 3]) -> bool {
    (columns <= 1 || column == 1)
        && (rows <= 1 || row == columns as isize)
        && (blocks <= 1 || block == (rows * columns) as isize)
}

/// Copies numbers by rows to their place.
///
/// # Safety
/// The place may be written.
unsafe fn scatter(numbers: &[f64], &[_, rows, columns]: &[usize; 3], out: &Out) {
    let [block, row, column] = out.strides;
    let mut start = out.data;
    for numbers in numbers.chunks_exact((rows * columns).max(1)) {
        // column by column: Eigen's order
        for c in 0..columns {
            let mut to = start.wrapping_offset(c as isize * column);
            for number in numbers[c..].iter().step_by(columns) {
                // SAFETY: the caller's promise.
                unsafe { to.write(*number) };
                to = to.wrapping_offset(row);
            }
        }
        start = start.wrapping_offset(block);
    }
}

/// Computes the quantity of this index, which has I inputs and O outputs: constants, so that the compiler
/// unrolls the loops over them.
///
/// # Safety
/// Handles, inputs and outputs are null or as mozzi.h promises; there are as many as the quantity has.
#[inline(never)]
pub unsafe fn call<const I: usize, const O: usize>(
    index: usize,
    model: *const ModelHandle,
    workspace: *const WorkspaceHandle,
    inputs: &[*const f64; I],
    given: &Given,
    outputs: &[Out; O],
) -> Status {
    // SAFETY: the caller's promise.
    guard(|| unsafe { checked(index, model, workspace, inputs, given, outputs) })
}

#[cold]
#[inline(never)]
fn foreign(robot: &Robot, other: &Robot) -> Outcome {
    let [found, expected] = [other, robot].map(|robot| &robot.model.description().name);
    refuse!(Status::FOREIGN, "the workspace is of a model '{found}', expected one of this '{expected}'")
}

#[cold]
#[inline(never)]
fn is_singular(robot: &Robot, singular: Singular) -> Outcome {
    match singular {
        Singular::MassMatrix(j) => {
            let joint = robot.names.velocities[j].to_str().unwrap_or_default();
            let why = "it moves no inertia, or other joints produce the same motion";
            refuse!(Status::SINGULAR, "the mass matrix is singular at joint '{joint}': {why}")
        }
        Singular::Task => refuse!(Status::SINGULAR, "the task is singular: the rows of its Jacobian are dependent"),
    }
}

/// [`call`] with numbers of inputs and outputs that are known when it runs.
///
/// # Safety
/// As [`call`].
pub unsafe fn call_of_any(
    index: usize,
    model: *const ModelHandle,
    workspace: *const WorkspaceHandle,
    inputs: &[*const f64],
    given: &Given,
    outputs: &[Out],
) -> Status {
    macro_rules! of {
        ($($I:literal $O:literal)*) => {
            $(if let (Some(inputs), Some(outputs)) = (exactly::<_, $I>(inputs), exactly::<_, $O>(outputs)) {
                // SAFETY: the caller's promise.
                return unsafe { call::<$I, $O>(index, model, workspace, inputs, given, outputs) };
            })*
        };
    }
    of!(1 1 1 2 1 3 1 4 2 1 2 2 2 3 2 4 3 1 3 2 3 3 3 4 4 1 4 2 4 3 4 4);
    Status::INTERNAL
}

/// The list as an array, if it has as many entries.
fn exactly<T, const K: usize>(list: &[T]) -> Option<&[T; K]> {
    list.try_into().ok()
}

/// # Safety
/// As [`call`].
#[inline(always)]
unsafe fn checked<const I: usize, const O: usize>(
    index: usize,
    model: *const ModelHandle,
    workspace: *const WorkspaceHandle,
    inputs: &[*const f64; I],
    given: &Given,
    outputs: &[Out; O],
) -> Outcome {
    // SAFETY: the caller's promise.
    let (robot, workspace) = unsafe { (borrow(model)?, borrow(workspace)?) };
    if !Arc::ptr_eq(robot, &workspace.robot) {
        return foreign(robot, &workspace.robot);
    }
    let mut locked = workspace.lock()?;
    let Memory { fast, program, applied, scratch, M } = &mut *locked;
    let plan = &robot.plans[index];
    let declaration = plan.declaration;
    let (own, own_shapes);
    let (query, shapes) = if declaration.of == Of::Robot && !declaration.needs_mass {
        (&plan.query, &plan.outputs)
    } else {
        // SAFETY: the caller's promise.
        own = unsafe { given.query(robot, index)? };
        own_shapes = shapes(declaration, &robot.model, &own.subject);
        (&own, &own_shapes)
    };

    // all pointers are read before the numbers they point to: the loads overlap
    assert!(declaration.inputs.len() == I && declaration.outputs.len() == O);
    let mut state: [&[f64]; I] = [&[]; I];
    for k in 0..I {
        // SAFETY: the caller's promise.
        state[k] = unsafe { slice(inputs[k], plan.inputs[k], declaration.inputs[k].name)? };
    }

    let mut places: [&mut [f64]; O] = std::array::from_fn(|_| Default::default());
    let mut is_direct = [true; O];
    let mut rest = &mut scratch[..];
    for k in 0..O {
        let (output, out, shape) = (&declaration.outputs[k], &outputs[k], &shapes[k]);
        let length = shape[0] * shape[1] * shape[2];
        if length == 0 {
            continue;
        }
        check_pointer(out.data.cast_const(), output.name)?;
        let (data, [block, row, column]) = (out.data.cast_const(), out.strides);
        is_direct[k] = (is_by_rows(shape, &out.strides)
            || output.is_symmetric && is_by_rows(shape, &[block, column, row]))
            && !state.iter().any(|input| overlap((data, length), span(input)))
            && !places[..k].iter().any(|other| overlap((data, length), span(other)));
        places[k] = if is_direct[k] {
            // SAFETY: the caller's promise, and no other slice of this call has a part of it.
            unsafe { std::slice::from_raw_parts_mut(out.data, length) }
        } else {
            let (part, tail) = std::mem::take(&mut rest).split_at_mut(length);
            rest = tail;
            part
        };
    }

    for (numbers, input) in state.iter().zip(declaration.inputs) {
        match input.dim {
            Dim::Nq => robot.check_theta(numbers, "theta")?,
            _ => check_finite(numbers, input.name)?,
        }
    }

    let by_code = if given.environment.is_null() { program.as_ref() } else { None };
    let by_code = by_code.and_then(|program| program.evaluate_code(query, &state, &mut places));
    let singular = match by_code {
        Some(true) => None,
        _ => {
            let around;
            let environment: &Environment = if given.environment.is_null() {
                &robot.own
            } else {
                // SAFETY: the caller's promise.
                around = unsafe { CEnvironment::read(given.environment, robot, applied)? };
                &around
            };
            fast::evaluate(query, &robot.model, &state, environment, fast, &mut places);
            match !declaration.divides || fast.are_pivots_clear(query) {
                true => None,
                false => fast.singular(query, &robot.model, state[0], M),
            }
        }
    };
    if singular.is_some() {
        places.iter_mut().for_each(|numbers| numbers.fill(f64::NAN));
    }
    for k in (0..O).filter(|&k| !is_direct[k]) {
        // SAFETY: the caller's promise.
        unsafe { scatter(places[k], &shapes[k], &outputs[k]) };
    }
    singular.map_or(Ok(()), |singular| is_singular(robot, singular))
}

#[cfg(test)]
mod tests {
    use super::is_by_rows;
    use crate::border::overlap;

    #[test]
    fn rows_without_gaps_are_told_from_others() {
        assert!(is_by_rows(&[1, 1, 7], &[0, 0, 1]));
        assert!(is_by_rows(&[1, 6, 7], &[0, 7, 1]));
        assert!(is_by_rows(&[3, 6, 7], &[42, 7, 1]));
        assert!(is_by_rows(&[1, 1, 1], &[0, 9, 9]));
        assert!(!is_by_rows(&[1, 6, 7], &[0, 1, 6]));
        assert!(!is_by_rows(&[1, 6, 7], &[0, 8, 1]));
        assert!(!is_by_rows(&[3, 6, 7], &[1, 7, 1]));
        assert!(!is_by_rows(&[1, 1, 7], &[0, 0, 2]));
    }

    #[test]
    fn arrays_overlap_if_they_share_a_number() {
        let x = [0.0; 10];
        let at = |k: usize| x[k..].as_ptr();
        let share = |a: usize, m: usize, b: usize, n: usize| overlap((at(a), m), (at(b), n));
        assert!(share(0, 5, 4, 5) && share(4, 5, 0, 5) && share(2, 1, 0, 10));
        assert!(!share(0, 5, 5, 5) && !share(5, 5, 0, 5));
    }
}
