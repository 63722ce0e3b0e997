//! Derived and compiled models, shared by the systems of many threads, and stored.

use std::ffi::{c_char, c_void};

use ::pc_model::deep;

use crate::api::checkpoint::handed_out;
use crate::api::model::pc_model;
use crate::api::options::{pc_system_options, take};
use crate::ffi::boundary::entry;
use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::{bytes, clear, free, handle, write};
use crate::ffi::status::pc_status;
use crate::machinery::code::pc_code;
use crate::machinery::system::pc_system;

/// Derives and compiles the equations of a model, as pc_system_new does, for any number of systems
/// made by pc_system_of_code. `options` may be NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_code_new(
    model: *const pc_model,
    options: *const pc_system_options,
    code: *mut *mut pc_code,
    error: *mut *mut pc_error,
) -> pc_status {
    let new = || {
        // SAFETY: the pointers are as the preamble demands.
        unsafe { clear(code, "code") }?;
        // SAFETY: as the preamble demands.
        let derived = unsafe { derived(model, options) }?;
        // SAFETY: as the preamble demands.
        unsafe { write(code, Box::into_raw(Box::new(derived)), "code") }
    };
    // SAFETY: `error` is null or memory for a pointer.
    unsafe { entry(error, new) }
}

/// The equations of a model.
///
/// # Safety
/// Pointers as the preamble demands.
pub(crate) unsafe fn derived(
    model: *const pc_model,
    options: *const pc_system_options,
) -> Result<pc_code, CallError> {
    // SAFETY: as promised.
    let options = unsafe { take::<pc_system_options>(options, "options") }?;
    let variables = options.variables()?;
    // SAFETY: as promised.
    let limits = unsafe { options.limits() }?;
    // SAFETY: as promised.
    let contents = unsafe { handle(model, "model") }?.contents.take()?.clone();
    let mut model = contents.model()?;
    model.limit(limits);
    deep(|| pc_code::derive(model, variables))
}

/// Frees a code. NULL is allowed. Its systems stay as they are.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_code_free(code: *mut pc_code) {
    // SAFETY: null or a handle of ours that nobody uses any more.
    unsafe { free(code) };
}

/// Makes a system of a code, with the parameters of the model: the data of one thread. Nothing is
/// derived. Systems of one code share its equations and their machine code, whichever of them needs
/// it first, and everything that is derived on first use; threads that use a system each never wait
/// for one another, except for such a derivation. Any number of threads may make systems of one
/// code at the same time.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_of_code(
    code: *const pc_code,
    system: *mut *mut pc_system,
    error: *mut *mut pc_error,
) -> pc_status {
    let make = || {
        // SAFETY: the pointers are as the preamble demands.
        unsafe { clear(system, "system") }?;
        // SAFETY: as the preamble demands.
        let made = unsafe { handle(code, "code") }?.system()?;
        // SAFETY: as the preamble demands.
        unsafe { write(system, Box::into_raw(Box::new(made)), "system") }
    };
    // SAFETY: `error` is null or memory for a pointer.
    unsafe { entry(error, make) }
}

/// Writes a code as bytes, to be freed with pc_bytes_free and read by pc_code_load, possibly in
/// another run of the program. They contain the text of the model, its equations, and what has been
/// derived on first use so far (such as mass matrices and Jacobians of bodies), but no machine
/// code: the bytes are the same on every machine. Tables that the model read from files are among
/// them.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_code_save(
    code: *const pc_code,
    data: *mut *mut c_void,
    length: *mut usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let save = || {
        // SAFETY: null or memory for a pointer, or for a number, as the preamble demands.
        unsafe { clear(data, "data").and(write(length, 0, "length")) }?;
        // SAFETY: as the preamble demands.
        let saved = unsafe { handle(code, "code") }?.save()?;
        // SAFETY: places for results, neither of which is null.
        unsafe {
            write(length, saved.len(), "length")?;
            write(data, handed_out(&saved), "data")
        }
    };
    // SAFETY: `error` is null or memory for a pointer.
    unsafe { entry(error, save) }
}

/// Reads a code that pc_code_save has written; nothing is derived. Returns PC_INVALID_CODE unless
/// the bytes are exactly what a library of this layout has written, judged by the hash that they
/// contain. The hash shows damage, not intent: load no bytes that a stranger may have written.
/// There are no limits on what is derived from this code later.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_code_load(
    data: *const c_void,
    length: usize,
    code: *mut *mut pc_code,
    error: *mut *mut pc_error,
) -> pc_status {
    let load = || {
        // SAFETY: the pointers are as the preamble demands.
        unsafe { clear(code, "code") }?;
        // SAFETY: null or `length` bytes, as the preamble demands.
        let saved = unsafe { bytes(data.cast::<c_char>(), length, "data") }?;
        let loaded = deep(|| pc_code::load(saved))?;
        // SAFETY: as the preamble demands.
        unsafe { write(code, Box::into_raw(Box::new(loaded)), "code") }
    };
    // SAFETY: `error` is null or memory for a pointer.
    unsafe { entry(error, load) }
}
