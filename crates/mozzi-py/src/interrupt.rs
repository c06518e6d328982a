//! Ctrl-C while Rust computes.

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

/// The time between two looks at Python's signals.
const LOOK: Duration = Duration::from_millis(50);

/// Looks at Python's signals, and keeps the exception that they raised.
pub struct Interrupt {
    raised: Mutex<Option<PyErr>>,
    is_raised: AtomicBool,
    looked: Mutex<Instant>,
}

impl Interrupt {
    pub fn new() -> Self {
        Interrupt { raised: Mutex::new(None), is_raised: AtomicBool::new(false), looked: Mutex::new(Instant::now()) }
    }

    /// Whether an exception was raised.
    pub fn is_raised(&self) -> bool {
        self.is_raised.load(Ordering::Relaxed)
    }

    /// Whether to stop. Only Python's main thread gets signals; it must not hold the GIL.
    pub fn stop(&self) -> bool {
        if self.is_raised() {
            return true;
        }
        let Ok(mut looked) = self.looked.lock() else { return false };
        if looked.elapsed() < LOOK {
            return false;
        }
        *looked = Instant::now();
        let Err(error) = Python::attach(|py| py.check_signals()) else { return false };
        if let Ok(mut raised) = self.raised.lock() {
            *raised = Some(error);
        }
        self.is_raised.store(true, Ordering::Relaxed);
        true
    }

    /// # Errors
    /// The exception, if one was raised.
    pub fn check(self) -> PyResult<()> {
        self.raised.into_inner().ok().flatten().map_or(Ok(()), Err)
    }
}

/// Runs work that cannot be stopped on a thread of its own. An interrupt ends the wait: the work goes on, its result is
/// dropped.
///
/// # Errors
/// The exception of a signal.
pub fn waited<T: Send + 'static>(py: Python<'_>, work: impl FnOnce() -> T + Send + 'static) -> PyResult<T> {
    let (to, found) = channel();
    let found = Mutex::new(found); // which `detach` may lend
    let started = thread::Builder::new().spawn(move || drop(to.send(work())));
    started.map_err(|error| PyRuntimeError::new_err(format!("no thread can be started: {error}")))?;
    loop {
        let wait = || found.lock().map_or(Err(RecvTimeoutError::Disconnected), |found| found.recv_timeout(LOOK));
        match py.detach(wait) {
            Ok(result) => return Ok(result),
            Err(RecvTimeoutError::Timeout) => py.check_signals()?,
            Err(RecvTimeoutError::Disconnected) => {
                return Err(PyRuntimeError::new_err("the computation panicked: see above"));
            }
        }
    }
}
