//! Memory for the calls of one thread at a time.

use crate::handle::{Handle, borrow, clear, free, kind, put};
use crate::program::ProgramHandle;
use crate::robot::{ModelHandle, Robot};
use crate::status::{Outcome, Status, guard, refuse};
use mozzi::quantities::{LIST, Of, Query};
use mozzi::{FrameId, TaskFrame, Wrench, fast};
use mozzi_engine::Compiled;
use std::cell::UnsafeCell;
use std::ops::{Deref, DerefMut};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Memory, and a mark while a call uses it.
pub struct Workspace {
    pub robot: Arc<Robot>,
    is_busy: AtomicBool,
    memory: UnsafeCell<Memory>,
}

// SAFETY: the memory is used by the holder of `Locked` alone.
unsafe impl Sync for Workspace {}

/// Memory for the calls of one workspace.
pub struct Memory {
    pub fast: fast::Workspace,
    pub program: Option<Compiled>,
    pub applied: Vec<(FrameId, Wrench)>,
    /// Outputs that go elsewhere afterwards: in other strides, or over inputs.
    pub scratch: Vec<f64>,
    /// M, for the pivots' rule.
    pub M: Vec<f64>,
}

kind!(Workspace, "mozzi_workspace");

/// `struct mozzi_workspace`.
pub type WorkspaceHandle = Handle<Workspace>;

/// The memory during a call.
pub struct Locked<'a>(&'a Workspace);

impl Drop for Locked<'_> {
    #[inline(always)]
    fn drop(&mut self) {
        self.0.is_busy.store(false, Ordering::Release);
    }
}

impl Deref for Locked<'_> {
    type Target = Memory;
    #[inline(always)]
    fn deref(&self) -> &Memory {
        // SAFETY: the mark was set by this value alone.
        unsafe { &*self.0.memory.get() }
    }
}

impl DerefMut for Locked<'_> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut Memory {
        // SAFETY: as above.
        unsafe { &mut *self.0.memory.get() }
    }
}

impl Workspace {
    fn new(robot: &Arc<Robot>, program: Option<Compiled>) -> Self {
        let (model, frames) = (&robot.model, robot.frames.len());
        let mut memory = Memory {
            fast: fast::Workspace::new(model),
            program,
            applied: Vec::with_capacity(frames),
            scratch: vec![0.0; robot.most_numbers],
            M: vec![0.0; model.n() * model.n()],
        };
        memory.grow(robot);
        Workspace { robot: robot.clone(), is_busy: AtomicBool::new(false), memory: UnsafeCell::new(memory) }
    }

    /// The memory, unless a call uses it.
    #[inline(always)]
    pub fn lock(&self) -> Outcome<Locked<'_>> {
        if self.is_busy.swap(true, Ordering::Acquire) { busy() } else { Ok(Locked(self)) }
    }
}

#[cold]
#[inline(never)]
fn busy<T>() -> Outcome<T> {
    let expected = "a workspace of its own for each thread";
    refuse!(Status::BUSY, "the workspace is in use by another call, expected {expected}")
}

impl Memory {
    /// Computes every quantity once, so that later calls find all memory they need.
    fn grow(&mut self, robot: &Robot) {
        let model = &robot.model;
        let Some(&frame) = robot.frames.first() else { return };
        let start = model.start().theta;
        let ones = vec![1.0; model.nq().max(model.n()).max(6)];
        for index in 0..LIST.len() {
            let query = Query::at(index).of(frame);
            let all_rows = [0, 1, 2, 3, 4, 5];
            let most = if query.declaration().of == Of::Task { 6 } else { 1 };
            for count in 1..=most {
                let mut query = query;
                query.subject.rows = if most == 6 { &all_rows[..count] } else { query.subject.rows };
                query.subject.coordinates = TaskFrame::Space;
                let inputs: Vec<&[f64]> = query
                    .declaration()
                    .inputs
                    .iter()
                    .zip(query.input_lengths(model))
                    .map(|(input, length)| if input.name == "theta" { &start[..] } else { &ones[..length] })
                    .collect();
                let mut rest = &mut self.scratch[..];
                let mut outputs: Vec<&mut [f64]> = Vec::new();
                for length in query.output_lengths(model) {
                    let (output, tail) = std::mem::take(&mut rest).split_at_mut(length);
                    outputs.push(output);
                    rest = tail;
                }
                fast::evaluate(&query, model, &inputs, &robot.own, &mut self.fast, &mut outputs);
            }
        }
    }
}

/// Memory for a model.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_workspace_new(
    model: *const ModelHandle,
    workspace: *mut *mut WorkspaceHandle,
) -> Status {
    // SAFETY: the caller's promise, as everywhere in this file.
    guard(|| unsafe {
        clear(workspace)?;
        put(Workspace::new(borrow(model)?, None), workspace)
    })
}

/// Memory for a model, with machine code for some quantities.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_workspace_with_program(
    program: *const ProgramHandle,
    workspace: *mut *mut WorkspaceHandle,
) -> Status {
    // SAFETY: as above.
    guard(|| unsafe {
        clear(workspace)?;
        let program = borrow(program)?;
        put(Workspace::new(&program.robot, Some(program.compiled.clone())), workspace)
    })
}

/// Frees it; refused while a call uses it.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_workspace_free(workspace: *mut WorkspaceHandle) -> Status {
    // SAFETY: as above.
    guard(|| unsafe {
        if !workspace.is_null() {
            std::mem::forget(borrow(workspace)?.lock()?); // no call may begin
        }
        free(workspace)
    })
}
