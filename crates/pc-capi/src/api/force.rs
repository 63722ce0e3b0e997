//! Forces that a function of the program computes: controllers, contact, measured loads.

use std::ffi::{c_char, c_int, c_void};

use crate::api::model::{Contents, change, pc_model};
use crate::ffi::boundary::entry;
use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::text;
use crate::ffi::status::pc_status;
use crate::ffi::strings::nth;
use crate::ffi::user_data::{User, pc_destroy};
use crate::machinery::controller::Controller;
use crate::machinery::system::{Inner, Inventory, inside, pc_system};

/// Writes the external forces at (t, y) to q: one for each that was declared, in the order of the
/// declarations, so `q_length` is pc_system_force_count. y is the state of the system; in the
/// canonical form it contains momenta. Returns 0 on success; a positive number where the forces are
/// not defined, so that a smaller step may help; a negative number to give up. A force left
/// unwritten is NaN and is treated like a positive return value. It must return normally: no
/// exceptions, no longjmp.
pub type pc_force_function = Option<
    unsafe extern "C" fn(
        t: f64,
        y: *const f64,
        y_length: usize,
        q: *mut f64,
        q_length: usize,
        user: *mut c_void,
    ) -> c_int,
>;

/// Writes the derivatives of the external forces at (t, y), all of them, column-major: ∂q_i/∂y_j
/// to `dq[i + j*e]` for e forces, so `dq_length` is e * `y_length`. Otherwise it is like
/// pc_force_function.
pub type pc_force_jacobian = Option<
    unsafe extern "C" fn(
        t: f64,
        y: *const f64,
        y_length: usize,
        dq: *mut f64,
        dq_length: usize,
        user: *mut c_void,
    ) -> c_int,
>;

/// Declares that a force computed by a function of yours acts on a quasi-velocity or, if the model
/// declares no quasi-velocities, on the velocity x' of a coordinate x; "x" means the same. This
/// force is added to the other forces that act there. The function belongs to the system, not to
/// the model: set it with pc_system_set_force. An unknown name is reported by pc_model_check and
/// pc_system_new.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_add_external_force(
    model: *mut pc_model,
    on: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let declare = |contents: &mut Contents| {
        // SAFETY: null or text, as the preamble demands.
        contents.external.push(unsafe { text(on, "on") }?.to_owned());
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { change(model, error, declare) }
}

/// The number of external forces; 0 for NULL.
#[unsafe(no_mangle)]
pub extern "C" fn pc_system_force_count(system: Option<&pc_system>) -> usize {
    system.map_or(0, |system| system.inventory.forces.len())
}

/// The name of the quasi-velocity on which an external force acts, counted from 0; NULL beyond the
/// last.
#[unsafe(no_mangle)]
pub extern "C" fn pc_system_force_name(system: Option<&pc_system>, index: usize) -> *const c_char {
    system.map_or(std::ptr::null(), |system| nth(&system.inventory.forces, index))
}

/// Sets the function that computes the external forces, all at once: the Q_s of the declared
/// quasi-velocities. Until it is set, nothing that needs these forces can be evaluated. `jacobian`
/// may be NULL: the derivatives of the forces, and only these, are then computed as difference
/// quotients.
///
/// Copies, kernels and solvers made from the system afterwards share the functions and `user`;
/// those made before keep the functions they had. The functions are called on whichever thread
/// evaluates; if several threads use copies, several calls may run at the same time. They may call
/// any function on other handles, and on the same system those that return names
/// (pc_system_..._name) and sizes.
///
/// `destroy`, unless NULL, is called with `user` exactly once: by this call if it fails, else
/// when the last handle that shares it is freed or given another function. `destroy` must not use a
/// handle that is being freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_set_force(
    system: *mut pc_system,
    function: pc_force_function,
    jacobian: pc_force_jacobian,
    user: *mut c_void,
    destroy: pc_destroy,
    error: *mut *mut pc_error,
) -> pc_status {
    let user = User { data: user, destroy };
    let mut unused = Controller::default();
    let Some(function) = function else {
        // SAFETY: `error` is null or memory for a pointer.
        return unsafe { entry(error, || Err(CallError::Null { what: "function" })) };
    };
    let set = |_: &Inventory, inner: &mut Inner| {
        let controller = Controller::new(function, jacobian, user);
        let outcome = inner.field.set_force(controller);
        let fault = outcome.is_err().then_some(NO_FORCES);
        unused = outcome.unwrap_or_else(|refused| refused);
        fault.map_or(Ok(()), Err)
    };
    // SAFETY: as the preamble demands.
    let status = unsafe { inside(system, error, set) };
    // Dropped once the system is no longer in use: `destroy` may call functions on it.
    drop(unused);
    status
}

const NO_FORCES: CallError = CallError::Unsupported {
    what: "an external force",
    why: "the model declares none; pc_model_add_external_force does",
};
