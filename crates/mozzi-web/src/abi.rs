//! The functions that the WebAssembly exports.
//!
//! A call reads a text argument from the buffer of [`web_text`]; its result or error is a text at [`web_said`]. Arrays
//! of numbers keep their addresses as long as their robot is open. The number −1 and null addresses mean an error. A
//! panic stops the call; its message is at [`web_panic`].

use crate::session::Session;
use std::cell::RefCell;
use std::ptr::{null, null_mut};
use std::sync::Once;

#[derive(Default)]
struct Desk {
    session: Session,
    text: Vec<u8>,
    said: String,
}

thread_local! {
    static DESK: RefCell<Desk> = RefCell::default();
    static PANIC: RefCell<String> = RefCell::default();
}

/// Room for the text, UTF-8 of this length, which the next call reads.
#[unsafe(no_mangle)]
pub extern "C" fn web_text(length: usize) -> *mut u8 {
    remember_panics();
    DESK.with_borrow_mut(|desk| {
        desk.text = vec![0; length];
        desk.text.as_mut_ptr()
    })
}

/// Address of the last call's result or error, a text.
#[unsafe(no_mangle)]
pub extern "C" fn web_said() -> *const u8 {
    DESK.with_borrow(|desk| desk.said.as_ptr())
}

/// Its length in bytes.
#[unsafe(no_mangle)]
pub extern "C" fn web_said_length() -> usize {
    DESK.with_borrow(|desk| desk.said.len())
}

/// The address of the last panic's message.
#[unsafe(no_mangle)]
pub extern "C" fn web_panic() -> *const u8 {
    PANIC.with_borrow(|message| message.as_ptr())
}

/// Its length in bytes.
#[unsafe(no_mangle)]
pub extern "C" fn web_panic_length() -> usize {
    PANIC.with_borrow(String::len)
}

/// Opens the robot of a text, whose first `name_length` bytes are the file's name. Returns a handle; the text is
/// [`Robot::about`](crate::Robot::about).
#[unsafe(no_mangle)]
pub extern "C" fn web_load(name_length: usize) -> i32 {
    answered(-1, |session, text| {
        let (name, text) = text.split_at_checked(name_length).ok_or("the file's name is longer than the text")?;
        let robot = session.load(name, text)?;
        Ok((index(robot), session.about(robot)?.to_string()))
    })
}

/// Opens the robot of dropped files: see [`Session::open`]. Returns a handle and, as JSON, the data that the page
/// needs.
#[cfg(feature = "play")]
#[unsafe(no_mangle)]
pub extern "C" fn web_open() -> i32 {
    answered(-1, |session, text| {
        let (robot, said) = session.open(text)?;
        Ok((index(robot), said.to_string()))
    })
}

/// Carries out the command in the text: see [`Robot::play`](crate::Robot::play). 0, or −1 for an error.
#[cfg(feature = "play")]
#[unsafe(no_mangle)]
pub extern "C" fn web_play(robot: usize) -> i32 {
    answered(-1, |session, text| Ok((0, session.robot(robot)?.play(text)?.to_string())))
}

/// Closes a robot and frees its arrays.
#[unsafe(no_mangle)]
pub extern "C" fn web_close(robot: usize) {
    DESK.with_borrow_mut(|desk| desk.session.close(robot));
}

/// The array of the input with this place in [`mozzi::quantities::INPUTS`].
#[unsafe(no_mangle)]
pub extern "C" fn web_input(robot: usize, input: usize) -> *mut f64 {
    answered(null_mut(), |session, _| Ok((session.robot(robot)?.input(input)?.as_mut_ptr(), String::new())))
}

/// Prepares the request in the text, such as `{"quantity": "body_jacobian", "frame": "tool0"}`. Returns a handle and,
/// as JSON, the request's inputs and outputs.
#[unsafe(no_mangle)]
pub extern "C" fn web_prepare(robot: usize) -> i32 {
    answered(-1, |session, text| {
        let (request, about) = session.robot(robot)?.prepare(text)?;
        Ok((index(request), about.to_string()))
    })
}

/// The array of a request's outputs, one after the other, matrices by rows.
#[unsafe(no_mangle)]
pub extern "C" fn web_output(robot: usize, request: usize) -> *const f64 {
    answered(null(), |session, _| Ok((session.robot(robot)?.output(request)?.as_ptr(), String::new())))
}

/// Computes a request at the current inputs; 0, or −1 for an error.
#[unsafe(no_mangle)]
pub extern "C" fn web_evaluate(robot: usize, request: usize) -> i32 {
    answered(-1, |session, _| {
        session.robot(robot)?.evaluate(request)?;
        Ok((0, String::new()))
    })
}

/// Sets which wrenches the robot applies, by the list in the text: see [`Robot::apply`](crate::Robot::apply). The array
/// has six numbers for each.
#[unsafe(no_mangle)]
pub extern "C" fn web_apply(robot: usize) -> *mut f64 {
    answered(null_mut(), |session, text| Ok((session.robot(robot)?.apply(text)?.as_mut_ptr(), String::new())))
}

/// Replaces the robot's inertial parameters by the JSON list of numbers in the text; 0, or −1 for an error.
#[unsafe(no_mangle)]
pub extern "C" fn web_parameters(robot: usize) -> i32 {
    answered(-1, |session, text| {
        session.robot(robot)?.set_parameters(text)?;
        Ok((0, session.about(robot)?.to_string()))
    })
}

/// Runs a call on the text argument, and stores its result or error as text.
fn answered<T>(failed: T, call: impl FnOnce(&mut Session, &str) -> Result<(T, String), String>) -> T {
    DESK.with_borrow_mut(|desk| {
        let text = std::mem::take(&mut desk.text);
        let text = std::str::from_utf8(&text).map_err(|error| format!("the text is not UTF-8: {error}"));
        match text.and_then(|text| call(&mut desk.session, text)) {
            Ok((answer, said)) => {
                desk.said = said;
                answer
            }
            Err(error) => {
                desk.said = error;
                failed
            }
        }
    })
}

fn index(number: usize) -> i32 {
    i32::try_from(number).unwrap_or(i32::MAX)
}

/// WebAssembly ends a panic in a trap without a message.
fn remember_panics() {
    static ONCE: Once = Once::new();
    if cfg!(target_family = "wasm") {
        ONCE.call_once(|| {
            std::panic::set_hook(Box::new(|panic| {
                PANIC.with(|message| message.try_borrow_mut().map(|mut message| *message = panic.to_string()).ok());
            }));
        });
    }
}
