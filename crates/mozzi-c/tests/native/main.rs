//! Compiles the programs of `tests/programs` by the system's C and C++ compilers, with all warnings as errors and with
//! sanitizers, and runs them against the libraries that this test was built with.

#[allow(dead_code)] // the shapes' texts
#[path = "../header/list.rs"]
mod list;

mod calls;
mod programs;
mod states;
mod toolchain;
