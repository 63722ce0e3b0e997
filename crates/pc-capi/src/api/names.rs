//! Finding an index by a name.

use std::ffi::{CString, c_char};

use crate::ffi::boundary::entry;
use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::{handle, text, write};
use crate::ffi::status::pc_status;
use crate::machinery::system::{Inventory, pc_system};

/// Writes the index of a component of the state, counted from 0, by its name. Returns PC_NOT_FOUND
/// if no component has this name.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_find(
    system: *const pc_system,
    name: *const c_char,
    index: *mut usize,
    error: *mut *mut pc_error,
) -> pc_status {
    // SAFETY: as the preamble demands.
    unsafe { find(system, name, index, error, "component of the state", |inventory| &inventory.names) }
}

/// Writes the index of a parameter or input, counted from 0, by its name, as pc_system_find does.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_find_parameter(
    system: *const pc_system,
    name: *const c_char,
    index: *mut usize,
    error: *mut *mut pc_error,
) -> pc_status {
    // SAFETY: as the preamble demands.
    unsafe { find(system, name, index, error, "parameter", |inventory| &inventory.parameters) }
}

/// Writes the index of an observable, counted from 0, by its name, as pc_system_find does.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_find_observable(
    system: *const pc_system,
    name: *const c_char,
    index: *mut usize,
    error: *mut *mut pc_error,
) -> pc_status {
    // SAFETY: as the preamble demands.
    unsafe { find(system, name, index, error, "observable", |inventory| &inventory.observables) }
}

/// # Safety
/// As the preamble demands.
unsafe fn find(
    system: *const pc_system,
    name: *const c_char,
    index: *mut usize,
    error: *mut *mut pc_error,
    what: &'static str,
    list: impl FnOnce(&Inventory) -> &[CString],
) -> pc_status {
    let look = || {
        // SAFETY: null or a live handle, as promised.
        let names = list(&unsafe { handle(system, "system") }?.inventory);
        // SAFETY: null or text, as promised.
        let name = unsafe { text(name, "name") }?;
        let place = names.iter().position(|known| known.to_bytes() == name.as_bytes());
        let unknown = || CallError::UnknownName {
            what,
            name: name.to_owned(),
            known: names.iter().map(|known| known.to_string_lossy().into_owned()).collect(),
        };
        // SAFETY: null or memory for a number, as promised.
        unsafe { write(index, place.ok_or_else(unknown)?, "index") }
    };
    // SAFETY: as promised.
    unsafe { entry(error, look) }
}
