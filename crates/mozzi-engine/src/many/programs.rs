//! The machine code of a batch's quantities, and the rule when it is made.

use crate::many::code::Code;
use crate::many::once::Once;
use crate::{Arguments, Program, Refusal, Shape, is_too_long, record_quantity};
use mozzi::quantities::Query;
use mozzi::{Error, FrameId, Model, TaskFrame};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// Machine code is made once the calls of a batch have computed this many states of a quantity. Recording and lowering
/// take as long as the kernels take for about this many states (`cargo run --release -p mozzi-engine --example
/// when_code_pays`).
pub(crate) const PAYS: usize = 1000;

/// The number of quantities whose counts and code are kept, beside those that were compiled explicitly.
const KEPT: usize = 64;

/// A quantity with its arguments.
#[derive(Debug)]
pub(crate) struct Entry {
    key: Key,
    /// States of the calls so far.
    asked: AtomicUsize,
    /// Compiled explicitly: kept.
    is_kept: AtomicBool,
    /// Kept if calls of few states evaluate it: a derivative along a direction.
    program: Once<Program>,
    code: Once<Result<Code, Refusal>>,
}

impl Entry {
    /// The code if it was made.
    pub fn made(&self) -> Option<&Result<Code, Refusal>> {
        self.code.get()
    }

    /// The code, made now if need be.
    ///
    /// # Errors
    /// The frame is missing or belongs to another model.
    pub fn make(
        &self,
        model: &Model,
        query: Query,
        arguments: Arguments,
        shape: Shape,
    ) -> Result<&Result<Code, Refusal>, Error> {
        self.code.get_or_try(|| {
            if is_too_long(model, query) {
                return Ok(Err(Refusal::Long));
            }
            match self.program.get() {
                Some(program) => Ok(Code::new(program, query, shape)),
                None => Ok(Code::new(&record_quantity(model, query, arguments)?, query, shape)),
            }
        })
    }

    /// The program, recorded now if need be, and kept.
    ///
    /// # Errors
    /// It would be too long; or as [`make`](Self::make).
    pub fn program(&self, model: &Model, query: Query, arguments: Arguments) -> Result<&Program, Error> {
        self.program.get_or_try(|| record_quantity(model, query, arguments))
    }

    /// Counts a call; whether machine code pays by now. It depends on the sizes of this batch's calls alone.
    pub fn pays(&self, states: usize) -> bool {
        let before = self.asked.fetch_add(states, Ordering::Relaxed);
        before.saturating_add(states) >= PAYS
    }
}

/// The entries of a batch and its clones.
#[derive(Clone, Debug, Default)]
pub(crate) struct Programs(Arc<Mutex<Vec<Arc<Entry>>>>);

impl Programs {
    /// These entries alone.
    pub fn of(entries: Vec<Arc<Entry>>) -> Self {
        Programs(Arc::new(Mutex::new(entries)))
    }

    /// The entry of a quantity, added if there is none.
    pub fn entry(&self, query: &Query, arguments: &Arguments, keep: bool) -> Arc<Entry> {
        let mut list = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(entry) = list.iter().find(|entry| entry.key.is_of(query, arguments)) {
            entry.is_kept.fetch_or(keep, Ordering::Relaxed);
            return entry.clone();
        }
        let is_loose = |entry: &Arc<Entry>| !entry.is_kept.load(Ordering::Relaxed);
        if list.iter().filter(|entry| is_loose(entry)).count() >= KEPT
            && let Some(oldest) = list.iter().position(is_loose)
        {
            list.remove(oldest);
        }
        let entry = Arc::new(Entry {
            key: Key::new(query, arguments),
            asked: AtomicUsize::new(0),
            is_kept: AtomicBool::new(keep),
            program: Once::default(),
            code: Once::default(),
        });
        list.push(entry.clone());
        entry
    }

    /// The entry of a quantity, if there is one.
    pub fn find(&self, query: &Query, arguments: &Arguments) -> Option<Arc<Entry>> {
        let list = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        list.iter().find(|entry| entry.key.is_of(query, arguments)).cloned()
    }
}

/// Identifies a program.
#[derive(Clone, Debug)]
struct Key {
    index: usize,
    frame: Option<FrameId>,
    coordinates: TaskFrame,
    rows: Vec<usize>,
    arguments: Arguments<'static>,
    frames: Vec<FrameId>,
}

impl Key {
    fn new(query: &Query, arguments: &Arguments) -> Self {
        let subject = query.subject;
        Key {
            index: query.index(),
            frame: subject.frame,
            coordinates: subject.coordinates,
            rows: subject.rows.to_vec(),
            arguments: Arguments { wrenches: &[], ..*arguments },
            frames: arguments.wrenches.to_vec(),
        }
    }

    fn is_of(&self, query: &Query, arguments: &Arguments) -> bool {
        let subject = &query.subject;
        self.index == query.index()
            && (self.frame, self.coordinates) == (subject.frame, subject.coordinates)
            && self.rows == subject.rows
            && self.frames == arguments.wrenches
            && self.arguments == Arguments { wrenches: &[], ..*arguments }
    }
}
