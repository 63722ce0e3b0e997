//! Text handed to C.

use std::ffi::{CString, c_char};

/// Frees a text that a function of this library returned for the caller to free. NULL is allowed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_string_free(text: *mut c_char) {
    if !text.is_null() {
        // SAFETY: made by `CString::into_raw` in `give`, and nobody uses it any more.
        drop(unsafe { CString::from_raw(text) });
    }
}

/// The text for C; zero bytes, which would end it, are replaced.
pub(crate) fn c_string(text: &str) -> CString {
    CString::new(text.replace('\0', "\u{fffd}")).unwrap_or_default()
}

/// Each text for C.
pub(crate) fn c_strings<'a>(list: impl IntoIterator<Item = &'a String>) -> Vec<CString> {
    list.into_iter().map(|text| c_string(text)).collect()
}

/// A text that C is to free with `pc_string_free`.
pub(crate) fn give(text: &str) -> *mut c_char {
    c_string(text).into_raw()
}

/// Text number `index`, null beyond the last.
pub(crate) fn nth(list: &[CString], index: usize) -> *const c_char {
    list.get(index).map_or(std::ptr::null(), |text| text.as_ptr())
}
