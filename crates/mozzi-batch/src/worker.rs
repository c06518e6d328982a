//! One thread's memory.

use crate::lanes::Lane;
use mozzi::quantities::Memory;
use mozzi::{FrameId, Model, Wrench};

/// Scratch memory; its content means nothing between calls.
pub struct Worker<L: Lane> {
    pub memory: Memory<L>,
    pub input: Vec<L>,
    pub output: Vec<L>,
    pub applied: Vec<(FrameId, Wrench<L>)>,
    /// The columns of one register of states.
    pub scratch: Vec<L>,
    /// The slots of an interpreter.
    pub values: Vec<L>,
    /// States that failed.
    pub errors: Vec<(usize, mozzi::Error)>,
}

impl<L: Lane> Worker<L> {
    pub fn new(model: &Model<L::Number>) -> Self {
        Worker {
            memory: Memory::new(model),
            input: Vec::new(),
            output: Vec::new(),
            applied: Vec::new(),
            scratch: Vec::new(),
            values: Vec::new(),
            errors: Vec::new(),
        }
    }
}
