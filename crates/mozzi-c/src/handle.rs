//! Handles: C's pointers to objects, with a tag that contains the kind and the copy of the library that made it.

use crate::status::{Outcome, Status, refuse};

/// An object behind a pointer that C holds.
#[repr(C)]
pub struct Handle<T> {
    tag: usize,
    value: T,
}

/// A kind of object.
pub trait Kind: Sized {
    /// Its name in C.
    const NAME: &'static str;
    /// A number of its own in this copy of the library: an address.
    fn tag() -> usize;
}

/// `kind!(Type, "mozzi_name")`.
macro_rules! kind {
    ($T:ty, $name:literal) => {
        impl $crate::handle::Kind for $T {
            const NAME: &'static str = $name;
            #[inline(always)]
            fn tag() -> usize {
                static TAG: u8 = 0;
                &raw const TAG as usize
            }
        }
    };
}
pub(crate) use kind;

/// Checks that a pointer is not null and aligned.
#[inline(always)]
pub fn check_pointer<T>(pointer: *const T, name: &str) -> Outcome {
    if pointer.is_null() || !pointer.is_aligned() { invalid_pointer(pointer.is_null(), name) } else { Ok(()) }
}

#[cold]
#[inline(never)]
fn invalid_pointer(is_null: bool, name: &str) -> Outcome {
    let found = if is_null { "null" } else { "not aligned" };
    refuse!(Status::NULL_POINTER, "{name} is {found}, expected a valid pointer")
}

#[inline(always)]
fn check<T: Kind>(handle: *const Handle<T>) -> Outcome {
    check_pointer(handle, T::NAME)?;
    // SAFETY: not null and aligned; every handle, of whatever kind, begins with its tag.
    if unsafe { (*handle).tag } == T::tag() { Ok(()) } else { invalid_handle(T::NAME) }
}

#[cold]
#[inline(never)]
fn invalid_handle(name: &str) -> Outcome {
    let why = "it is of another kind, freed, or made by another copy of the library";
    refuse!(Status::INVALID_HANDLE, "this is no {name}: {why}")
}

/// The object of a handle.
///
/// # Safety
/// The pointer is null, or that of a handle that lives as long as 'a and is not freed by another thread.
#[inline(always)]
pub unsafe fn borrow<'a, T: Kind>(handle: *const Handle<T>) -> Outcome<&'a T> {
    check(handle)?;
    // SAFETY: it is a handle of this kind, which the caller keeps.
    Ok(unsafe { &(*handle).value })
}

/// Writes a new handle.
///
/// # Safety
/// The pointer is null or may be written.
pub unsafe fn put<T: Kind>(value: T, to: *mut *mut Handle<T>) -> Outcome {
    check_pointer(to, "the place of the result")?;
    let handle = Box::into_raw(Box::new(Handle { tag: T::tag(), value }));
    // SAFETY: checked.
    unsafe { to.write(handle) };
    Ok(())
}

/// Sets the place of a result to null, so that a failure leaves no wild pointer.
///
/// # Safety
/// The pointer is null or may be written.
pub unsafe fn clear<T>(to: *mut *mut Handle<T>) -> Outcome {
    check_pointer(to, "the place of the result")?;
    // SAFETY: checked.
    unsafe { to.write(std::ptr::null_mut()) };
    Ok(())
}

/// Frees an object; null is nothing to free.
///
/// # Safety
/// The pointer is null, or that of a handle that nobody uses.
pub unsafe fn free<T: Kind>(handle: *mut Handle<T>) -> Outcome {
    if handle.is_null() {
        return Ok(());
    }
    check(handle.cast_const())?;
    // SAFETY: made by `put`, and the caller's last use. The tag is erased first, so that a second use is noticed as
    // long as nothing else lies there.
    unsafe {
        (&raw mut (*handle).tag).write_volatile(0);
        drop(Box::from_raw(handle));
    }
    Ok(())
}
