//! Pointers from C as references and slices, checked as far as they can be.

use std::ffi::{CStr, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::slice;

use crate::ffi::call_error::CallError;

/// The object to which a handle points.
///
/// # Safety
/// Null, or a live handle of that type.
pub(crate) unsafe fn handle<'a, T>(handle: *const T, what: &'static str) -> Result<&'a T, CallError> {
    // SAFETY: as promised.
    unsafe { handle.as_ref() }.ok_or_else(|| CallError::Null { what })
}

/// The `expected` numbers at `data`, where, according to the caller, there are `found` numbers.
///
/// # Safety
/// Null, or `found` numbers that nobody changes during the call.
pub(crate) unsafe fn numbers<'a>(
    data: *const f64,
    found: usize,
    expected: usize,
    what: &'static str,
) -> Result<&'a [f64], CallError> {
    check(data, found, expected, what)?;
    if expected == 0 {
        return Ok(&[]);
    }
    // SAFETY: not null, aligned, and `found` = `expected` numbers as promised.
    Ok(unsafe { slice::from_raw_parts(data, expected) })
}

/// `len` integers, such as indices.
///
/// # Safety
/// Null, or `len` integers that nobody changes during the call; they are plain integers, for which any bytes are valid.
pub(crate) unsafe fn integers<'a, T: Copy>(
    data: *const T,
    len: usize,
    what: &'static str,
) -> Result<&'a [T], CallError> {
    possible(data, len, what)?;
    if len == 0 {
        return Ok(&[]);
    }
    // SAFETY: not null, aligned, and as many as promised.
    Ok(unsafe { slice::from_raw_parts(data, len) })
}

/// Memory for `expected` numbers at `data`, all set to NaN; according to the caller, there is room
/// for `found` numbers.
///
/// # Safety
/// Null, or room for `found` numbers that nobody else uses during the call.
pub(crate) unsafe fn room<'a>(
    data: *mut f64,
    found: usize,
    expected: usize,
    what: &'static str,
) -> Result<&'a mut [f64], CallError> {
    check(data, found, expected, what)?;
    if expected == 0 {
        return Ok(&mut []);
    }
    // SAFETY: not null, aligned, and `found` = `expected` numbers as promised.
    Ok(unsafe { fresh(data, expected) })
}

/// The `len` numbers at `data`, all set to NaN.
///
/// # Safety
/// Room for `len` numbers that nobody else uses during the call; it may still be uninitialised.
#[inline]
pub(crate) unsafe fn fresh<'a>(data: *mut f64, len: usize) -> &'a mut [f64] {
    for i in 0..len {
        // SAFETY: within the room promised.
        unsafe { data.add(i).write(f64::NAN) };
    }
    // SAFETY: initialised just now, and nobody else's as promised.
    unsafe { slice::from_raw_parts_mut(data, len) }
}

fn check(data: *const f64, found: usize, expected: usize, what: &'static str) -> Result<(), CallError> {
    if found != expected {
        return Err(CallError::Length { what, found, expected });
    }
    possible(data, expected, what)
}

/// Refuses an array whose address or length is impossible.
fn possible<T>(data: *const T, len: usize, what: &'static str) -> Result<(), CallError> {
    if len == 0 {
        return Ok(());
    }
    if data.is_null() {
        return Err(CallError::Null { what });
    }
    let most = isize::MAX as usize / size_of::<T>();
    if len > most {
        return Err(CallError::TooLong { what, found: len, most });
    }
    aligned(data, what)
}

/// Refuses a pointer that is not aligned for its type.
pub(crate) fn aligned<T>(data: *const T, what: &'static str) -> Result<(), CallError> {
    if data.is_aligned() { Ok(()) } else { Err(CallError::Misaligned { what, alignment: align_of::<T>() }) }
}

/// Refuses input and output arrays that share memory, before either is made a slice.
pub(crate) fn apart(
    first: (*const f64, usize, &'static str),
    second: (*const f64, usize, &'static str),
) -> Result<(), CallError> {
    if are_apart((first.0, first.1), (second.0, second.1)) {
        Ok(())
    } else {
        Err(CallError::Overlap { first: first.2, second: second.2 })
    }
}

/// Whether the pointers can be those of two arrays of numbers that share no memory.
#[inline]
pub(crate) fn are_usable(first: (*const f64, usize), second: (*const f64, usize)) -> bool {
    let there = |data: *const f64| !data.is_null() && data.is_aligned();
    there(first.0) && there(second.0) && are_apart(first, second)
}

/// Whether arrays share no memory.
#[inline]
fn are_apart(first: (*const f64, usize), second: (*const f64, usize)) -> bool {
    let range = |(data, len): (*const f64, usize)| {
        let start = data as usize;
        (start, start.wrapping_add(len.wrapping_mul(size_of::<f64>())))
    };
    let ((a, a_end), (b, b_end)) = (range(first), range(second));
    a_end <= b || b_end <= a
}

/// The text of a C string.
///
/// # Safety
/// Null, or zero-terminated text that nobody changes during the call.
pub(crate) unsafe fn text<'a>(text: *const c_char, what: &'static str) -> Result<&'a str, CallError> {
    if text.is_null() {
        return Err(CallError::Null { what });
    }
    // SAFETY: not null, and then as promised.
    let text = unsafe { CStr::from_ptr(text) };
    text.to_str().map_err(|error| CallError::NotText { what, offset: error.valid_up_to() })
}

/// `len` bytes.
///
/// # Safety
/// Null, or `len` bytes that nobody changes during the call.
pub(crate) unsafe fn bytes<'a>(
    data: *const c_char,
    len: usize,
    what: &'static str,
) -> Result<&'a [u8], CallError> {
    possible(data, len, what)?;
    if len == 0 {
        return Ok(&[]);
    }
    // SAFETY: not null, and then as promised.
    Ok(unsafe { slice::from_raw_parts(data.cast(), len) })
}

/// Writes a result.
///
/// # Safety
/// Null, or a pointer to memory for a `T`.
pub(crate) unsafe fn write<T>(place: *mut T, value: T, what: &'static str) -> Result<(), CallError> {
    if place.is_null() {
        return Err(CallError::Null { what });
    }
    // SAFETY: not null, and then as promised.
    unsafe { place.write(value) };
    Ok(())
}

/// Refuses a null pointer for a result before any work is done; otherwise writes null to it in case
/// the work fails.
///
/// # Safety
/// Null, or a pointer to memory for a pointer.
pub(crate) unsafe fn clear<T>(place: *mut *mut T, what: &'static str) -> Result<(), CallError> {
    // SAFETY: as promised.
    unsafe { write(place, std::ptr::null_mut(), what) }
}

/// The number, if it is finite.
pub(crate) fn finite(value: f64, what: &'static str) -> Result<f64, CallError> {
    if value.is_finite() { Ok(value) } else { Err(CallError::NotFinite { what, value }) }
}

/// The texts of an array of C strings.
///
/// # Safety
/// Null, or `length` pointers, each null or zero-terminated text that nobody changes during the
/// call.
pub(crate) unsafe fn texts<'a>(
    list: *const *const c_char,
    length: usize,
    what: &'static str,
) -> Result<Vec<&'a str>, CallError> {
    possible(list, length, what)?;
    if length == 0 {
        return Ok(Vec::new());
    }
    // SAFETY: not null, and then as promised.
    let list = unsafe { slice::from_raw_parts(list, length) };
    // SAFETY: as promised.
    list.iter().map(|&entry| unsafe { text(entry, what) }).collect()
}

/// Frees a box that was given to C.
///
/// # Safety
/// Null, or made by `Box::into_raw` and used by nobody any more.
pub(crate) unsafe fn free<T>(boxed: *mut T) {
    if !boxed.is_null() {
        // Unwind safe: nobody sees the box again.
        let _ = catch_unwind(AssertUnwindSafe(|| {
            // SAFETY: not null, and then as promised.
            drop(unsafe { Box::from_raw(boxed) });
        }));
    }
}
