//! The work of an integration.

use std::ffi::{c_int, c_long, c_void};

use sundials_sys as sys;

use crate::handles::Memory;

/// Counts since the start, and the last internal step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct Statistics {
    /// Internal steps.
    pub steps: u64,
    /// Evaluations of f, with those for difference quotients.
    pub rhs_evaluations: u64,
    /// Evaluations of ∂f/∂y, by the field or by difference quotients.
    pub jacobian_evaluations: u64,
    /// Steps tried again because the estimated error was too large.
    pub error_test_failures: u64,
    /// Iterations of the nonlinear solver.
    pub nonlinear_iterations: u64,
    /// Failures of the nonlinear solver, with those recovered by a new Jacobian.
    pub nonlinear_failures: u64,
    /// Set-ups (factorisations) of the linear solver.
    pub linear_setups: u64,
    /// Order of the last step, 0 before the first.
    pub last_order: u32,
    /// Length of the last step, with the sign of the direction; 0 before the first.
    pub last_step: f64,
    /// End of the last step.
    pub current_time: f64,
}

impl Statistics {
    /// Reads the counters; those of the linear solver only if `newton` says there is one.
    pub(crate) fn read(memory: &Memory, newton: bool) -> Self {
        let counter = |get: unsafe extern "C" fn(*mut c_void, *mut c_long) -> c_int| {
            let mut value = 0;
            // SAFETY: the memory is live and initialised; `value` is a place for the result.
            unsafe { get(memory.raw(), &raw mut value) };
            u64::try_from(value).unwrap_or(0)
        };
        let number = |get: unsafe extern "C" fn(*mut c_void, *mut f64) -> c_int| {
            let mut value = 0.0;
            // SAFETY: as above.
            unsafe { get(memory.raw(), &raw mut value) };
            value
        };
        let mut last_order = 0;
        // SAFETY: as above.
        unsafe { sys::CVodeGetLastOrder(memory.raw(), &raw mut last_order) };
        let newton_counter = |get| if newton { counter(get) } else { 0 };
        Statistics {
            steps: counter(sys::CVodeGetNumSteps),
            rhs_evaluations: counter(sys::CVodeGetNumRhsEvals) + newton_counter(sys::CVodeGetNumLinRhsEvals),
            jacobian_evaluations: newton_counter(sys::CVodeGetNumJacEvals),
            error_test_failures: counter(sys::CVodeGetNumErrTestFails),
            nonlinear_iterations: counter(sys::CVodeGetNumNonlinSolvIters),
            nonlinear_failures: counter(sys::CVodeGetNumNonlinSolvConvFails),
            linear_setups: newton_counter(sys::CVodeGetNumLinSolvSetups),
            last_order: u32::try_from(last_order).unwrap_or(0),
            last_step: number(sys::CVodeGetLastStep),
            current_time: number(sys::CVodeGetCurrentTime),
        }
    }
}
