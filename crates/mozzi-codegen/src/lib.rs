//! Robots as straight-line programs, and programs as machine code.
#![allow(missing_docs)]

mod batch;
mod compiled;
mod count;
mod function;
mod jit;
mod program;
mod quantity;
mod record;
mod tape;
mod text;
mod traced;

pub use compiled::{Compiled, Engine, compile};
pub use count::Count;
pub use function::Function;
pub use jit::{Kernel, LONGEST_CODE, Refusal, Shape};
pub use program::{Array, Output, Program, Step, Value};
pub use quantity::{LeftOpen, Quantity};
pub use record::record;
pub use text::NotAProgram;
pub use traced::Traced;
