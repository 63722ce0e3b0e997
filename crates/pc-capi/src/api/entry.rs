//! Entries of a model that is built call by call.

use std::ffi::c_char;

use crate::ffi::call_error::CallError;
use crate::ffi::pointer::{numbers, text};
use crate::machinery::draft::{Draft, Section, list, numbers as written};

/// Writes an entry that belongs to something with a name, such as a body; `what` is the argument
/// that holds the name.
pub(crate) fn put(
    draft: &mut Draft,
    (name, what): (*const c_char, &'static str),
    section: Section,
    keys: &[&str],
    value: impl FnOnce() -> Result<String, CallError>,
) -> Result<(), CallError> {
    // SAFETY: null or text, as the preamble demands of the callers.
    let name = unsafe { text(name, what) }?;
    let keys: Vec<&str> = std::iter::once(name).chain(keys.iter().copied()).collect();
    draft.put(section, &keys, value()?);
    Ok(())
}

/// Three expressions as a list.
pub(crate) fn vector([x, y, z]: [*const c_char; 3]) -> Result<String, CallError> {
    // SAFETY: null or text, as the preamble demands of the callers.
    Ok(list(&unsafe { [text(x, "x")?, text(y, "y")?, text(z, "z")?] }))
}

/// Three numbers as a list.
pub(crate) fn direction(axis: *const f64, what: &'static str) -> Result<String, CallError> {
    // SAFETY: null or three numbers, as the preamble demands of the callers.
    let axis = unsafe { numbers(axis, 3, 3, what) }?;
    match axis.iter().find(|component| !component.is_finite()) {
        None => Ok(written(axis)),
        Some(&value) => Err(CallError::NotFinite { what, value }),
    }
}
