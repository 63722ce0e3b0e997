//! Integrations that continue from a checkpoint.

use std::ffi::{c_char, c_void};

use pc_solve::Checkpoint;

use crate::api::options::{pc_solver_options, take};
use crate::api::solver::{integrate, pc_solver};
use crate::ffi::boundary::entry;
use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::{bytes, clear, text, write};
use crate::ffi::status::pc_status;
use crate::ffi::strings::give;
use crate::machinery::engine::Integration;
use crate::machinery::event_set::Followed;
use crate::machinery::system::{Inner, Inventory, inside, pc_system};

/// Writes the time and state of a solver as bytes, to be freed with pc_bytes_free and read by
/// pc_solver_restore, possibly in another run of the program. `label` says what the checkpoint
/// belongs to; NULL means the empty text.
///
/// A multistep method depends on earlier steps, so this solver restarts here too, at order 1:
/// from here on, it and the solvers restored from the checkpoint give the same numbers to the
/// last bit. Events of the model are part of the checkpoint; for a solver with events added by
/// pc_solver_add_event the call returns PC_UNSUPPORTED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_solver_checkpoint(
    solver: *mut pc_solver,
    label: *const c_char,
    data: *mut *mut c_void,
    length: *mut usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let write_bytes = |integration: &mut Integration, _: usize| {
        let label = if label.is_null() { c"".as_ptr() } else { label };
        // SAFETY: text, as the preamble demands.
        let label = unsafe { text(label, "label") }?;
        let written = integration.checkpoint()?.to_bytes(&marked(integration.digest(), label));
        // SAFETY: places for results, neither of which is null.
        unsafe {
            write(length, written.len(), "length")?;
            write(data, handed_out(&written), "data")
        }
    };
    let checked = || {
        // SAFETY: null or memory for a pointer, or for a number, as the preamble demands.
        unsafe { clear(data, "data").and(write(length, 0, "length")) }
    };
    // SAFETY: `error` is null or memory for a pointer.
    match unsafe { entry(error, checked) } {
        // SAFETY: as the preamble demands.
        pc_status::PC_OK => unsafe { integrate(solver, error, write_bytes) },
        refused => refused,
    }
}

/// Makes a solver that continues from a checkpoint, with the current parameters of the system.
/// It continues exactly as the original solver did if the system, the parameters and the options
/// are the same. `options` may be NULL. Returns PC_INVALID_CHECKPOINT unless the bytes are exactly
/// what pc_solver_checkpoint wrote, for a model with the same names and equations; the values of
/// parameters may differ. The statistics of the solver count the work from the checkpoint on.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_solver_restore(
    system: *const pc_system,
    options: *const pc_solver_options,
    data: *const c_void,
    length: usize,
    solver: *mut *mut pc_solver,
    error: *mut *mut pc_error,
) -> pc_status {
    let restore = |inventory: &Inventory, inner: &mut Inner| {
        // SAFETY: null or `length` bytes, as the preamble demands.
        let (checkpoint, label) = Checkpoint::from_bytes(unsafe { bytes(data.cast(), length, "data") }?)?;
        match unmarked(&label) {
            (Some(digest), _) if digest == inner.field.digest() => {}
            (Some(_), _) => return Err(CallError::OtherModel),
            (None, _) => return Err(CallError::NoModel),
        }
        // SAFETY: null or options, as the preamble demands.
        let options = unsafe { take(options, "options")?.options(inventory.dim(), inventory.deadline()) }?;
        let events = Followed::new(inner.events.clone());
        let integration = Integration::new(inner.field.clone(), &checkpoint, options, events.clone())?;
        let made = pc_solver::boxed(integration, &events, inventory.dim());
        // SAFETY: null or memory for a handle, as the preamble demands.
        unsafe { write(solver, made, "solver") }
    };
    let checked = || {
        // SAFETY: as the preamble demands.
        unsafe { clear(solver, "solver") }
    };
    // SAFETY: `error` is null or memory for a pointer.
    match unsafe { entry(error, checked) } {
        // SAFETY: as the preamble demands.
        pc_status::PC_OK => unsafe { inside(system, error, restore) },
        refused => refused,
    }
}

/// Writes the label of a checkpoint, to be freed with pc_string_free. Returns PC_INVALID_CHECKPOINT
/// in the same cases as pc_solver_restore.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_checkpoint_label(
    data: *const c_void,
    length: usize,
    label: *mut *mut c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let read = || {
        // SAFETY: null or memory for a pointer, as the preamble demands.
        unsafe { clear(label, "label") }?;
        // SAFETY: null or `length` bytes, as the preamble demands.
        let (_, found) = Checkpoint::from_bytes(unsafe { bytes(data.cast(), length, "data") }?)?;
        // SAFETY: as the preamble demands.
        unsafe { write(label, give(unmarked(&found).1), "label") }
    };
    // SAFETY: `error` is null or memory for a pointer.
    unsafe { entry(error, read) }
}

/// The beginning of a label that contains the digest of the model.
const MARK: &str = "model ";

/// The label after the digest of the model: the checksum of a checkpoint covers both.
fn marked(digest: u64, label: &str) -> String {
    format!("{MARK}{digest:016x}\n{label}")
}

/// The digest of the model, if there is one, and the label.
fn unmarked(label: &str) -> (Option<u64>, &str) {
    let parts = label.strip_prefix(MARK).and_then(|rest| rest.split_once('\n'));
    let read = parts.and_then(|(digest, label)| Some((Some(u64::from_str_radix(digest, 16).ok()?), label)));
    read.unwrap_or((None, label))
}

/// The number of bytes in front of the data that are handed out; these bytes hold the length of the
/// data.
const HEAD: usize = size_of::<usize>();

/// A copy for C.
pub(crate) fn handed_out(content: &[u8]) -> *mut c_void {
    let whole: Box<[u8]> = [&content.len().to_ne_bytes(), content].concat().into();
    // SAFETY: within the box, or just behind it.
    unsafe { Box::into_raw(whole).cast::<u8>().add(HEAD).cast() }
}

/// Frees the bytes of a checkpoint. NULL is allowed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_bytes_free(data: *mut c_void) {
    if data.is_null() {
        return;
    }
    // SAFETY: made by `handed_out`, so it has a head and as many bytes as that says; nobody uses
    // them any more.
    drop(unsafe {
        let whole = data.cast::<u8>().sub(HEAD);
        let length = usize::from_ne_bytes(whole.cast::<[u8; HEAD]>().read());
        Box::from_raw(std::ptr::slice_from_raw_parts_mut(whole, HEAD + length))
    });
}
