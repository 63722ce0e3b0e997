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
