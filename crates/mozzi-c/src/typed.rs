//! A function for each quantity, typed: `mozzi_inverse_dynamics(model, workspace, theta, …, tau)`. Their list is
//! written from that of the quantities, with their declarations in mozzi.h, by `tests/header.rs`.

use crate::call::{Matrix, Out, Tensor, call};
use crate::environment::CEnvironment;
use crate::robot::{Frame, ModelHandle};
use crate::status::Status;
use crate::subject::{Given, Task};
use crate::workspace::WorkspaceHandle;
use mozzi::quantities::{self, Query};

/// An output's address.
type Vector = *mut f64;
/// The addresses of a task, a point, an environment.
type TaskPointer = *const Task;
type Point = *const f64;
type EnvironmentPointer = *const CEnvironment;

/// One function: its name, quantity, inputs, further arguments, outputs.
macro_rules! export {
    ($name:ident $Q:ident ($($input:ident)*) ($($argument:ident: $Argument:ty),*) ($($output:ident: $Output:ty),*)) => {
        /// See mozzi.h.
        ///
        /// # Safety
        /// See mozzi.h.
        #[unsafe(no_mangle)]
        #[allow(clippy::too_many_arguments)] // those of the quantity
        pub unsafe extern "C" fn $name(
            model: *const ModelHandle,
            workspace: *mut WorkspaceHandle,
            $($input: *const f64,)*
            $($argument: $Argument,)*
            $($output: $Output),*
        ) -> Status {
            let index = const { Query::from_quantity::<quantities::$Q>() }.index();
            let given = Given { $($argument,)* ..Given::default() };
            let (inputs, outputs) = ([$($input),*], [$(Out::from($output)),*]);
            // SAFETY: the caller's promise; the numbers of inputs and outputs are those of the declaration.
            unsafe { call(index, model, workspace.cast_const(), &inputs, &given, &outputs) }
        }
    };
}

include!("typed/list.rs");
