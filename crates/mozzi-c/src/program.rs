//! Quantities of a robot as machine code.

use crate::border::slice;
use crate::handle::{Handle, borrow, clear, free, kind, put};
use crate::robot::{ModelHandle, Robot};
use crate::status::{Status, guard, guard_or, of_model};
use crate::subject::CSubject;
use mozzi_engine::{Compiled, Engine};
use std::sync::Arc;

/// Machine code of some quantities.
pub struct Program {
    pub robot: Arc<Robot>,
    pub compiled: Compiled,
}

kind!(Program, "mozzi_program");

/// `struct mozzi_program`.
pub type ProgramHandle = Handle<Program>;

/// Compiles quantities.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_program_new(
    model: *const ModelHandle,
    quantities: *const i32,
    subjects: *const CSubject,
    count: usize,
    program: *mut *mut ProgramHandle,
) -> Status {
    // SAFETY: the caller's promise, as everywhere in this file.
    guard(|| unsafe {
        clear(program)?;
        let robot = borrow(model)?;
        let quantities = slice(quantities, count, "quantities")?;
        let mut queries = Vec::with_capacity(count);
        for (k, &quantity) in quantities.iter().enumerate() {
            let subject = if subjects.is_null() { std::ptr::null() } else { subjects.add(k) };
            queries.push(CSubject::query(subject, robot, quantity)?);
        }
        let compiled = mozzi_engine::compile(&robot.model, &queries).map_err(|error| of_model(&error))?;
        put(Program { robot: robot.clone(), compiled }, program)
    })
}

/// Whether there is machine code for this quantity: 1 or 0.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_program_has_code(
    program: *const ProgramHandle,
    quantity: i32,
    subject: *const CSubject,
) -> i32 {
    // SAFETY: as above.
    guard_or(0, || unsafe {
        let Program { robot, compiled } = borrow(program)?;
        let query = CSubject::query(subject, robot, quantity)?;
        Ok(matches!(compiled.engine(query), Engine::MachineCode(..)).into())
    })
}

/// Frees it; workspaces and batches keep its code.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_program_free(program: *mut ProgramHandle) -> Status {
    // SAFETY: as above.
    guard(|| unsafe { free(program) })
}
