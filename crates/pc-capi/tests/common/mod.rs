//! The functions as C calls them, with their errors as `Result`.

#![allow(dead_code, reason = "each test file uses its own part")]

use std::ffi::{CStr, CString, c_char};
use std::ptr;

use pc::*;

/// The spherical pendulum on a rod, which a multiplier holds: called "rod" beside the models that come with the library.
pub(crate) const ROD: &str = r#"
[coordinates]
x = 0.6
y = 0.0
z = -0.8
[quasi_velocities]
"y'" = 1.5
[constraints]
rod = "(x^2 + y^2 + z^2 - 1)/2"
[lagrangian]
kinetic = "(x'^2 + y'^2 + z'^2)/2"
potential = "10*z"
"#;

/// Status, message, line of an error.
#[derive(Debug, PartialEq)]
pub(crate) struct Refusal {
    pub(crate) status: pc_status,
    pub(crate) message: String,
    pub(crate) line: usize,
}

/// Calls with a place for the error, and checks that status and error belong together.
pub(crate) fn call(function: impl FnOnce(*mut *mut pc_error) -> pc_status) -> Result<(), Refusal> {
    let mut error = ptr::null_mut();
    let status = function(&raw mut error);
    // SAFETY: null or an error, which is ours and is freed once.
    unsafe {
        assert_eq!(pc_error_status(error) == pc_status::PC_OK, error.is_null());
        if status == pc_status::PC_OK || status == pc_status::PC_STOPPED {
            assert!(error.is_null());
            return if status == pc_status::PC_OK { Ok(()) } else { Err(stopped()) };
        }
        assert_eq!(pc_error_status(error), status);
        let message = CStr::from_ptr(pc_error_message(error)).to_str().unwrap().to_owned();
        assert!(!message.is_empty());
        let line = pc_error_line(error);
        pc_error_free(error);
        Err(Refusal { status, message, line })
    }
}

pub(crate) fn stopped() -> Refusal {
    Refusal { status: pc_status::PC_STOPPED, message: String::new(), line: 0 }
}

pub(crate) fn c(text: &str) -> CString {
    CString::new(text).unwrap()
}

/// A text that is freed.
pub(crate) fn taken(text: *mut c_char) -> String {
    // SAFETY: a text given by the library, freed once.
    unsafe {
        let owned = CStr::from_ptr(text).to_str().unwrap().to_owned();
        pc_string_free(text);
        owned
    }
}

/// A model, freed in the end.
pub(crate) struct Model(pub(crate) *mut pc_model);

impl Model {
    pub(crate) fn named(name: &str) -> Model {
        if name == "rod" { Model::text(ROD).unwrap() } else { Model::builtin(name) }
    }

    fn builtin(name: &str) -> Model {
        let (name, mut model) = (c(name), ptr::null_mut());
        // SAFETY: all pointers are of live objects.
        call(|error| unsafe { pc_model_builtin(name.as_ptr(), &raw mut model, error) }).unwrap();
        Model(model)
    }

    pub(crate) fn text(text: &str) -> Result<Model, Refusal> {
        let mut model = ptr::null_mut();
        let (data, len) = (text.as_ptr().cast(), text.len());
        // SAFETY: all pointers are of live objects.
        call(|error| unsafe { pc_model_parse(data, len, ptr::null(), &raw mut model, error) })?;
        Ok(Model(model))
    }

    pub(crate) fn system(&self, form: pc_form) -> Result<System, Refusal> {
        let mut system = ptr::null_mut();
        let mut options = pc_system_options { size: 0, form: 0 };
        // SAFETY: all pointers are of live objects.
        unsafe {
            pc_system_options_init(&raw mut options, size_of::<pc_system_options>());
            options.form = form as i32;
            call(|error| pc_system_new(self.0, &raw const options, &raw mut system, error))?;
        }
        Ok(System(system))
    }
}

impl Drop for Model {
    fn drop(&mut self) {
        // SAFETY: ours, freed once.
        unsafe { pc_model_free(self.0) };
    }
}

/// A system, freed in the end.
pub(crate) struct System(pub(crate) *mut pc_system);

impl System {
    pub(crate) fn of(name: &str) -> System {
        Model::named(name).system(pc_form::PC_POINCARE).unwrap()
    }

    pub(crate) fn dim(&self) -> usize {
        // SAFETY: a live system.
        unsafe { pc_system_dim(self.0) }
    }

    pub(crate) fn start(&self) -> (f64, Vec<f64>) {
        let (mut t, mut y) = (0.0, vec![0.0; self.dim()]);
        // SAFETY: a live system and room as said.
        call(|error| unsafe { pc_system_start(self.0, &raw mut t, y.as_mut_ptr(), y.len(), error) }).unwrap();
        (t, y)
    }

    /// What one of the functions of (t, y) writes.
    pub(crate) fn at(&self, function: At, t: f64, y: &[f64], length: usize) -> Result<Vec<f64>, Refusal> {
        let mut values = vec![0.0; length];
        // SAFETY: a live system and room as said.
        call(|error| unsafe {
            function(self.0, t, y.as_ptr(), y.len(), values.as_mut_ptr(), length, error)
        })?;
        Ok(values)
    }

    pub(crate) fn name(&self, i: usize) -> String {
        // SAFETY: a live system; the name lives as long.
        unsafe { CStr::from_ptr(pc_system_name(self.0, i)).to_str().unwrap().to_owned() }
    }
}

impl Drop for System {
    fn drop(&mut self) {
        // SAFETY: ours, freed once.
        unsafe { pc_system_free(self.0) };
    }
}

pub(crate) type At = unsafe extern "C" fn(
    *mut pc_system,
    f64,
    *const f64,
    usize,
    *mut f64,
    usize,
    *mut *mut pc_error,
) -> pc_status;
