//! Quantities by name or number: what they are, and calls with checked lengths.

use crate::border::{check_length, slice, text};
use crate::call::{Out, call_of_any};
use crate::environment::CEnvironment;
use crate::handle::{borrow, check_pointer};
use crate::robot::{ModelHandle, shapes};
use crate::status::{Outcome, Status, guard, guard_or, of_model, refuse};
use crate::subject::{CSubject, Given, declaration};
use crate::workspace::WorkspaceHandle;
use mozzi::quantities::{LIST, MOST_INPUTS, MOST_OUTPUTS, Query, Subject};
use std::ffi::{CString, c_char};
use std::sync::OnceLock;

/// `mozzi_input`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Input {
    data: *const f64,
    length: usize,
}

/// `mozzi_output`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct COutput {
    data: *mut f64,
    length: usize,
    strides: [isize; 3],
}

/// How many quantities there are.
#[unsafe(no_mangle)]
pub extern "C" fn mozzi_quantity_count() -> usize {
    LIST.len()
}

/// The name of a quantity, null if there is none of this number.
#[unsafe(no_mangle)]
pub extern "C" fn mozzi_quantity_name(quantity: i32) -> *const c_char {
    described(quantity, 0)
}

/// The formula of a quantity, null if there is none of this number.
#[unsafe(no_mangle)]
pub extern "C" fn mozzi_quantity_formula(quantity: i32) -> *const c_char {
    described(quantity, 1)
}

fn described(quantity: i32, which: usize) -> *const c_char {
    static TEXTS: OnceLock<Vec<[CString; 2]>> = OnceLock::new();
    guard_or(std::ptr::null(), || {
        let texts = TEXTS.get_or_init(|| {
            LIST.iter().map(|known| [known.name, known.formula].map(crate::border::c_string)).collect()
        });
        Ok(texts[declaration(quantity)?.0][which].as_ptr())
    })
}

/// The number of the quantity of this name.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_quantity_named(name: *const c_char, quantity: *mut i32) -> Status {
    // SAFETY: the caller's promise, as everywhere in this file.
    guard(|| unsafe {
        check_pointer(quantity.cast_const(), "quantity")?;
        let found = Query::named(text(name, "name")?).map_err(|error| of_model(&error))?;
        quantity.write(found.index() as i32);
        Ok(())
    })
}

/// How many inputs it has, 0 for a number that no quantity has.
#[unsafe(no_mangle)]
pub extern "C" fn mozzi_quantity_input_count(quantity: i32) -> usize {
    guard_or(0, || Ok(declaration(quantity)?.1.inputs.len()))
}

/// How many outputs it has, 0 for a number that no quantity has.
#[unsafe(no_mangle)]
pub extern "C" fn mozzi_quantity_output_count(quantity: i32) -> usize {
    guard_or(0, || Ok(declaration(quantity)?.1.outputs.len()))
}

/// Rows of a task that has this many.
fn subject_of(rows: usize) -> Outcome<Subject<'static>> {
    const ALL: &[usize] = &[0, 1, 2, 3, 4, 5];
    match rows {
        0 => Ok(Query::at(0).subject),
        1..=6 => Ok(Subject { rows: &ALL[..rows], ..Query::at(0).subject }),
        _ => refuse!(Status::INVALID_ARGUMENT, "the task has {rows} rows, expected at most 6"),
    }
}

/// The length of an input for this model.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_quantity_input_length(model: *const ModelHandle, quantity: i32, k: usize) -> usize {
    // SAFETY: as above.
    guard_or(0, || unsafe {
        let (robot, (_, declaration)) = (borrow(model)?, declaration(quantity)?);
        match declaration.inputs.get(k) {
            Some(input) => Ok(input.dim.size(&robot.model, &subject_of(0)?)),
            None => refuse!(Status::NOT_FOUND, "{} has no input {k}", declaration.name),
        }
    })
}

/// The shape of an output for this model: its axes, and as many sizes; after them ones.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_quantity_output_shape(
    model: *const ModelHandle,
    quantity: i32,
    k: usize,
    task_rows: usize,
    axes: *mut usize,
    sizes: *mut usize,
) -> Status {
    // SAFETY: as above.
    guard(|| unsafe {
        let (robot, (_, declaration)) = (borrow(model)?, declaration(quantity)?);
        let Some(output) = declaration.outputs.get(k) else {
            return refuse!(Status::NOT_FOUND, "{} has no output {k}", declaration.name);
        };
        let mut shape = shapes(declaration, &robot.model, &subject_of(task_rows)?)[k];
        shape.rotate_left(3 - output.dims.len());
        check_pointer(axes.cast_const(), "axes")?;
        axes.write(output.dims.len());
        crate::border::copy_out(&shape, sizes, "sizes")
    })
}

/// Any quantity, with the lengths of its arguments.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_compute(
    model: *const ModelHandle,
    workspace: *mut WorkspaceHandle,
    quantity: i32,
    subject: *const CSubject,
    inputs: *const Input,
    input_count: usize,
    environment: *const CEnvironment,
    outputs: *const COutput,
    output_count: usize,
) -> Status {
    let mut pointers = [std::ptr::null(); MOST_INPUTS];
    let mut places = [Out::from(std::ptr::null_mut()); MOST_OUTPUTS];
    let mut index = 0;
    let mut given = Given::default();
    // SAFETY: as above.
    let status = guard(|| unsafe {
        let robot = borrow(model)?;
        let (place, declaration) = declaration(quantity)?;
        (index, given) = (place, CSubject::given(subject, environment)?);
        let query = given.query(robot, index)?;
        check_length("inputs", input_count, declaration.inputs.len())?;
        check_length("outputs", output_count, declaration.outputs.len())?;
        let inputs = slice(inputs, input_count, "inputs")?;
        for ((input, declared), pointer) in inputs.iter().zip(declaration.inputs).zip(&mut pointers) {
            check_length(declared.name, input.length, declared.dim.size(&robot.model, &query.subject))?;
            *pointer = input.data;
        }
        let outputs = slice(outputs, output_count, "outputs")?;
        let shapes = shapes(declaration, &robot.model, &query.subject);
        for (((output, declared), place), shape) in outputs.iter().zip(declaration.outputs).zip(&mut places).zip(shapes)
        {
            check_length(declared.name, output.length, shape.iter().product())?;
            let mut strides = output.strides;
            if strides == [0; 3] {
                strides = [(shape[1] * shape[2]) as isize, shape[2] as isize, 1];
            }
            *place = Out { data: output.data, strides };
        }
        Ok(())
    });
    if status != Status::OK {
        return status;
    }
    // SAFETY: as above; the numbers of inputs and outputs were checked.
    unsafe {
        call_of_any(index, model, workspace.cast_const(), &pointers[..input_count], &given, &places[..output_count])
    }
}

/// Reports a wrong length that a wrapper found.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_report_length(name: *const c_char, found: usize, expected: usize) -> Status {
    // SAFETY: as above.
    guard(|| unsafe {
        let name = text(name, "name")?;
        refuse!(Status::WRONG_LENGTH, "{name} has {found} entries, expected {expected}")
    })
}

/// Reports numbers that do not lie next to each other.
///
/// # Safety
/// The name is null or a text that ends with a NUL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_report_gaps(name: *const c_char) -> Status {
    guard(|| {
        // SAFETY: the caller's promise.
        let name = unsafe { text(name, "name")? };
        let expected = "numbers next to each other: copy them into a vector";
        refuse!(
            Status::WRONG_LENGTH,
            "{name} has gaps between its numbers, such as a row of a matrix by columns has; expected {expected}"
        )
    })
}
