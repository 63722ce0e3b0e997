//! The C library prints the same equations as `pc derive`.

use std::ffi::{CStr, CString, c_int};
use std::process::Command;
use std::ptr;

use pc::*;

/// `pc derive`, unless it refuses.
fn derived(model: &str, form: &str, format: &str) -> Option<String> {
    let arguments = ["derive", model, "--form", form, "--format", format];
    let output = Command::new(env!("CARGO_BIN_EXE_pc")).args(arguments).output().unwrap();
    output.status.success().then(|| String::from_utf8(output.stdout).unwrap())
}

/// `pc_system_print` of a system of that form, unless it is refused.
fn printed(model: &str, form: pc_form, format: pc_format) -> Option<String> {
    let name = CString::new(model).unwrap();
    let (mut handle, mut system, mut text) = (ptr::null_mut(), ptr::null_mut(), ptr::null_mut());
    let mut options = std::mem::MaybeUninit::<pc_system_options>::uninit();
    // SAFETY: live handles, each freed once, texts, options set up by the library.
    unsafe {
        assert_eq!(pc_model_builtin(name.as_ptr(), &raw mut handle, ptr::null_mut()), pc_status::PC_OK);
        pc_system_options_init(options.as_mut_ptr(), size_of::<pc_system_options>());
        (*options.as_mut_ptr()).form = form as c_int;
        let made = pc_system_new(handle, options.as_ptr(), &raw mut system, ptr::null_mut());
        pc_model_free(handle);
        if made != pc_status::PC_OK {
            return None;
        }
        let status = pc_system_print(system, format as c_int, &raw mut text, ptr::null_mut());
        let printed = (status == pc_status::PC_OK).then(|| CStr::from_ptr(text).to_str().unwrap().to_owned());
        pc_system_free(system);
        pc_string_free(text);
        printed
    }
}

/// Models that are free, under constraints of every kind, with bodies, or with L not quadratic.
#[test]
fn the_library_prints_what_the_program_prints() {
    let models = [
        "heavy-top-lagrange",
        "chaplygin-sleigh",
        "vertical-disk",
        "tilted-disk",
        "appell-hamel",
        "double-pendulum-cartesian",
        "relativistic-particle",
        "turning-hoop",
    ];
    let mut equal = 0;
    for model in models {
        for form in ["poincare", "canonical"] {
            for format in ["text", "latex", "json"] {
                let c_form = if form == "poincare" { pc_form::PC_POINCARE } else { pc_form::PC_CANONICAL };
                let c_format = match format {
                    "text" => pc_format::PC_TEXT,
                    "latex" => pc_format::PC_LATEX,
                    _ => pc_format::PC_JSON,
                };
                let (found, expected) = (printed(model, c_form, c_format), derived(model, form, format));
                assert_eq!(found, expected, "{model} --form {form} --format {format}");
                equal += usize::from(found.is_some());
            }
        }
    }
    assert!(equal >= 3 * 14, "{equal} pages are equal");
}
