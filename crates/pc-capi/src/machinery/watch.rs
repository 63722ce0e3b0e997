//! What a solver reports during its calls.

use std::ffi::{c_int, c_void};
use std::ops::ControlFlow;

use pc_solve::{Observer, Occurrence, Statistics};

use crate::ffi::user_data::User;
use crate::machinery::engine::EventLog;

/// The function that receives the end of each step.
pub(crate) struct Monitor {
    pub(crate) function: unsafe extern "C" fn(f64, *const f64, usize, c_int, f64, *mut c_void) -> c_int,
    pub(crate) user: User,
}

/// Passes outputs on, keeps a record of events, and calls the monitor.
pub(crate) struct Watch<'a, O> {
    pub(crate) output: O,
    pub(crate) record: &'a mut EventLog,
    pub(crate) monitor: Option<&'a Monitor>,
}

impl<O: FnMut(f64, &[f64]) -> ControlFlow<()>> Observer for Watch<'_, O> {
    fn output(&mut self, t: f64, y: &[f64]) -> ControlFlow<()> {
        (self.output)(t, y)
    }

    fn occurred(&mut self, occurrence: &Occurrence) -> ControlFlow<()> {
        self.record.note(occurrence)
    }

    fn measures(&self) -> bool {
        self.monitor.is_some()
    }

    fn measured(&mut self, t: f64, y: &[f64], work: &Statistics) -> ControlFlow<()> {
        let Some(Monitor { function, user }) = self.monitor else { return ControlFlow::Continue(()) };
        let order = c_int::try_from(work.last_order).unwrap_or(c_int::MAX);
        // SAFETY: a function of that type, as pc_solver_set_monitor demands; the state is as long as said.
        match unsafe { function(t, y.as_ptr(), y.len(), order, work.last_step, user.data) } {
            0 => ControlFlow::Continue(()),
            _ => ControlFlow::Break(()),
        }
    }
}
