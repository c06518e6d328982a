//! The quantities as methods of the class `Model`: one descriptor for each entry of the list, by Python's stable
//! interface, since `#[pymethods]` wants each method written out. Its `unsafe` is all here.

use super::documentation::documentation;
use super::quantity::call;
use crate::signature::{CLASSES, Signature};
use mozzi::quantities::{self, Declaration, LIST, Query};
use pyo3::ffi;
use pyo3::panic::PanicException;
use pyo3::prelude::*;
use pyo3::types::{PyTuple, PyType};
use std::ffi::CString;
use std::panic::{AssertUnwindSafe, catch_unwind};

type Method = unsafe extern "C" fn(
    *mut ffi::PyObject,
    *const *mut ffi::PyObject,
    ffi::Py_ssize_t,
    *mut ffi::PyObject,
) -> *mut ffi::PyObject;

/// The functions that Python calls, in the order of the list.
const METHODS: &[Method] = {
    macro_rules! methods {
        ($($Q:ident)*) => { &[$({
            unsafe extern "C" fn method(
                this: *mut ffi::PyObject,
                values: *const *mut ffi::PyObject,
                positional: ffi::Py_ssize_t,
                names: *mut ffi::PyObject,
            ) -> *mut ffi::PyObject {
                // SAFETY: the arguments are the ones that Python passed.
                unsafe { enter(Query::from(quantities::$Q).index(), this, values, positional, names) }
            }
            method
        }),*] };
    }
    mozzi::quantities!(methods)
};

/// Returns a new reference, or null with Python's error set.
///
/// # Safety
/// The arguments are those of a call of a method with `METH_FASTCALL | METH_KEYWORDS`, by a thread that holds Python's
/// lock.
unsafe fn enter(
    index: usize,
    this: *mut ffi::PyObject,
    values: *const *mut ffi::PyObject,
    positional: ffi::Py_ssize_t,
    names: *mut ffi::PyObject,
) -> *mut ffi::PyObject {
    // SAFETY: the caller holds the lock, and keeps `this`, the values and the tuple of names while the method runs. A
    // `Borrowed` is a transparent pointer, and there is a value for each positional argument and each name.
    let (py, this, values, names) = unsafe {
        let py = Python::assume_attached();
        let names = Borrowed::from_ptr_or_opt(py, names).map(|names| names.cast_unchecked::<PyTuple>());
        let count = positional as usize + names.map_or(0, |names| names.len());
        let values: &[Borrowed<'_, '_, PyAny>] = match count {
            0 => &[],
            _ => std::slice::from_raw_parts(values.cast(), count),
        };
        (py, Borrowed::from_ptr(py, this), values, names)
    };
    let (values, named) = values.split_at(positional as usize);
    // memory left by a panic means nothing between calls
    let found = catch_unwind(AssertUnwindSafe(|| call(index, &this, values, names, named)));
    let error = match found {
        Ok(Ok(found)) => return found.into_ptr(),
        Ok(Err(error)) => error,
        Err(panic) => {
            let text = panic.downcast_ref::<String>().cloned();
            let text = text.or_else(|| panic.downcast_ref::<&str>().map(ToString::to_string));
            PanicException::new_err(text.unwrap_or_default())
        }
    };
    error.restore(py);
    std::ptr::null_mut()
}

/// Adds a first line that `inspect.signature` reads.
fn help(declaration: &Declaration, class_of_results: &str) -> String {
    let signature = Signature::new(declaration).text("$self", false);
    format!("{}({signature})\n--\n\n{}", declaration.name, documentation(declaration, class_of_results))
}

/// Adds a method to the class for each quantity.
pub fn add_to(class: &Bound<'_, PyType>) -> PyResult<()> {
    for ((declaration, &method), class_of_results) in LIST.iter().zip(METHODS).zip(CLASSES) {
        // the class is never freed, nor are its methods
        let definition = Box::leak(Box::new(ffi::PyMethodDef {
            ml_name: CString::new(declaration.name)?.into_raw(),
            ml_meth: ffi::PyMethodDefPointer { PyCFunctionFastWithKeywords: method },
            ml_flags: ffi::METH_FASTCALL | ffi::METH_KEYWORDS,
            ml_doc: CString::new(help(declaration, class_of_results))?.into_raw(),
        }));
        // SAFETY: the definition and its texts are never freed; the function is of the kind that the flags name.
        let descriptor = unsafe {
            let made = ffi::PyDescr_NewMethod(class.as_type_ptr(), definition);
            Bound::from_owned_ptr_or_err(class.py(), made)?
        };
        class.setattr(declaration.name, descriptor)?;
    }
    Ok(())
}
