//! mozzi in C and C++: the functions of `include/mozzi/mozzi.h`, as a static and a shared library.
//!
//! No mathematics is here: a call checks its arguments, computes by [`mozzi::fast`], machine code or a batch, and
//! returns a status. Nothing unwinds across the border. Calls on a workspace allocate nothing.
#![allow(clippy::missing_safety_doc)] // mozzi.h has it

mod batch;
mod border;
mod call;
mod diagnostics;
mod edits;
mod environment;
mod handle;
mod inverse_kinematics;
mod load;
mod program;
mod properties;
mod quantity;
mod robot;
mod simulate;
mod states;
mod status;
mod subject;
mod typed;
mod workspace;

use std::ffi::c_char;

/// The version of the library; never null.
#[unsafe(no_mangle)]
pub extern "C" fn mozzi_version() -> *const c_char {
    const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), "\0");
    VERSION.as_ptr().cast()
}

/// The number in the soname: programs built for another cannot use this library.
#[unsafe(no_mangle)]
pub extern "C" fn mozzi_abi_version() -> u32 {
    0
}
