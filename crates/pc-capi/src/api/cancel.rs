//! Ending derivations and integrations from outside.

use std::ffi::c_int;

use pc_expr::Cancel;

use crate::ffi::boundary::entry;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::{clear, free, write};
use crate::ffi::status::pc_status;

/// A handle that ends the derivations of systems whose pc_system_options contain it, and the
/// integrations of these systems. Any number of threads may use it at the same time. Free it with
/// pc_cancel_free.
pub struct pc_cancel {
    pub(crate) cancel: Cancel,
}

/// Makes a handle that can end derivations and integrations.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_cancel_new(cancel: *mut *mut pc_cancel, error: *mut *mut pc_error) -> pc_status {
    let new = || {
        // SAFETY: null or memory for a handle, as the preamble demands.
        unsafe { clear(cancel, "cancel") }?;
        let made = Box::new(pc_cancel { cancel: Cancel::default() });
        // SAFETY: as the preamble demands.
        unsafe { write(cancel, Box::into_raw(made), "cancel") }
    };
    // SAFETY: `error` is null or memory for a pointer.
    unsafe { entry(error, new) }
}

/// Ends derivations and integrations with PC_LIMIT: those under way end soon, and later ones as
/// soon as they begin. It takes no lock and allocates nothing: it is the one function that a signal
/// handler may call. NULL is allowed.
#[unsafe(no_mangle)]
pub extern "C" fn pc_cancel_request(cancel: Option<&pc_cancel>) {
    if let Some(handle) = cancel {
        handle.cancel.cancel();
    }
}

/// Returns 1 after pc_cancel_request, else 0; 0 for NULL.
#[unsafe(no_mangle)]
pub extern "C" fn pc_cancel_is_requested(cancel: Option<&pc_cancel>) -> c_int {
    cancel.map_or(0, |handle| handle.cancel.is_cancelled().into())
}

/// Frees a handle; systems whose options contain it continue without it. NULL is allowed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_cancel_free(cancel: *mut pc_cancel) {
    // SAFETY: null or a handle of ours that nobody uses any more.
    unsafe { free(cancel) };
}
