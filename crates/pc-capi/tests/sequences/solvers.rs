//! Calls of solvers.

use std::ffi::c_int;
use std::ptr;
use std::slice;

use pc::*;

use crate::callbacks::{Own, Watch, destroy, follow, observe, observe_event, reset, value};
use crate::calls::SolverCall;
use crate::common::c;
use crate::handles::{Array, Handles, Outcome, flag, free_text};

impl Handles {
    fn made_solver(
        &mut self,
        make: impl FnOnce(*mut *mut pc_solver, *mut *mut pc_error) -> pc_status,
    ) -> Outcome {
        let mut made = ptr::dangling_mut();
        let outcome = self.call(|error| make(&raw mut made, error));
        assert_eq!(made.is_null(), outcome.is_err());
        if !made.is_null() {
            // SAFETY: ours, and forgotten.
            unsafe { pc_solver_free(std::mem::replace(&mut self.solver, made)) };
        }
        outcome
    }

    pub(crate) fn of_solver(&mut self, call: &SolverCall) -> Outcome {
        let (system, solver) = (self.system, self.solver);
        // SAFETY: the handles are null or live, arrays as long as said, texts are.
        unsafe {
            match call {
                SolverCall::New { method, t, y, change } => {
                    let options = options(*method, *change, y);
                    let data = if y.is_empty() { ptr::null() } else { y.as_ptr() };
                    self.made_solver(|place, error| {
                        pc_solver_new(system, &raw const options, *t, data, y.len(), place, error)
                    })
                }
                SolverCall::Advance(t, length) => {
                    let mut y = self.state(*length);
                    let (data, len) = (y.data(), y.len());
                    self.call(|error| pc_solver_advance(solver, *t, data, len, error))
                }
                SolverCall::TakeParameters => {
                    self.call(|error| pc_solver_take_parameters(solver, system, error))
                }
                SolverCall::Run(times, stop) => {
                    let (data, len, mut watch) = (times.as_ptr(), times.len(), Watch { solver, stop: *stop });
                    let user = (&raw mut watch).cast();
                    self.call(|error| pc_solver_run(solver, data, len, Some(observe), user, error))
                }
                SolverCall::Step(towards, length) => {
                    let (mut t, mut y) = (0.0, self.state(*length));
                    let (data, len) = (y.data(), y.len());
                    if length % 16 == 7 {
                        return self.call(|error| pc_solver_reset(solver, *towards, data, len, error));
                    }
                    self.call(|error| pc_solver_step(solver, *towards, &raw mut t, data, len, error))
                }
                SolverCall::AddEvent { direction, function, good } => {
                    let code = c_int::from(function % 4 > 1) + c_int::from(function % 16 == 15);
                    let user = Own::boxed(usize::from(*good) * 2, code);
                    let resets: pc_event_reset = if function % 2 == 0 { Some(reset) } else { None };
                    let name = if function % 32 == 31 { ptr::null() } else { c"\u{301}".as_ptr() };
                    let (direction, terminal) = (c_int::from(*direction), c_int::from(function % 8 == 7));
                    self.call(|error| {
                        let (value, destroy): (pc_event_function, _) = (Some(value), Some(destroy as _));
                        pc_solver_add_event(
                            solver, name, direction, terminal, value, resets, user, destroy, error,
                        )
                    })
                }
                SolverCall::AddSensitivity(parameter, length) => {
                    let mut start = self.state(*length);
                    let (data, len) = if parameter % 3 == 0 {
                        (ptr::null(), 0)
                    } else {
                        (start.data().cast_const(), start.len())
                    };
                    self.call(|error| {
                        pc_solver_add_sensitivity(solver, usize::from(*parameter) / 64, data, len, error)
                    })
                }
                SolverCall::Observe(which) => {
                    if which % 7 == 6 {
                        let monitor: pc_monitor = if which % 2 == 0 { None } else { Some(follow) };
                        let user = Own::boxed(2, c_int::from(which % 5 == 0));
                        return self.call(|error| {
                            pc_solver_set_monitor(solver, monitor, user, Some(destroy), error)
                        });
                    }
                    let observer: pc_event_observer = if which % 3 == 0 { None } else { Some(observe_event) };
                    if which % 5 == 0 {
                        let user = Own::boxed(2, 0);
                        return self.call(|error| {
                            pc_solver_set_event_observer(solver, observer, user, Some(destroy), error)
                        });
                    }
                    self.call(|error| pc_solver_observe_events(solver, observer, flag(which % 2 == 0), error))
                }
                SolverCall::Occurrences(event, before, after) => self.occurrences(*event, *before, *after),
                SolverCall::Interpolate(t, length, order) => {
                    let mut y = self.state(*length);
                    let order = if *order > 250 { u32::MAX } else { u32::from(order % 4) };
                    let (data, len) = (y.data(), y.len());
                    self.call(|error| pc_solver_interpolate(solver, *t, order, data, len, error))
                }
                SolverCall::RunDense(t) => {
                    let mut made = ptr::null_mut();
                    let outcome = self.call(|error| pc_solver_run_dense(solver, *t, &raw mut made, error));
                    if !made.is_null() {
                        pc_dense_free(std::mem::replace(&mut self.dense, made));
                    }
                    outcome
                }
                SolverCall::Read(which) => {
                    let (mut t, mut y, mut work) = (0.0, self.state(which / 4), pc_statistics::default());
                    let (data, len) = (y.data(), y.len());
                    let mut weights = self.state(which / 2);
                    self.call(|error| match which % 5 {
                        4 => pc_solver_errors(solver, weights.data(), weights.len(), data, len, error),
                        3 => pc_solver_sensitivity(solver, usize::from(*which) / 64, data, len, error),
                        0 => pc_solver_time(solver, &raw mut t, error),
                        1 => pc_solver_state(solver, data, len, error),
                        // The structure of an older header is shorter.
                        _ => pc_solver_statistics(solver, &raw mut work, usize::from(which % 12) * 8, error),
                    })
                }
                SolverCall::Checkpoint(label) => {
                    let (label, mut data, mut length) = (c(label), ptr::null_mut(), 0);
                    let (data_place, length_place) = (&raw mut data, &raw mut length);
                    self.call(|error| {
                        pc_solver_checkpoint(solver, label.as_ptr(), data_place, length_place, error)
                    })?;
                    self.checkpoint = slice::from_raw_parts(data.cast::<u8>(), length).to_vec();
                    pc_bytes_free(data);
                    Ok(())
                }
                SolverCall::Restore(change, method) => self.restore(*change, *method),
                SolverCall::Free => {
                    pc_solver_free(std::mem::replace(&mut self.solver, ptr::null_mut()));
                    Ok(())
                }
            }
        }
    }

    /// Room for the state, rarely of a wrong length.
    fn state(&self, length: u8) -> Array {
        // SAFETY: null or a live handle. The solver may be of another system.
        Array::of(length.wrapping_mul(37), unsafe { pc_system_dim(self.system.as_ref()) })
    }

    fn occurrences(&self, event: u8, before: u8, after: u8) -> Outcome {
        let (solver, event, mut t, mut number, mut count) = (self.solver, usize::from(event), 0.0, 0, 0);
        let (mut before, mut after) = (self.state(before), self.state(after));
        let (y, n, z, m) = (before.data(), before.len(), after.data(), after.len());
        // SAFETY: null or a live handle, arrays as long as said.
        unsafe {
            let _ = self.call(|error| pc_solver_terminal_event(solver, &raw mut number, error));
            let _ = self.call(|error| pc_solver_event_occurrences(solver, event, &raw mut count, error));
            assert_eq!(
                pc_solver_event_name(solver.as_ref(), event).is_null(),
                event >= pc_solver_event_count(solver.as_ref())
            );
            self.call(|error| pc_solver_last_occurrence(solver, event, &raw mut t, y, n, z, m, error))
        }
    }

    /// From the last checkpoint, cut short or changed in one bit if `change` says so.
    fn restore(&mut self, change: u8, method: i8) -> Outcome {
        let mut bytes = self.checkpoint.clone();
        let place = usize::from(change) * 7 % bytes.len().max(1);
        match change % 4 {
            0 => bytes.truncate(place),
            1 if !bytes.is_empty() => bytes[place] ^= 1 << (change % 8),
            _ => {}
        }
        let (system, data, len) = (self.system, bytes.as_ptr().cast(), bytes.len());
        let options = pc_solver_options { method: method.into(), max_steps: 200, ..Default::default() };
        // SAFETY: the handles are null or live, the bytes as many as said.
        unsafe {
            let mut label = ptr::null_mut();
            let labelled = self.call(|error| pc_checkpoint_label(data, len, &raw mut label, error));
            free_text(label);
            assert_eq!(labelled.is_ok(), change % 4 > 1 && len > 0);
            let outcome = self.made_solver(|place, error| {
                pc_solver_restore(system, &raw const options, data, len, place, error)
            });
            assert!(outcome.is_err() || labelled.is_ok());
            outcome
        }
    }
}

/// One of them is not known.
static INEQUALITIES: [c_int; 8] = [0, 1, 0, 2, 0, -1, -2, 3];

/// Options, one of which may be changed to a right or wrong value. The tolerances live as long as
/// `y`.
fn options(method: i8, change: u8, y: &[f64]) -> pc_solver_options {
    let mut options = pc_solver_options { method: c_int::from(method), max_steps: 200, ..Default::default() };
    let number = y.first().copied().unwrap_or(0.5);
    match change % 32 {
        0 => options.size = usize::from(change),
        1 => options.iteration = c_int::from(change / 32) - 1,
        2 => options.linear_solver = c_int::from(change / 32) - 1,
        3 => options.max_order = c_int::from(change / 32) - 1,
        4 => options.relative_tolerance = number,
        5 => options.absolute_tolerance = number,
        6 => (options.absolute_tolerances, options.absolute_tolerances_length) = (y.as_ptr(), y.len()),
        7 => options.initial_step = number,
        8 => options.min_step = number,
        9 => options.max_step = number,
        10 => options.stop_time = number,
        11 => options.max_steps = u64::from(change / 32),
        12 => {
            let of = &INEQUALITIES[..y.len().min(INEQUALITIES.len())];
            (options.inequalities, options.inequalities_length) = (of.as_ptr(), of.len());
        }
        _ => {}
    }
    options
}
