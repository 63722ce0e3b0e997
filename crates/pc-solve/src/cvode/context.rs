//! The SUNDIALS context of one solver, with the messages it reports.

use std::ffi::{CStr, c_char, c_int, c_void};
use std::ptr::{self, NonNull};

use sundials_sys as sys;

use crate::error::SolveError;

/// An owned `SUNContext` that writes nothing to any stream; messages are kept until taken.
///
/// Every other handle of a solver refers to its context and must be dropped before it.
pub(crate) struct Context {
    raw: sys::SUNContext,
    /// A box shared with [`keep_message`], and therefore held as a pointer.
    messages: NonNull<Vec<String>>,
}

impl Context {
    pub(crate) fn new() -> Result<Self, SolveError> {
        let mut raw = ptr::null_mut();
        // SAFETY: `raw` is a valid place for the result.
        let code = unsafe { sys::SUNContext_Create(sys::SUN_COMM_NULL, &raw mut raw) };
        if code != 0 || raw.is_null() {
            return Err(SolveError::Setup { function: "SUNContext_Create", code, message: String::new() });
        }
        let messages = NonNull::from(Box::leak(Box::default()));
        let mut context = Context { raw, messages };
        // SAFETY: the context is live. A null logger is SUNDIALS' way to log nothing; the context
        // frees its own first.
        let code = unsafe { sys::SUNContext_SetLogger(raw, ptr::null_mut()) };
        context.check("SUNContext_SetLogger", code)?;
        // SAFETY: the context is live.
        let code = unsafe { sys::SUNContext_ClearErrHandlers(raw) };
        context.check("SUNContext_ClearErrHandlers", code)?;
        // SAFETY: the context is live, and `messages` is freed only after the context that calls
        // the handler.
        let code =
            unsafe { sys::SUNContext_PushErrHandler(raw, Some(keep_message), messages.as_ptr().cast()) };
        context.check("SUNContext_PushErrHandler", code)?;
        Ok(context)
    }

    pub(crate) fn raw(&self) -> sys::SUNContext {
        self.raw
    }

    /// The messages reported since the last call, joined.
    pub(crate) fn take_messages(&mut self) -> String {
        // SAFETY: no SUNDIALS call is under way, since it would be made by the owner of `self`.
        let messages = unsafe { self.messages.as_mut() };
        if messages.is_empty() {
            return String::new(); // after nearly every step
        }
        let joined = messages.join(" ");
        messages.clear();
        joined
    }

    /// Returns an error for the set-up `function` unless its return `code` is 0.
    pub(crate) fn check(&mut self, function: &'static str, code: c_int) -> Result<(), SolveError> {
        if code == 0 { Ok(()) } else { Err(self.setup_error(function, code)) }
    }

    /// Returns `pointer`, or an error for the constructor `function` if the pointer is null.
    pub(crate) fn check_new<T>(
        &mut self,
        function: &'static str,
        pointer: *mut T,
    ) -> Result<NonNull<T>, SolveError> {
        NonNull::new(pointer).ok_or_else(|| self.setup_error(function, sys::CV_MEM_FAIL))
    }

    fn setup_error(&mut self, function: &'static str, code: c_int) -> SolveError {
        SolveError::Setup { function, code, message: self.take_messages() }
    }
}

impl Drop for Context {
    fn drop(&mut self) {
        // SAFETY: the context is owned, and every handle that refers to it has been dropped.
        unsafe { sys::SUNContext_Free(&raw mut self.raw) };
        // SAFETY: made by `Box::leak`; the context, the only other holder, is gone.
        drop(unsafe { Box::from_raw(self.messages.as_ptr()) });
    }
}

unsafe extern "C" fn keep_message(
    _line: c_int,
    _function: *const c_char,
    _file: *const c_char,
    message: *const c_char,
    _code: sys::SUNErrCode,
    messages: *mut c_void,
    _context: sys::SUNContext,
) {
    if !message.is_null() {
        // SAFETY: SUNDIALS passes a C string.
        let message = unsafe { CStr::from_ptr(message) }.to_string_lossy().into_owned();
        // SAFETY: the pointer given to SUNContext_PushErrHandler; our side does not hold the Vec
        // during calls.
        unsafe { (*messages.cast::<Vec<String>>()).push(message) };
    }
}
