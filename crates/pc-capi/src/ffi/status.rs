//! How a call ended.

use std::ffi::{c_char, c_int};

/// How a call ended. New ones may be added, so treat an unknown one as an error; PC_STATUS_LAST,
/// which is never returned, makes room for them.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum pc_status {
    /// All went well.
    PC_OK = 0,
    /// The call is wrong: a null pointer, a wrong length, a name that is not UTF-8, a number that
    /// is not finite, an unknown choice.
    PC_INVALID_ARGUMENT = 1,
    /// The text of the model is wrong, or not UTF-8; the error says where.
    PC_INVALID_MODEL = 2,
    /// The model contradicts itself; the error says where.
    PC_INCONSISTENT_MODEL = 3,
    /// The request cannot be met, at least not for this system.
    PC_UNSUPPORTED = 4,
    /// Nothing has this name: no file, no component, no event.
    PC_NOT_FOUND = 5,
    /// A file exists but could not be read.
    PC_IO = 6,
    /// The equations cannot be evaluated at this time and state.
    PC_EVALUATION = 7,
    /// The integration could not begin or continue. Events that accumulate, such as the bounces
    /// of a ball that comes to rest, end it in this way.
    PC_INTEGRATION = 8,
    /// An observer stopped the integration. This is not a failure, and there is no pc_error.
    PC_STOPPED = 9,
    /// The handle is in use: by another thread, or by the call from which the observer or the force
    /// function was called.
    PC_BUSY = 10,
    /// A fault of the library, after which the handle can only be freed; or else threads or memory
    /// for a solver are not available, and the handle is unchanged.
    PC_INTERNAL = 11,
    /// A terminal event ended the integration. This is not a failure, and there is no pc_error.
    PC_EVENT = 12,
    /// The bytes are not a checkpoint, or part of it is missing or changed.
    PC_INVALID_CHECKPOINT = 13,
    /// Two derivations of one model give different motions: a defect of the library.
    PC_DISAGREEMENT = 14,
    /// The derivation or an integration would exceed its limit of memory or time, or was cancelled.
    PC_LIMIT = 15,
    /// The bytes are not a code, or those of another layout, or part of them is missing or changed.
    PC_INVALID_CODE = 16,
    /// Not a status.
    PC_STATUS_LAST = 0x7fff_ffff,
}

/// The name of a status, such as "PC_OK"; "unknown status" for any other number. Static.
#[unsafe(no_mangle)]
pub extern "C" fn pc_status_name(status: c_int) -> *const c_char {
    let name = match status {
        0 => c"PC_OK",
        1 => c"PC_INVALID_ARGUMENT",
        2 => c"PC_INVALID_MODEL",
        3 => c"PC_INCONSISTENT_MODEL",
        4 => c"PC_UNSUPPORTED",
        5 => c"PC_NOT_FOUND",
        6 => c"PC_IO",
        7 => c"PC_EVALUATION",
        8 => c"PC_INTEGRATION",
        9 => c"PC_STOPPED",
        10 => c"PC_BUSY",
        11 => c"PC_INTERNAL",
        12 => c"PC_EVENT",
        13 => c"PC_INVALID_CHECKPOINT",
        14 => c"PC_DISAGREEMENT",
        15 => c"PC_LIMIT",
        16 => c"PC_INVALID_CODE",
        _ => c"unknown status",
    };
    name.as_ptr()
}
