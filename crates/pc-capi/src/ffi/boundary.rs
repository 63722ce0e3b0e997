//! The boundary: what every function does at its beginning and end.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr;

use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::status::pc_status;

/// Runs `body`, catching panics, and writes its error to `*error`, or null if there is none.
///
/// # Safety
/// `error` is null or memory for a pointer.
pub(crate) unsafe fn entry(
    error: *mut *mut pc_error,
    body: impl FnOnce() -> Result<(), CallError>,
) -> pc_status {
    // Unwind safe: what a panic leaves half done is in an `Exclusive`, which refuses further use.
    let outcome = catch_unwind(AssertUnwindSafe(|| match body() {
        Ok(()) => (pc_status::PC_OK, ptr::null_mut()),
        Err(fault @ (CallError::Stopped | CallError::Terminal)) => (fault.status(), ptr::null_mut()),
        Err(fault) if error.is_null() => (fault.status(), ptr::null_mut()),
        Err(fault) => (fault.status(), Box::into_raw(Box::new(fault.into_error()))),
    }));
    let (status, written) = outcome.unwrap_or_else(|panic| {
        let fault = CallError::Panic { message: message_of(panic) };
        (fault.status(), Box::into_raw(Box::new(fault.into_error())))
    });
    if !error.is_null() {
        // SAFETY: not null, and then memory for a pointer.
        unsafe { error.write(written) };
    } else if !written.is_null() {
        // SAFETY: boxed just now.
        drop(unsafe { Box::from_raw(written) });
    }
    status
}

/// Writes null to `*error`.
///
/// # Safety
/// `error` is null or memory for a pointer.
#[inline]
pub(crate) unsafe fn succeeded(error: *mut *mut pc_error) -> pc_status {
    if !error.is_null() {
        // SAFETY: not null, and then memory for a pointer.
        unsafe { error.write(ptr::null_mut()) };
    }
    pc_status::PC_OK
}

/// The message of a panic.
fn message_of(panic: Box<dyn Any + Send>) -> String {
    let message = panic
        .downcast_ref::<String>()
        .cloned()
        .or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_owned()))
        .unwrap_or_else(|| "a panic".to_owned());
    // A payload that is not text might panic again when it is dropped.
    let _ = catch_unwind(AssertUnwindSafe(|| drop(panic)));
    message
}

#[cfg(test)]
mod tests {
    use std::ffi::CStr;

    use super::*;
    use crate::ffi::error::{pc_error_free, pc_error_message};
    use crate::machinery::exclusive::Exclusive;

    /// The status and the message of a call of `body`.
    fn called(body: impl FnOnce() -> Result<(), CallError>) -> (pc_status, String) {
        let mut error = ptr::null_mut();
        // SAFETY: memory for a pointer; the error is freed once.
        unsafe {
            let status = entry(&raw mut error, body);
            let message = CStr::from_ptr(pc_error_message(error.as_ref())).to_str().unwrap().to_owned();
            pc_error_free(error);
            (status, message)
        }
    }

    #[test]
    fn a_panic_becomes_an_error() {
        let (status, message) = called(|| panic!("number {}", 7));
        assert_eq!((status, message.as_str()), (pc_status::PC_INTERNAL, "a fault of the library: number 7"));
        assert_eq!(called(|| panic!("seven")).1, "a fault of the library: seven");
        assert_eq!(called(|| std::panic::panic_any(7)).1, "a fault of the library: a panic");
        // SAFETY: null.
        assert_eq!(unsafe { entry(ptr::null_mut(), || panic!()) }, pc_status::PC_INTERNAL);
    }

    #[test]
    fn a_value_left_half_done_by_a_panic_is_not_used_again() {
        let value = Exclusive::new(1);
        let half_done = called(|| {
            let _held = value.take()?;
            panic!("half done")
        });
        assert_eq!(half_done.0, pc_status::PC_INTERNAL);
        let (status, message) = called(|| value.take().map(|_| ()));
        assert_eq!(status, pc_status::PC_INTERNAL);
        assert!(message.ends_with("this handle can only be freed"), "{message}");
        assert!(value.close()); // so that it is freed
    }

    #[test]
    fn a_success_clears_the_place_of_the_error() {
        let mut error = ptr::dangling_mut();
        // SAFETY: memory for a pointer, which is not looked at.
        assert_eq!(unsafe { entry(&raw mut error, || Ok(())) }, pc_status::PC_OK);
        assert!(error.is_null());
    }
}
