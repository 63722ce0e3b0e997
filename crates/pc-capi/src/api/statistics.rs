//! The work of an integration.

use pc_solve::Statistics;

use crate::api::options::give;
use crate::api::solver::pc_solver;
use crate::ffi::boundary::entry;
use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::handle;
use crate::ffi::status::pc_status;

/// Counters since the start of an integration, and data on its last internal step. The structure
/// may grow at the end.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct pc_statistics {
    /// Internal steps.
    pub steps: u64,
    /// Evaluations of f, including those for difference quotients.
    pub rhs_evaluations: u64,
    /// Evaluations of ∂f/∂y.
    pub jacobian_evaluations: u64,
    /// Steps repeated because the estimated error was too large.
    pub error_test_failures: u64,
    /// Iterations of the nonlinear solver.
    pub nonlinear_iterations: u64,
    /// Failures of the nonlinear solver.
    pub nonlinear_failures: u64,
    /// Factorisations, or updates of the preconditioner.
    pub linear_setups: u64,
    /// Iterations of the Krylov solver.
    pub linear_iterations: u64,
    /// Order of the last step, 0 before the first.
    pub last_order: u64,
    /// Length of the last step, with the sign of the direction; 0 before the first.
    pub last_step: f64,
    /// Length with which the next step is tried.
    pub next_step: f64,
    /// End of the last step, which may lie beyond the time of the solver.
    pub step_time: f64,
    /// Steps shortened to end where the equations, as explicit functions of time, change in a way
    /// of which the motion so far gives no hint, as at a jump or at the beginning of a pulse.
    pub limited_steps: u64,
    /// Steps that PC_AUTO made with PC_BDF.
    pub implicit_steps: u64,
    /// How often PC_AUTO switched between its methods.
    pub changes: u64,
    /// Time at which PC_DOP853 or PC_AUTO first found the motion to be stiff; NaN if never.
    pub stiff_from: f64,
}

impl From<Statistics> for pc_statistics {
    fn from(of: Statistics) -> pc_statistics {
        pc_statistics {
            steps: of.steps,
            rhs_evaluations: of.rhs_evaluations,
            jacobian_evaluations: of.jacobian_evaluations,
            error_test_failures: of.error_test_failures,
            nonlinear_iterations: of.nonlinear_iterations,
            nonlinear_failures: of.nonlinear_failures,
            linear_setups: of.linear_setups,
            linear_iterations: of.linear_iterations,
            last_order: of.last_order.into(),
            last_step: of.last_step,
            next_step: of.current_step,
            step_time: of.current_time,
            limited_steps: of.limited_steps,
            implicit_steps: of.implicit_steps,
            changes: of.changes,
            stiff_from: of.stiff_from.unwrap_or(f64::NAN),
        }
    }
}

/// Writes the statistics so far. `size` is sizeof(pc_statistics).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_solver_statistics(
    solver: *const pc_solver,
    statistics: *mut pc_statistics,
    size: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let read = || {
        // SAFETY: null or a live handle, as the preamble demands.
        let counts = unsafe { handle(solver, "solver") }?.inner.take()?.statistics();
        if statistics.is_null() {
            return Err(CallError::Null { what: "statistics" });
        }
        // SAFETY: room for `size` bytes, as the preamble demands.
        unsafe { give(statistics, counts.into(), size) };
        Ok(())
    };
    // SAFETY: `error` is null or memory for a pointer.
    unsafe { entry(error, read) }
}
