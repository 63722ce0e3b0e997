//! The counters of CVODES.

use std::ffi::{c_int, c_long, c_void};

use sundials_sys as sys;

use crate::cvode::handles::Memory;
use crate::cvode::linear::work::Work;
use crate::integration::statistics::Statistics;

impl Statistics {
    /// Reads the counters, including those of the linear solver if there is one; `linear` holds its
    /// data.
    pub(crate) fn read(memory: &Memory, linear: Option<&Work>) -> Self {
        let counter = |get: unsafe extern "C" fn(*mut c_void, *mut c_long) -> c_int| {
            let mut value = 0;
            // SAFETY: the memory is live and initialised; `value` is a place for the result.
            unsafe { get(memory.raw(), &raw mut value) };
            u64::try_from(value).unwrap_or(0)
        };
        let number = |get: unsafe extern "C" fn(*mut c_void, *mut f64) -> c_int| {
            let mut value = 0.0;
            // SAFETY: the memory is live and initialised; `value` is a place for the result.
            unsafe { get(memory.raw(), &raw mut value) };
            value
        };
        let order = |get: unsafe extern "C" fn(*mut c_void, *mut c_int) -> c_int| {
            let mut value = 0;
            // SAFETY: the memory is live and initialised; `value` is a place for the result.
            unsafe { get(memory.raw(), &raw mut value) };
            u32::try_from(value).unwrap_or(0)
        };
        let of_linear = |get| if linear.is_some() { counter(get) } else { 0 };
        Statistics {
            steps: counter(sys::CVodeGetNumSteps),
            rhs_evaluations: counter(sys::CVodeGetNumRhsEvals)
                + of_linear(sys::CVodeGetNumLinRhsEvals)
                + linear.map_or(0, Work::quotient_evaluations),
            jacobian_evaluations: of_linear(sys::CVodeGetNumJacEvals),
            error_test_failures: counter(sys::CVodeGetNumErrTestFails),
            nonlinear_iterations: counter(sys::CVodeGetNumNonlinSolvIters),
            nonlinear_failures: counter(sys::CVodeGetNumNonlinSolvConvFails),
            step_failures: counter(sys::CVodeGetNumStepSolveFails),
            linear_setups: of_linear(sys::CVodeGetNumLinSolvSetups),
            linear_iterations: of_linear(sys::CVodeGetNumLinIters),
            linear_failures: of_linear(sys::CVodeGetNumLinConvFails),
            jacobian_products: of_linear(sys::CVodeGetNumJtimesEvals),
            preconditioner_evaluations: of_linear(sys::CVodeGetNumPrecEvals),
            preconditioner_solves: of_linear(sys::CVodeGetNumPrecSolves),
            limited_steps: 0,
            implicit_steps: 0,
            lane_steps: 0,
            changes: 0,
            stiff_from: None,
            last_order: order(sys::CVodeGetLastOrder),
            current_order: order(sys::CVodeGetCurrentOrder),
            first_step: number(sys::CVodeGetActualInitStep),
            last_step: number(sys::CVodeGetLastStep),
            current_step: number(sys::CVodeGetCurrentStep),
            current_time: number(sys::CVodeGetCurrentTime),
        }
    }
}
