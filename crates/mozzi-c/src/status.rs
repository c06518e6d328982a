//! Statuses, the text of the last failure, and the border that no panic crosses.

use std::cell::UnsafeCell;
use std::ffi::{CStr, c_char};
use std::fmt::{self, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The result of a call: 0, or the reason of the failure.
#[repr(transparent)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Status(pub i32);

/// `NAME = number, text`.
macro_rules! statuses {
    ($($name:ident = $number:literal, $text:literal;)*) => {
        #[allow(missing_docs)] // their texts
        impl Status {
            $(pub const $name: Status = Status($number);)*

            fn text(self) -> &'static CStr {
                match self.0 {
                    $($number => $text,)*
                    _ => c"not a status",
                }
            }
        }
    };
}
statuses! {
    OK = 0, c"ok";
    NULL_POINTER = 1, c"a pointer is null, or not aligned";
    INVALID_HANDLE = 2, c"not a handle of this kind and this library, or freed";
    FOREIGN = 3, c"it belongs to another model";
    BUSY = 4, c"another thread is using this object";
    WRONG_LENGTH = 5, c"wrong length";
    NOT_FINITE = 6, c"an argument is NaN or infinite";
    INVALID_ARGUMENT = 7, c"an argument is outside its domain";
    NOT_FOUND = 8, c"there is nothing of this name or number";
    NO_FILE = 9, c"the file cannot be read";
    REFUSED = 10, c"the robot is refused: see the diagnostics";
    SINGULAR = 11, c"the mass matrix or the task is singular";
    CONSTRAINT = 12, c"the constraints cannot be satisfied";
    DIVERGED = 13, c"the simulation diverged, or does not advance";
    NOT_REACHED = 14, c"the goal is not reached";
    CALLBACK = 15, c"a callback reported a failure";
    FORKED = 16, c"the process forked since this object was created";
    INTERNAL = 17, c"internal error: please report it";
}

/// The result of everything behind the border; the failure's text is already stored.
pub type Outcome<T = ()> = Result<T, Status>;

const ROOM: usize = 2048;

/// Text of fixed size that ends with a NUL.
struct Last {
    bytes: [u8; ROOM],
    length: usize,
}

thread_local! {
    // without a destructor or lazy initialization: nothing is allocated, nothing is registered
    static LAST: UnsafeCell<Last> = const { UnsafeCell::new(Last { bytes: [0; ROOM], length: 0 }) };
}

impl Write for Last {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let mut room = (ROOM - 1 - self.length).min(text.len());
        while !text.is_char_boundary(room) {
            room -= 1;
        }
        self.bytes[self.length..][..room].copy_from_slice(&text.as_bytes()[..room]);
        self.length += room;
        self.bytes[self.length] = 0;
        Ok(())
    }
}

/// Stores the text of a failure, without allocation, and returns its status.
#[cold]
pub fn failure(status: Status, text: fmt::Arguments) -> Status {
    LAST.with(|last| {
        // SAFETY: this thread's own, and no reference to it outlives a call of this file; a `Display` that fails in
        // between would only write into it.
        let last = unsafe { &mut *last.get() };
        last.length = 0;
        last.bytes[0] = 0;
        let _ = last.write_fmt(text); // a longer text is cut
    });
    status
}

/// `Err` of a status with a text.
macro_rules! refuse {
    ($status:expr, $($text:tt)*) => { Err($crate::status::failure($status, format_args!($($text)*))) };
}
pub(crate) use refuse;

/// Runs the body of a function of the border: no panic leaves it.
#[inline(always)]
pub fn guard(body: impl FnOnce() -> Outcome) -> Status {
    // what a panic leaves behind means nothing between calls
    match catch_unwind(AssertUnwindSafe(body)) {
        Ok(Ok(())) => Status::OK,
        Ok(Err(status)) => status,
        Err(panic) => {
            let text = panic.downcast_ref::<String>().map(String::as_str);
            let text = text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("a panic");
            failure(Status::INTERNAL, format_args!("internal error, please report it: {text}"))
        }
    }
}

/// As [`guard`] for functions without a status: this value if it fails.
pub fn guard_or<T>(otherwise: T, body: impl FnOnce() -> Outcome<T>) -> T {
    let mut found = otherwise;
    guard(|| body().map(|value| found = value));
    found
}

/// An error of the library: its status and its text.
pub fn of_model(error: &mozzi::Error) -> Status {
    failure(status_of(error), format_args!("{error}"))
}

fn status_of(error: &mozzi::Error) -> Status {
    use mozzi::Error as E;
    match error {
        E::Invalid { .. } => Status::REFUSED,
        E::WrongLength { .. } => Status::WRONG_LENGTH,
        E::NoSuchFrame { .. } | E::NoSuchJoint { .. } | E::NoSuchState { .. } | E::NoSuchQuantity { .. } => {
            Status::NOT_FOUND
        }
        E::NoEndEffector { .. } => Status::NOT_FOUND,
        E::SingularMassMatrix { .. } | E::SingularTask { .. } => Status::SINGULAR,
        E::Unreachable { .. } | E::Underactuated { .. } => Status::CONSTRAINT,
        _ => Status::INVALID_ARGUMENT,
    }
}

/// An error of a simulation.
pub fn of_simulation(error: &mozzi_sim::Error) -> Status {
    failure(status_of_simulation(error), format_args!("{error}"))
}

fn status_of_simulation(error: &mozzi_sim::Error) -> Status {
    use mozzi_sim::Error as E;
    match error {
        E::Model(error) => status_of(error),
        E::OpenStart { .. } | E::Opened { .. } => Status::CONSTRAINT,
        E::Diverged { .. } | E::Stalled { .. } | E::NoConvergence { .. } => Status::DIVERGED,
        _ => Status::INVALID_ARGUMENT,
    }
}

/// An error of a batch.
pub fn of_batch(error: &mozzi_engine::Error) -> Status {
    use mozzi_engine::Error as E;
    let status = match error {
        E::WrongLength { .. } | E::IncompleteState { .. } => Status::WRONG_LENGTH,
        E::Model(source) => status_of(source),
        E::State { source, .. } | E::Simulation(source) => status_of_simulation(source),
        _ => Status::INVALID_ARGUMENT,
    };
    failure(status, format_args!("{error}"))
}

/// An error of inverse kinematics.
pub fn of_motion(error: &mozzi_motion::Error) -> Status {
    let status = match error {
        mozzi_motion::Error::Model(error) => status_of(error),
        mozzi_motion::Error::Simulation(error) => status_of_simulation(error),
        _ => Status::NOT_REACHED,
    };
    failure(status, format_args!("{error}"))
}

/// A few words about a status; never null.
#[unsafe(no_mangle)]
pub extern "C" fn mozzi_status_text(status: i32) -> *const c_char {
    Status(status).text().as_ptr()
}

/// The text of this thread's last failure; never null, valid until the thread's next failure.
#[unsafe(no_mangle)]
pub extern "C" fn mozzi_last_error() -> *const c_char {
    // SAFETY: always ends with a NUL.
    LAST.with(|last| unsafe { (*last.get()).bytes.as_ptr().cast() })
}
