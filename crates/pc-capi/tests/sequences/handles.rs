//! The handles that a sequence has made so far.

use std::ffi::{CStr, c_char, c_void};
use std::ptr;

use pc::*;

use crate::callbacks::observe_member;
use crate::calls::Call;

/// The status of a call, an error unless PC_OK.
pub(crate) type Outcome = Result<(), pc_status>;

/// The handles, null at first. A new handle replaces the former one, which is freed.
pub(crate) struct Handles {
    pub(crate) model: *mut pc_model,
    pub(crate) system: *mut pc_system,
    pub(crate) solver: *mut pc_solver,
    pub(crate) dense: *mut pc_dense,
    pub(crate) checkpoint: Vec<u8>,
    /// Whether the calls have no place for their errors.
    pub(crate) quiet: bool,
}

impl Handles {
    pub(crate) fn none(quiet: bool) -> Handles {
        let (model, system, solver) = (ptr::null_mut(), ptr::null_mut(), ptr::null_mut());
        Handles { model, system, solver, dense: ptr::null_mut(), checkpoint: Vec::new(), quiet }
    }

    /// Calls with a place for the error or without, and checks that status and error belong together.
    pub(crate) fn call(&self, function: impl FnOnce(*mut *mut pc_error) -> pc_status) -> Outcome {
        let mut error = ptr::null_mut();
        let status = function(if self.quiet { ptr::null_mut() } else { &raw mut error });
        let silent = matches!(status, pc_status::PC_OK | pc_status::PC_STOPPED | pc_status::PC_EVENT);
        assert_eq!(error.is_null(), silent || self.quiet, "{status:?}");
        // SAFETY: null or an error, which is ours and freed once.
        unsafe {
            let message = CStr::from_ptr(pc_error_message(error.as_ref())).to_str().unwrap();
            assert_ne!(status, pc_status::PC_INTERNAL, "{message}");
            assert_eq!(message.is_empty(), error.is_null());
            assert_eq!(
                pc_error_status(error.as_ref()),
                if error.is_null() { pc_status::PC_OK } else { status }
            );
            assert_eq!(pc_error_line(error.as_ref()) > 0, pc_error_column(error.as_ref()) > 0);
            assert!(
                pc_error_offset(error.as_ref()) + pc_error_length(error.as_ref()) == 0
                    || pc_error_line(error.as_ref()) > 0
            );
            let by_integrator = matches!(status, pc_status::PC_INTEGRATION | pc_status::PC_INVALID_ARGUMENT);
            assert!(
                pc_error_is_recoverable(error.as_ref()) == 0 || status == pc_status::PC_EVALUATION,
                "{message}"
            );
            assert!(pc_error_integrator_code(error.as_ref()) == 0 || by_integrator, "{message}");
            pc_error_free(error);
        }
        if status == pc_status::PC_OK { Ok(()) } else { Err(status) }
    }

    pub(crate) fn make(&mut self, call: &Call) -> Outcome {
        match call {
            Call::Model(call) => self.of_model(call),
            Call::System(call) => self.of_system(call),
            Call::Solver(call) => self.of_solver(call),
            Call::Dense { t, length, rate } => self.eval(*t, *length, *rate),
            Call::Ensemble { which, threads, numbers, members } => {
                self.ensemble(*which, *threads, numbers, usize::from(*members))
            }
            Call::Nothing(which) => nothing(*which),
        }
    }

    fn eval(&self, t: f64, length: u8, rate: bool) -> Outcome {
        let dense = self.dense;
        // SAFETY: null or a live handle, and an array as long as said.
        unsafe {
            assert!(pc_dense_dim(dense.as_ref()) > 0 || dense.is_null());
            assert!(
                pc_dense_t_begin(dense.as_ref()).is_finite() == pc_dense_t_end(dense.as_ref()).is_finite()
            );
            let length = if length == 0 { pc_dense_dim(dense.as_ref()) } else { usize::from(length) };
            let mut y = vec![0.0; length];
            let function = if rate { pc_dense_rate } else { pc_dense_eval };
            self.call(|error| function(dense, t, y.as_mut_ptr(), length, error))
        }
    }

    fn ensemble(&self, which: u8, threads: u8, numbers: &[f64], members: usize) -> Outcome {
        let system = self.system;
        // SAFETY: null or a live handle; arrays as long as said, but where the length is what is refused.
        unsafe {
            let rows =
                |width: usize| numbers.iter().copied().cycle().take(members * width).collect::<Vec<_>>();
            let (states, parameters) =
                (rows(pc_system_dim(system.as_ref())), rows(pc_system_parameter_count(system.as_ref())));
            let given = |all: &[f64], no: bool| if no { (ptr::null(), 0) } else { (all.as_ptr(), all.len()) };
            let (state_data, state_length) = given(&states, which.is_multiple_of(4));
            let (parameter_data, parameter_length) = given(&parameters, !which.is_multiple_of(3));
            let wrong = usize::from(which % 8 == 1);
            let times = [0.25, numbers.first().copied().unwrap_or(1.0)];
            let user = if which.is_multiple_of(2) { ptr::dangling_mut() } else { ptr::null_mut() };
            let options = pc_solver_options { max_steps: 100, ..Default::default() };
            let observer: pc_member_observer = if which % 32 == 31 { None } else { Some(observe_member) };
            self.call(|error| {
                pc_ensemble_run(
                    system,
                    &raw const options,
                    members,
                    0.0,
                    state_data,
                    state_length + wrong,
                    parameter_data,
                    parameter_length,
                    times.as_ptr(),
                    times.len(),
                    usize::from(threads % 3) + 1,
                    observer,
                    user,
                    error,
                )
            })
        }
    }
}

impl Drop for Handles {
    fn drop(&mut self) {
        // SAFETY: null or live, and not used again.
        unsafe {
            pc_model_free(self.model);
            pc_system_free(self.system);
            pc_solver_free(self.solver);
            pc_dense_free(self.dense);
        }
    }
}

/// Calls that need no handle.
fn nothing(which: u8) -> Outcome {
    // SAFETY: null, or texts that are freed once.
    unsafe {
        let static_text = |text: *const c_char| assert!(!CStr::from_ptr(text).to_str().unwrap().is_empty());
        static_text(pc_version());
        assert_eq!(pc_abi_version(), PC_ABI_VERSION);
        static_text(pc_status_name(i32::from(which) - 4));
        let name = pc_builtin_name(usize::from(which));
        assert_eq!(name.is_null(), usize::from(which) >= pc_builtin_count());
        pc_string_free(ptr::null_mut());
        pc_bytes_free(ptr::null_mut());
        pc_kernel_free(ptr::null_mut());
        pc_cancel_request(None);
        assert_eq!(pc_cancel_is_requested(None), 0);
        pc_cancel_free(ptr::null_mut());
        pc_system_options_init(ptr::null_mut(), 8);
        pc_solver_options_init(ptr::null_mut(), 8);
    }
    Ok(())
}

/// An array of the right length, rarely of another one; or null.
pub(crate) struct Array(Vec<f64>, bool);

impl Array {
    pub(crate) fn of(choice: u8, right: usize) -> Array {
        let length = if choice.is_multiple_of(8) { usize::from(choice / 8) } else { right };
        Array(vec![0.5; length], choice % 64 == 63)
    }

    pub(crate) fn state(choice: u8, right: usize, numbers: &[f64]) -> Array {
        let mut array = Array::of(choice / 3, right);
        array.0.iter_mut().zip(numbers).for_each(|(y, number)| *y = *number);
        array
    }

    pub(crate) fn data(&mut self) -> *mut f64 {
        if self.1 { ptr::null_mut() } else { self.0.as_mut_ptr() }
    }

    pub(crate) fn len(&self) -> usize {
        self.0.len()
    }
}

/// Checks and frees a text from the library.
pub(crate) fn free_text(text: *mut c_char) {
    // SAFETY: null or a text to be freed, once.
    unsafe {
        assert!(text.is_null() || CStr::from_ptr(text).to_str().is_ok());
        pc_string_free(text);
    }
}

/// An argument of functions that is only compared with null.
pub(crate) fn flag(set: bool) -> *mut c_void {
    if set { ptr::dangling_mut() } else { ptr::null_mut() }
}
