//! Robots from files, texts and names.

use crate::border::{slice, text};
use crate::diagnostics::{Diagnostics, DiagnosticsHandle};
use crate::handle::{check_pointer, clear, free, put};
use crate::robot::{ModelHandle, put_model};
use crate::status::{Outcome, Status, failure, guard, guard_or, refuse};
use mozzi::model::Base;
use mozzi_urdf::{LoadError, Loaded, Policy, Settings, XacroArguments, embedded};
use std::ffi::c_char;

/// `mozzi_pair`.
#[repr(C)]
#[derive(Debug)]
pub struct Pair {
    name: *const c_char,
    value: *const c_char,
}

/// `mozzi_load_options`.
#[repr(C)]
#[derive(Debug)]
pub struct LoadOptions {
    policy: i32,
    floating: i32,
    xacro_arguments: *const Pair,
    xacro_argument_count: usize,
    packages: *const Pair,
    package_count: usize,
}

/// # Safety
/// As [`slice`] and [`text`].
unsafe fn pairs(pairs: *const Pair, count: usize, name: &str) -> Outcome<Vec<(String, String)>> {
    // SAFETY: the caller's promise.
    let pair = |pair: &Pair| unsafe { Ok((text(pair.name, name)?.to_string(), text(pair.value, name)?.to_string())) };
    // SAFETY: the caller's promise.
    unsafe { slice(pairs, count, name)? }.iter().map(pair).collect()
}

/// How to read, and whether the base is to float.
///
/// # Safety
/// The pointer is null, or that of valid options.
unsafe fn settings(options: *const LoadOptions) -> Outcome<(Settings, bool)> {
    if options.is_null() {
        return Ok((Settings::default(), false));
    }
    check_pointer(options, "options")?;
    // SAFETY: the caller's promise.
    let options = unsafe { &*options };
    let policy = match options.policy {
        0 => Policy::Default,
        1 => Policy::Strict,
        2 => Policy::Lenient,
        other => return refuse!(Status::INVALID_ARGUMENT, "options.policy is {other}, expected a MOZZI_POLICY_…"),
    };
    // SAFETY: the caller's promise.
    let (values, packages) = unsafe {
        let packages = pairs(options.packages, options.package_count, "options.packages")?;
        (pairs(options.xacro_arguments, options.xacro_argument_count, "options.xacro_arguments")?, packages)
    };
    let packages = packages.into_iter().map(|(name, folder)| (name, folder.into())).collect();
    Ok((
        Settings { policy, xacro: XacroArguments { values, packages, ..XacroArguments::default() } },
        options.floating != 0,
    ))
}

/// Reads by this function, then writes the model and the diagnostics.
///
/// # Safety
/// The pointers are null or valid.
unsafe fn load(
    options: *const LoadOptions,
    model: *mut *mut ModelHandle,
    diagnostics: *mut *mut DiagnosticsHandle,
    read: impl FnOnce(Settings) -> Result<Loaded, LoadError>,
) -> Outcome {
    // SAFETY: the caller's promise.
    unsafe {
        clear(model)?;
        if !diagnostics.is_null() {
            clear(diagnostics)?;
        }
        let (settings, floating) = settings(options)?;
        let found = read(settings);
        if !diagnostics.is_null() {
            put(Diagnostics::new(&found), diagnostics)?;
        }
        let built = found.and_then(Loaded::build).map_err(|error| of_loader(&error))?;
        put_model(if floating { built.with_base(Base::Floating) } else { Ok(built) }, model)
    }
}

fn of_loader(error: &LoadError) -> Status {
    let status = match error {
        LoadError::File { .. } => Status::NO_FILE,
        LoadError::NoSuchRobot { .. } => Status::NOT_FOUND,
        _ => Status::REFUSED,
    };
    failure(status, format_args!("{error}"))
}

/// A file, or else an embedded robot.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_model_open(
    name_or_path: *const c_char,
    options: *const LoadOptions,
    model: *mut *mut ModelHandle,
    diagnostics: *mut *mut DiagnosticsHandle,
) -> Status {
    // SAFETY: the caller's promise, as everywhere in this file.
    guard(|| unsafe {
        let name = text(name_or_path, "name_or_path")?;
        load(options, model, diagnostics, |settings| mozzi_urdf::open_with(name, settings))
    })
}

/// A file.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_model_load(
    path: *const c_char,
    options: *const LoadOptions,
    model: *mut *mut ModelHandle,
    diagnostics: *mut *mut DiagnosticsHandle,
) -> Status {
    // SAFETY: as above.
    guard(|| unsafe {
        let path = text(path, "path")?;
        load(options, model, diagnostics, |settings| mozzi_urdf::load_with(path, settings))
    })
}

/// A text.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_model_parse(
    name: *const c_char,
    content: *const c_char,
    length: usize,
    options: *const LoadOptions,
    model: *mut *mut ModelHandle,
    diagnostics: *mut *mut DiagnosticsHandle,
) -> Status {
    // SAFETY: as above.
    guard(|| unsafe {
        let (name, content) = (text(name, "name")?, slice(content.cast::<u8>(), length, "text")?);
        load(options, model, diagnostics, |settings| mozzi_urdf::parse_with(name, content, settings))
    })
}

/// An embedded robot.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_model_embedded(name: *const c_char, model: *mut *mut ModelHandle) -> Status {
    // SAFETY: as above.
    guard(|| unsafe {
        let name = text(name, "name")?;
        load(std::ptr::null(), model, std::ptr::null_mut(), |settings| match embedded::text(name) {
            Some(text) => mozzi_urdf::parse_with(&format!("{name}.urdf"), text, settings),
            None => Err(LoadError::NoSuchRobot { name: name.into() }),
        })
    })
}

/// Another handle of the same model.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_model_copy(model: *const ModelHandle, copy: *mut *mut ModelHandle) -> Status {
    // SAFETY: as above.
    guard(|| unsafe {
        clear(copy)?;
        put(crate::handle::borrow(model)?.clone(), copy)
    })
}

/// Frees a handle.
///
/// # Safety
/// See mozzi.h.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mozzi_model_free(model: *mut ModelHandle) -> Status {
    // SAFETY: as above.
    guard(|| unsafe { free(model) })
}

/// The number of embedded robots.
#[unsafe(no_mangle)]
pub extern "C" fn mozzi_embedded_count() -> usize {
    embedded::names().len()
}

/// The text of an embedded robot's name; null if there is none of this number.
#[unsafe(no_mangle)]
pub extern "C" fn mozzi_embedded_name(k: usize) -> *const c_char {
    static NAMES: std::sync::OnceLock<Vec<std::ffi::CString>> = std::sync::OnceLock::new();
    guard_or(std::ptr::null(), || {
        let names = NAMES.get_or_init(|| embedded::names().map(crate::border::c_string).collect());
        Ok(names.get(k).map_or(std::ptr::null(), |name| name.as_ptr()))
    })
}
