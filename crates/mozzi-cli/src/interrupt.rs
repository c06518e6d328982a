//! Ctrl-C: the first stops the computation and keeps the results so far; the second ends the program.

use crate::{exit, failure};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, Once, PoisonError};

static LISTENING: Once = Once::new();
static ASKED: AtomicBool = AtomicBool::new(false);
static AT_ONCE: AtomicBool = AtomicBool::new(false);
/// The file that is being written.
static UNFINISHED: Mutex<Option<Unfinished>> = Mutex::new(None);

struct Unfinished {
    file: String,
    /// The temporary file until it is complete; none for a pipe or a device.
    part: Option<PathBuf>,
}

/// Makes Ctrl-C set a flag instead of ending the program, for commands that check [`is_requested`].
pub fn listen() {
    LISTENING.call_once(|| {
        if let Err(error) = ctrlc::set_handler(answer) {
            failure::note(&format!("Ctrl-C will end the program without writing results: {error}"));
        }
    });
}

/// Makes the next Ctrl-C end the program: there are no results to keep.
pub fn end_at_once() {
    listen();
    AT_ONCE.store(true, Ordering::Relaxed);
}

/// Whether Ctrl-C was pressed.
pub fn is_requested() -> bool {
    ASKED.load(Ordering::Relaxed)
}

/// Marks a file as being written: Ctrl-C lets it finish, a second one abandons it, so that no truncated file remains.
pub struct Writing;

impl Writing {
    /// Writes to this file, or to the temporary file `part` until it is complete.
    pub fn to(file: &str, part: Option<&Path>) -> Self {
        listen();
        *unfinished() = Some(Unfinished { file: file.to_string(), part: part.map(Path::to_path_buf) });
        Writing
    }
}

impl Drop for Writing {
    fn drop(&mut self) {
        *unfinished() = None;
    }
}

fn unfinished() -> MutexGuard<'static, Option<Unfinished>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

fn answer() {
    let again = ASKED.swap(true, Ordering::Relaxed) || AT_ONCE.load(Ordering::Relaxed);
    let file = unfinished(); // the lock is held, so that the file is not finished meanwhile
    match (&*file, again) {
        (None, false) => {}
        (None, true) => std::process::exit(i32::from(exit::STOPPED)),
        (Some(Unfinished { file, .. }), false) => {
            failure::note(&format!("finishing {file}; press Ctrl-C again to abandon it"));
        }
        (Some(unfinished), true) => {
            give_up(unfinished);
            std::process::exit(i32::from(exit::STOPPED));
        }
    }
}

fn give_up(Unfinished { file, part }: &Unfinished) {
    failure::note(&match part.as_ref().map(std::fs::remove_file) {
        Some(Ok(())) => format!("{file} was not finished and is as it was before"),
        Some(Err(error)) => format!("{file} was not finished; a part of it cannot be removed: {error}"),
        None => format!("{file} is incomplete"),
    });
}
