//! The functions as C calls them, with their errors as `Result`.

#![allow(dead_code, reason = "each program uses its own part")]

pub(crate) mod ball;

use std::ffi::{CStr, CString, c_char};
use std::ptr;

use pc::*;

/// The spherical pendulum on a rod held by a multiplier: called "rod", in addition to the built-in
/// models.
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
        assert_eq!(pc_error_status(error.as_ref()) == pc_status::PC_OK, error.is_null());
        if status == pc_status::PC_OK {
            assert!(error.is_null());
            return Ok(());
        }
        if status == pc_status::PC_STOPPED || status == pc_status::PC_EVENT {
            assert!(error.is_null());
            return Err(Refusal { status, ..stopped() });
        }
        assert_eq!(pc_error_status(error.as_ref()), status);
        let message = CStr::from_ptr(pc_error_message(error.as_ref())).to_str().unwrap().to_owned();
        assert!(!message.is_empty());
        let line = pc_error_line(error.as_ref());
        pc_error_free(error);
        Err(Refusal { status, message, line })
    }
}

pub(crate) fn stopped() -> Refusal {
    Refusal { status: pc_status::PC_STOPPED, message: String::new(), line: 0 }
}

/// The end of a call by a terminal event.
pub(crate) fn by_event() -> Refusal {
    Refusal { status: pc_status::PC_EVENT, ..stopped() }
}

pub(crate) fn c(text: &str) -> CString {
    CString::new(text).unwrap()
}

/// A copy of a text, which is then freed.
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
        let mut options = pc_system_options::default();
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
        unsafe { pc_system_dim(self.0.as_ref()) }
    }

    pub(crate) fn start(&self) -> (f64, Vec<f64>) {
        let (mut t, mut y) = (0.0, vec![0.0; self.dim()]);
        // SAFETY: a live system and room as said.
        call(|error| unsafe { pc_system_start(self.0, &raw mut t, y.as_mut_ptr(), y.len(), error) }).unwrap();
        (t, y)
    }

    /// The numbers that a function of (t, y) writes.
    pub(crate) fn at(&self, function: At, t: f64, y: &[f64], length: usize) -> Result<Vec<f64>, Refusal> {
        let mut values = vec![0.0; length];
        // SAFETY: a live system and room as said.
        call(|error| unsafe {
            function(self.0, t, y.as_ptr(), y.len(), values.as_mut_ptr(), length, error)
        })?;
        Ok(values)
    }

    pub(crate) fn parameters(&self) -> Vec<f64> {
        // SAFETY: a live system.
        let mut values = vec![0.0; unsafe { pc_system_parameter_count(self.0.as_ref()) }];
        // SAFETY: a live system and room as said.
        call(|error| unsafe { pc_system_parameters(self.0, values.as_mut_ptr(), values.len(), error) })
            .unwrap();
        values
    }

    pub(crate) fn set_parameters(&self, values: &[f64]) -> Result<(), Refusal> {
        // SAFETY: a live system and as many numbers as said.
        call(|error| unsafe { pc_system_set_parameters(self.0, values.as_ptr(), values.len(), error) })
    }

    pub(crate) fn name(&self, i: usize) -> String {
        // SAFETY: a live system; the name lives as long.
        unsafe { CStr::from_ptr(pc_system_name(self.0.as_ref(), i)).to_str().unwrap().to_owned() }
    }
}

impl Drop for System {
    fn drop(&mut self) {
        // SAFETY: ours, freed once.
        unsafe { pc_system_free(self.0) };
    }
}

/// A solver, freed in the end.
pub(crate) struct Solver(pub(crate) *mut pc_solver, usize);

/// Options whose error over a few seconds is well below 1e-10.
pub(crate) fn sharp() -> pc_solver_options {
    pc_solver_options { relative_tolerance: 1e-13, absolute_tolerance: 1e-15, ..Default::default() }
}

impl Solver {
    /// From the start of the model.
    pub(crate) fn of(system: &System, options: &pc_solver_options) -> Solver {
        let mut solver = ptr::null_mut();
        // SAFETY: live objects and a place for the handle.
        let new =
            |error| unsafe { pc_solver_new(system.0, options, 0.0, ptr::null(), 0, &raw mut solver, error) };
        call(new).unwrap();
        Solver(solver, system.dim())
    }

    /// From a checkpoint.
    pub(crate) fn restored(
        system: &System,
        options: &pc_solver_options,
        bytes: &[u8],
    ) -> Result<Solver, Refusal> {
        let (mut solver, data) = (ptr::null_mut(), bytes.as_ptr().cast());
        // SAFETY: live objects, as many bytes as said, and a place for the handle.
        let restore = |error| unsafe {
            pc_solver_restore(system.0, options, data, bytes.len(), &raw mut solver, error)
        };
        match call(restore) {
            Ok(()) => Ok(Solver(solver, system.dim())),
            Err(refusal) => {
                assert!(solver.is_null());
                Err(refusal)
            }
        }
    }

    /// Outcome and state of an advance.
    pub(crate) fn advance(&self, t: f64) -> (Result<(), Refusal>, Vec<f64>) {
        let mut y = vec![0.0; self.1];
        // SAFETY: a live solver and room as said.
        (call(|error| unsafe { pc_solver_advance(self.0, t, y.as_mut_ptr(), y.len(), error) }), y)
    }

    /// Outcome, time and state of a step.
    pub(crate) fn step(&self, towards: f64) -> (Result<(), Refusal>, f64, Vec<f64>) {
        let (mut t, mut y) = (0.0, vec![0.0; self.1]);
        // SAFETY: a live solver and room as said.
        let step =
            |error| unsafe { pc_solver_step(self.0, towards, &raw mut t, y.as_mut_ptr(), y.len(), error) };
        (call(step), t, y)
    }

    pub(crate) fn time(&self) -> f64 {
        let mut t = 0.0;
        // SAFETY: a live solver and a place for a number.
        call(|error| unsafe { pc_solver_time(self.0, &raw mut t, error) }).unwrap();
        t
    }

    pub(crate) fn state(&self) -> Vec<f64> {
        let mut y = vec![f64::NAN; self.1];
        // SAFETY: a live solver and room as said.
        call(|error| unsafe { pc_solver_state(self.0, y.as_mut_ptr(), y.len(), error) }).unwrap();
        y
    }

    pub(crate) fn interpolate(&self, t: f64, derivative: u32) -> Result<Vec<f64>, Refusal> {
        let mut y = vec![0.0; self.1];
        // SAFETY: a live solver and room as said.
        let interpolate =
            |error| unsafe { pc_solver_interpolate(self.0, t, derivative, y.as_mut_ptr(), y.len(), error) };
        call(interpolate).map(|()| y)
    }

    /// Outcome and motion of an integration to `t`.
    pub(crate) fn run_dense(&self, t: f64) -> (Result<(), Refusal>, Dense) {
        let mut dense = ptr::null_mut();
        // SAFETY: a live solver and a place for the handle.
        let outcome = call(|error| unsafe { pc_solver_run_dense(self.0, t, &raw mut dense, error) });
        (outcome, Dense(dense))
    }

    /// How often an event has occurred.
    pub(crate) fn occurrences(&self, event: usize) -> u64 {
        let mut count = 0;
        // SAFETY: a live solver and a place for a number.
        call(|error| unsafe { pc_solver_event_occurrences(self.0, event, &raw mut count, error) }).unwrap();
        count
    }

    /// The last occurrence: its time, and the states before and after.
    pub(crate) fn last(&self, event: usize) -> Result<(f64, Vec<f64>, Vec<f64>), Refusal> {
        let (mut t, mut before, mut after) = (0.0, vec![0.0; self.1], vec![0.0; self.1]);
        let (y, z, dim) = (before.as_mut_ptr(), after.as_mut_ptr(), self.1);
        // SAFETY: a live solver and room as said.
        let last =
            |error| unsafe { pc_solver_last_occurrence(self.0, event, &raw mut t, y, dim, z, dim, error) };
        call(last).map(|()| (t, before, after))
    }
}

impl Drop for Solver {
    fn drop(&mut self) {
        // SAFETY: ours, freed once.
        unsafe { pc_solver_free(self.0) };
    }
}

/// A motion, freed in the end.
pub(crate) struct Dense(pub(crate) *mut pc_dense);

impl Dense {
    pub(crate) fn at(&self, t: f64) -> Result<Vec<f64>, Refusal> {
        // SAFETY: a live motion and room as said.
        unsafe {
            let mut y = vec![0.0; pc_dense_dim(self.0.as_ref())];
            call(|error| pc_dense_eval(self.0, t, y.as_mut_ptr(), y.len(), error)).map(|()| y)
        }
    }

    pub(crate) fn rate(&self, t: f64) -> Result<Vec<f64>, Refusal> {
        // SAFETY: a live motion and room as said.
        unsafe {
            let mut y = vec![0.0; pc_dense_dim(self.0.as_ref())];
            call(|error| pc_dense_rate(self.0, t, y.as_mut_ptr(), y.len(), error)).map(|()| y)
        }
    }

    pub(crate) fn span(&self) -> (f64, f64) {
        // SAFETY: a live motion, or null.
        unsafe { (pc_dense_t_begin(self.0.as_ref()), pc_dense_t_end(self.0.as_ref())) }
    }
}

impl Drop for Dense {
    fn drop(&mut self) {
        // SAFETY: ours, freed once.
        unsafe { pc_dense_free(self.0) };
    }
}

/// Each call is refused with this status and a message with this end; the arguments are those of C,
/// without the last.
#[allow(unused_macros, reason = "only the tests of refusals use it")]
macro_rules! refused {
    ($status:expr, $end:expr; $($function:ident($($argument:expr),* $(,)?);)*) => {$(
        // SAFETY: null, live objects, or places as said; the test is that wrong arguments do no
        // harm.
        let refusal = $crate::common::call(|error| unsafe { $function($($argument,)* error) }).unwrap_err();
        assert_eq!(refusal.status, $status, "{}: {}", stringify!($function), refusal.message);
        assert!(refusal.message.ends_with($end), "{}: {}", stringify!($function), refusal.message);
    )*};
}

pub(crate) type At = unsafe extern "C" fn(
    *const pc_system,
    f64,
    *const f64,
    usize,
    *mut f64,
    usize,
    *mut *mut pc_error,
) -> pc_status;
