//! Errors, for C.

use std::ffi::{CString, c_char, c_int};

use pc_solve::Code;

use crate::ffi::call_error::CallError;
use crate::ffi::pointer::free;
use crate::ffi::status::pc_status;

/// Why a call failed: the status, the message and, for a model, the position in its text. It never
/// changes; free it with pc_error_free.
pub struct pc_error {
    status: pc_status,
    message: CString,
    place: Place,
    integrator_code: c_int,
    recoverable: bool,
}

/// A position in a model text; zeros where there is none.
#[derive(Clone, Copy, Default)]
struct Place {
    line: usize,
    column: usize,
    offset: usize,
    length: usize,
}

impl CallError {
    pub(crate) fn into_error(self) -> pc_error {
        let place = match &self {
            CallError::Model(error) => {
                let (span, position) = (error.span(), error.position());
                let (line, column) = (position.line, position.column);
                Place { line, column, offset: span.start, length: span.len() }
            }
            _ => Place::default(),
        };
        let code = match &self {
            CallError::Solve(error) => error.code().map_or(0, Code::number),
            _ => 0,
        };
        let (status, message) = self.told();
        let recoverable = match &self {
            CallError::Evaluation(failure) => failure.is_recoverable(),
            CallError::NoValue { .. } => true,
            _ => false,
        };
        pc_error { status, message, place, integrator_code: code, recoverable }
    }
}

/// The status of the failed call, never PC_OK; PC_OK for NULL.
#[unsafe(no_mangle)]
pub extern "C" fn pc_error_status(error: Option<&pc_error>) -> pc_status {
    error.map_or(pc_status::PC_OK, |error| error.status)
}

/// The message, in UTF-8, never NULL; it lives as long as the error. For a model it shows the line
/// at fault and what would be correct, on several lines. Empty for NULL.
#[unsafe(no_mangle)]
pub extern "C" fn pc_error_message(error: Option<&pc_error>) -> *const c_char {
    error.map_or(c"".as_ptr(), |error| error.message.as_ptr())
}

/// The line of the model text at fault, counted from 1; 0 if there is none, and for NULL.
#[unsafe(no_mangle)]
pub extern "C" fn pc_error_line(error: Option<&pc_error>) -> usize {
    place(error).line
}

/// The column at which the offending text begins, in characters counted from 1; 0 if there is none,
/// and for NULL.
#[unsafe(no_mangle)]
pub extern "C" fn pc_error_column(error: Option<&pc_error>) -> usize {
    place(error).column
}

/// The byte at which the offending text begins, counted from 0; 0 if there is none, and for NULL.
#[unsafe(no_mangle)]
pub extern "C" fn pc_error_offset(error: Option<&pc_error>) -> usize {
    place(error).offset
}

/// The number of bytes of the text at fault; 0 if there is none, and for NULL.
#[unsafe(no_mangle)]
pub extern "C" fn pc_error_length(error: Option<&pc_error>) -> usize {
    place(error).length
}

/// The code that CVODES returned (cvodes.h), if that is the reason; 0 otherwise, and for NULL.
#[unsafe(no_mangle)]
pub extern "C" fn pc_error_integrator_code(error: Option<&pc_error>) -> c_int {
    error.map_or(0, |error| error.integrator_code)
}

/// 1 if the status is PC_EVALUATION and evaluation may succeed at a nearby state, so that an
/// integrator should try a smaller step; 0 otherwise, and for NULL.
#[unsafe(no_mangle)]
pub extern "C" fn pc_error_is_recoverable(error: Option<&pc_error>) -> c_int {
    error.map_or(0, |error| error.recoverable.into())
}

/// Frees an error. NULL is allowed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_error_free(error: *mut pc_error) {
    // SAFETY: null or an error of ours that nobody uses any more.
    unsafe { free(error) };
}

fn place(error: Option<&pc_error>) -> Place {
    error.map_or_else(Place::default, |error| error.place)
}
