//! Ctrl-C: once, and what is being computed ends with what there is; twice, and the program ends.

use crate::failure;
use std::sync::Once;
use std::sync::atomic::{AtomicBool, Ordering};

/// What a shell expects of a program that SIGINT ended.
pub const EXIT_CODE: u8 = 130;

static LISTENING: Once = Once::new();
static ASKED: AtomicBool = AtomicBool::new(false);

/// From here on Ctrl-C asks instead of ending the program: for commands that look whether it [`asked`].
pub fn listen() {
    let answer = || {
        if ASKED.swap(true, Ordering::Relaxed) {
            std::process::exit(i32::from(EXIT_CODE));
        }
    };
    LISTENING.call_once(|| {
        if let Err(error) = ctrlc::set_handler(answer) {
            failure::note(&format!("Ctrl-C will end the program without a result: {error}"));
        }
    });
}

/// Has it been asked to end?
pub fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}
