//! Many states at once: a quantity's program as machine code on the rows of the caller's tables, or its kernel, state
//! by state, on all cores.

mod batch;
mod check;
mod chunk;
mod code;
mod compiled;
mod directional;
mod engine;
mod environment;
mod error;
mod kernels;
mod number;
mod once;
mod pool;
mod programs;
mod request;
mod rollout;
mod simulate;
mod threads;

pub use batch::Batch;
pub use compiled::{Compiled, compile};
pub use directional::Direction;
pub use engine::Engine;
pub use environment::BatchEnvironment;
pub use error::Error;
pub use number::Number;
pub use rollout::{BatchGradient, BatchRollout};
