//! Diagnostics of a file, as records and as text.

use crate::border::c_string;
use crate::handle::{Handle, borrow, check_pointer, free, kind};
use crate::status::{Status, guard, guard_or, refuse};
use mozzi_urdf::{Diagnostic, LoadError, Loaded};
use std::ffi::{CString, c_char};

/// The diagnostics of one file.
pub struct Diagnostics {
    records: Vec<Owned>,
    text: CString,
}

kind!(Diagnostics, "mozzi_diagnostics");

/// `struct mozzi_diagnostics`.
pub type DiagnosticsHandle = Handle<Diagnostics>;

/// `mozzi_diagnostic`: texts live as long as the diagnostics.
#[repr(C)]
#[derive(Debug)]
pub struct Record {
    is_error: i32,
    consequence: i32,
    code: *const c_char,
    message: *const c_char,
    file: *const c_char,
    line: usize,
    column: usize,
    calls: *const c_char,
    help: *const c_char,
    text: *const c_char,
}

struct Owned {
    is_error: bool,
    consequence: i32,
    line: usize,
    column: usize,
    code: CString,
    message: CString,
    file: CString,
    calls: CString,
    help: Option<CString>,
    text: CString,
}

impl Diagnostics {
    pub fn new(found: &Result<Loaded, LoadError>) -> Self {
        let (list, text): (Vec<&Diagnostic>, String) = match found {
            Ok(loaded) => {
                let lines: Vec<String> = loaded.warnings.iter().map(ToString::to_string).collect();
                (loaded.warnings.iter().chain(&loaded.unused).collect(), lines.join("\n"))
            }
            Err(error) => (error.diagnostics().iter().collect(), error.to_string()),
        };
        Diagnostics { records: list.into_iter().map(Owned::new).collect(), text: c_string(&text) }
    }
}

impl Owned {
    fn new(found: &Diagnostic) -> Self {
        Owned {
            is_error: found.severity() == mozzi_urdf::Severity::Error,
            consequence: found.consequence() as i32,
            line: found.line(),
            column: found.column(),
            code: c_string(found.code()),
            message: c_string(found.message()),
            file: c_string(found.file()),
            calls: c_string(found.calls()),
            help: found.help().map(c_string),
            text: c_string(&found.to_string()),
        }
    }
}

/// How many there are; 0 for an invalid handle.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_diagnostics_count(diagnostics: *const DiagnosticsHandle) -> usize {
    // SAFETY: the caller's promise, as everywhere in this file.
    guard_or(0, || unsafe { Ok(borrow(diagnostics)?.records.len()) })
}

/// The record of this number.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_diagnostics_get(
    diagnostics: *const DiagnosticsHandle,
    k: usize,
    to: *mut Record,
) -> Status {
    // SAFETY: as above.
    guard(|| unsafe {
        let list = &borrow(diagnostics)?.records;
        check_pointer(to.cast_const(), "diagnostic")?;
        let Some(found) = list.get(k) else {
            return refuse!(Status::NOT_FOUND, "there is no diagnostic {k}: there are {}", list.len());
        };
        to.write(Record {
            is_error: found.is_error.into(),
            consequence: found.consequence,
            code: found.code.as_ptr(),
            message: found.message.as_ptr(),
            file: found.file.as_ptr(),
            line: found.line,
            column: found.column,
            calls: found.calls.as_ptr(),
            help: found.help.as_ref().map_or(std::ptr::null(), |help| help.as_ptr()),
            text: found.text.as_ptr(),
        });
        Ok(())
    })
}

/// All of them as text, one per line; null for an invalid handle.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_diagnostics_text(diagnostics: *const DiagnosticsHandle) -> *const c_char {
    // SAFETY: as above.
    guard_or(std::ptr::null(), || unsafe { Ok(borrow(diagnostics)?.text.as_ptr()) })
}

/// Frees them.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_diagnostics_free(diagnostics: *mut DiagnosticsHandle) -> Status {
    // SAFETY: as above.
    guard(|| unsafe { free(diagnostics) })
}
