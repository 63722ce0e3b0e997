//! A system is compared with a second derivation.

use std::ffi::{CStr, c_char};
use std::ptr;

use pc::*;

/// The report of pc_system_verify on a built-in model with one of its parameters set.
fn verified(model: &CStr, parameter: Option<(usize, f64)>, states: usize) -> String {
    let (mut handle, mut system, mut text) = (ptr::null_mut(), ptr::null_mut(), ptr::null_mut::<c_char>());
    // SAFETY: live handles, each freed once, and a text of the library.
    unsafe {
        assert_eq!(pc_model_builtin(model.as_ptr(), &raw mut handle, ptr::null_mut()), pc_status::PC_OK);
        let made = pc_system_new(handle, ptr::null(), &raw mut system, ptr::null_mut());
        assert_eq!(made, pc_status::PC_OK);
        if let Some((place, value)) = parameter {
            let set = pc_system_set_parameter(system, place, value, ptr::null_mut());
            assert_eq!(set, pc_status::PC_OK);
        }
        let status = pc_system_verify(system, states, &raw mut text, ptr::null_mut());
        assert_eq!(status, pc_status::PC_OK);
        assert_eq!(pc_system_verify(system, 1, ptr::null_mut(), ptr::null_mut()), pc_status::PC_OK);
        let said = CStr::from_ptr(text).to_str().unwrap().to_owned();
        pc_string_free(text);
        pc_system_free(system);
        pc_model_free(handle);
        said
    }
}

#[test]
fn a_system_agrees_with_a_second_derivation() {
    let said = verified(c"heavy-top-lagrange", None, 0);
    assert!(said.starts_with("agrees to ") && said.ends_with(" at 100 states\n"), "{said}");
    let said = verified(c"chaplygin-sleigh", Some((2, 0.8)), 7);
    assert!(said.starts_with("agrees to ") && said.ends_with(" at 7 states\n"), "{said}");
}

/// A solver's state at the end, for the parameters that the system has then.
#[test]
fn a_solver_agrees_with_a_second_derivation_where_it_is() {
    let (mut handle, mut system, mut solver) = (ptr::null_mut(), ptr::null_mut(), ptr::null_mut());
    let mut text = ptr::null_mut::<c_char>();
    let mut y = [0.0; 6];
    // SAFETY: live handles, each freed once, room for the state, and a text of the library.
    let said = unsafe {
        let made = pc_model_builtin(c"heavy-top-lagrange".as_ptr(), &raw mut handle, ptr::null_mut());
        assert_eq!(made, pc_status::PC_OK);
        assert_eq!(pc_system_new(handle, ptr::null(), &raw mut system, ptr::null_mut()), pc_status::PC_OK);
        assert_eq!(pc_system_set_parameter(system, 0, 1.25, ptr::null_mut()), pc_status::PC_OK);
        let none = ptr::null();
        let begun = pc_solver_new(system, none, 0.0, ptr::null(), 0, &raw mut solver, ptr::null_mut());
        assert_eq!(begun, pc_status::PC_OK);
        let at = pc_solver_advance(solver, 1.5, y.as_mut_ptr(), y.len(), ptr::null_mut());
        assert_eq!(at, pc_status::PC_OK);
        let status = pc_system_verify_at(system, 1.5, y.as_ptr(), y.len(), &raw mut text, ptr::null_mut());
        assert_eq!(status, pc_status::PC_OK);
        let short = pc_system_verify_at(system, 1.5, y.as_ptr(), 5, ptr::null_mut(), ptr::null_mut());
        assert_eq!(short, pc_status::PC_INVALID_ARGUMENT);
        let said = CStr::from_ptr(text).to_str().unwrap().to_owned();
        pc_string_free(text);
        pc_solver_free(solver);
        pc_system_free(system);
        pc_model_free(handle);
        said
    };
    assert!(said.starts_with("agrees to ") && said.ends_with(" at 1 state\n"), "{said}");
}

#[test]
fn a_null_system_is_refused() {
    let mut error = ptr::null_mut();
    // SAFETY: null is allowed, and the error is freed.
    unsafe {
        let status = pc_system_verify(ptr::null(), 0, ptr::null_mut(), &raw mut error);
        assert_eq!(status, pc_status::PC_INVALID_ARGUMENT);
        pc_error_free(error);
    }
}

/// NULL, whatever the place of the text held.
#[test]
fn a_call_that_fails_leaves_no_text() {
    let mut text = ptr::dangling_mut::<c_char>();
    // SAFETY: no system, and a place for a text.
    let status = unsafe { pc_system_verify(ptr::null(), 1, &raw mut text, ptr::null_mut()) };
    assert_eq!((status, text), (pc_status::PC_INVALID_ARGUMENT, ptr::null_mut()));
    text = ptr::dangling_mut();
    // SAFETY: as before.
    let status =
        unsafe { pc_system_verify_at(ptr::null(), 0.0, ptr::null(), 0, &raw mut text, ptr::null_mut()) };
    assert_eq!((status, text), (pc_status::PC_INVALID_ARGUMENT, ptr::null_mut()));
}
