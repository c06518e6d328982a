//! From C's pointers to slices and texts.

use crate::handle::check_pointer;
use crate::status::{Outcome, Status, refuse};
use std::ffi::{CStr, CString, c_char};

/// A slice of this many entries; none if there are no entries, whatever the pointer.
///
/// # Safety
/// The pointer is null, or that many entries may be read as long as 'a.
#[inline(always)]
pub unsafe fn slice<'a, T>(pointer: *const T, length: usize, name: &str) -> Outcome<&'a [T]> {
    if length == 0 {
        return Ok(&[]);
    }
    check_pointer(pointer, name)?;
    // SAFETY: not null, aligned; the length is the caller's promise.
    Ok(unsafe { std::slice::from_raw_parts(pointer, length) })
}

/// As [`slice`], to be written.
///
/// # Safety
/// The pointer is null, or that many entries may be written as long as 'a, and nobody else uses them.
#[inline(always)]
pub unsafe fn slice_mut<'a, T>(pointer: *mut T, length: usize, name: &str) -> Outcome<&'a mut [T]> {
    if length == 0 {
        return Ok(&mut []);
    }
    check_pointer(pointer.cast_const(), name)?;
    // SAFETY: as above.
    Ok(unsafe { std::slice::from_raw_parts_mut(pointer, length) })
}

/// The place of numbers in memory.
pub type Span = (*const f64, usize);

pub fn span(numbers: &[f64]) -> Span {
    (numbers.as_ptr(), numbers.len())
}

/// True if two arrays share memory.
#[inline(always)]
pub fn overlap((a, a_length): Span, (b, b_length): Span) -> bool {
    let (a, b) = (a.addr(), b.addr());
    a < b.wrapping_add(8 * b_length) && b < a.wrapping_add(8 * a_length)
}

/// Checks that an array that is written overlaps none of these.
pub fn check_apart<'a>(name: &str, written: Span, others: impl IntoIterator<Item = (&'a str, Span)>) -> Outcome {
    match others.into_iter().find(|(_, other)| written.1 > 0 && other.1 > 0 && overlap(written, *other)) {
        Some((other, _)) => {
            refuse!(Status::INVALID_ARGUMENT, "{name} overlaps {other}, expected arrays of their own")
        }
        None => Ok(()),
    }
}

/// Copies numbers out.
///
/// # Safety
/// The pointer is null, or as many entries may be written.
pub unsafe fn copy_out<T: Copy>(from: &[T], to: *mut T, name: &str) -> Outcome {
    if from.is_empty() {
        return Ok(());
    }
    check_pointer(to.cast_const(), name)?;
    // SAFETY: checked; `copy` allows overlap.
    unsafe { std::ptr::copy(from.as_ptr(), to, from.len()) };
    Ok(())
}

/// Writes one value, if the pointer is not null.
///
/// # Safety
/// The pointer is null or may be written.
pub unsafe fn put_if_wanted<T>(value: T, to: *mut T, name: &str) -> Outcome {
    if !to.is_null() {
        check_pointer(to.cast_const(), name)?;
        // SAFETY: checked.
        unsafe { to.write(value) };
    }
    Ok(())
}

/// A text that ends with a NUL, in UTF-8.
///
/// # Safety
/// The pointer is null or that of a text that ends with a NUL and lives as long as 'a.
pub unsafe fn text<'a>(pointer: *const c_char, name: &str) -> Outcome<&'a str> {
    check_pointer(pointer, name)?;
    // SAFETY: the caller's promise.
    match unsafe { CStr::from_ptr(pointer) }.to_str() {
        Ok(text) => Ok(text),
        Err(error) => refuse!(Status::INVALID_ARGUMENT, "{name} is not UTF-8: {error}"),
    }
}

/// Texts that end with a NUL.
///
/// # Safety
/// As [`slice`] and [`text`].
pub unsafe fn texts<'a>(pointer: *const *const c_char, count: usize, name: &str) -> Outcome<Vec<&'a str>> {
    // SAFETY: the caller's promise.
    unsafe { slice(pointer, count, name)?.iter().map(|&pointer| text(pointer, name)).collect() }
}

/// A text for C; a NUL inside becomes a space.
pub fn c_string(text: &str) -> CString {
    CString::new(text.replace('\0', " ")).unwrap_or_default()
}

/// True if every number is finite. A scalar loop: the arrays are short, and a vectorized loop would start slower.
#[inline(always)]
pub fn are_finite(numbers: &[f64]) -> bool {
    numbers.iter().all(|x| x.is_finite())
}

/// Checks that every number is finite.
#[inline(always)]
pub fn check_finite(numbers: &[f64], name: &str) -> Outcome {
    if are_finite(numbers) { Ok(()) } else { not_finite(numbers, name) }
}

#[cold]
fn not_finite(numbers: &[f64], name: &str) -> Outcome {
    let (place, number) = numbers.iter().enumerate().find(|(_, x)| !x.is_finite()).unwrap_or((0, &f64::NAN));
    refuse!(Status::NOT_FINITE, "{name}[{place}] is {number}, expected a finite number")
}

/// Checks a length that the caller gave.
#[inline(always)]
pub fn check_length(name: &str, found: usize, expected: usize) -> Outcome {
    if found == expected {
        return Ok(());
    }
    refuse!(Status::WRONG_LENGTH, "{name} has {found} entries, expected {expected}")
}
