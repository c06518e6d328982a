//! One thread's memory.

use crate::lanes::Lane;
use mozzi::quantities::Memory;
use mozzi::{FrameId, Model, Wrench};

/// Memory without meaning between calls.
pub struct Worker<L: Lane> {
    pub memory: Memory<L>,
    pub input: Vec<L>,
    pub output: Vec<L>,
    pub zeros: Vec<L>,
    pub applied: Vec<(FrameId, Wrench<L>)>,
    /// The columns of all tables of one register of states.
    pub read: Vec<L>,
    pub written: Vec<L>,
    /// The slots of an interpreter.
    pub values: Vec<L>,
    /// States without an answer.
    pub errors: Vec<(usize, mozzi::Error)>,
}

impl<L: Lane> Worker<L> {
    pub fn new(model: &Model<L::Number>) -> Self {
        Worker {
            memory: Memory::new(model),
            input: Vec::new(),
            output: Vec::new(),
            zeros: Vec::new(),
            applied: Vec::new(),
            read: Vec::new(),
            written: Vec::new(),
            values: Vec::new(),
            errors: Vec::new(),
        }
    }
}
