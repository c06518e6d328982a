//! Ctrl-C: the first stops the computation and keeps the results so far; the second ends the program.

use crate::failure;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, Once, PoisonError};

/// What a shell expects of a program that SIGINT ended.
pub const EXIT_CODE: u8 = 130;

static LISTENING: Once = Once::new();
static ASKED: AtomicBool = AtomicBool::new(false);
/// The file that is being written.
static UNFINISHED: Mutex<Option<PathBuf>> = Mutex::new(None);

/// Makes Ctrl-C set a flag instead of ending the program, for commands that check whether it [`asked`].
pub fn listen() {
    LISTENING.call_once(|| {
        if let Err(error) = ctrlc::set_handler(answer) {
            failure::note(&format!("Ctrl-C will end the program without writing results: {error}"));
        }
    });
}

/// Whether Ctrl-C was pressed.
pub fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}

/// Marks a file as being written: Ctrl-C lets it finish, a second one removes it, so that no truncated file remains.
pub struct Writing;

impl Writing {
    pub fn to(file: &str) -> Self {
        listen();
        *unfinished() = Some(PathBuf::from(file));
        Writing
    }
}

impl Drop for Writing {
    fn drop(&mut self) {
        *unfinished() = None;
    }
}

fn unfinished() -> MutexGuard<'static, Option<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

fn answer() {
    let again = ASKED.swap(true, Ordering::Relaxed);
    let file = unfinished(); // held, so that it is not finished meanwhile
    match (&*file, again) {
        (None, false) => {}
        (None, true) => std::process::exit(i32::from(EXIT_CODE)),
        (Some(file), false) => {
            failure::note(&format!("finishing {}; press Ctrl-C again to abandon it", file.display()));
        }
        (Some(file), true) => {
            give_up(file);
            std::process::exit(i32::from(EXIT_CODE));
        }
    }
}

/// Files alone: a pipe or a device is not ours to remove.
fn give_up(file: &Path) {
    let name = file.display();
    let is_file = std::fs::metadata(file).is_ok_and(|found| found.is_file());
    failure::note(&match is_file.then(|| std::fs::remove_file(file)) {
        Some(Ok(())) => format!("{name} was not finished and has been removed"),
        Some(Err(error)) => format!("{name} was not finished and cannot be removed: {error}"),
        None => format!("{name} is incomplete"),
    });
}
