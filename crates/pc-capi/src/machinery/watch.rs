//! What a solver reports during its calls.

use std::ffi::{c_int, c_void};
use std::ops::ControlFlow;

use pc_solve::{Occurrence, Statistics};

use crate::ffi::user_data::User;

/// A solver's record of its events; its size does not depend on how often they occur.
#[derive(Default)]
pub(crate) struct EventLog {
    /// How often each event has occurred.
    pub(crate) counts: Vec<u64>,
    /// The last occurrence of each event.
    pub(crate) last: Vec<Option<Occurrence>>,
    /// The terminal event that ended the last call.
    pub(crate) terminal: Option<usize>,
    pub(crate) observer: Option<Observer>,
}

/// The function that receives each occurrence.
pub(crate) struct Observer {
    pub(crate) function:
        unsafe extern "C" fn(usize, f64, *const f64, *const f64, usize, *mut c_void) -> c_int,
    pub(crate) user: User,
}

impl EventLog {
    pub(crate) fn of(events: usize) -> EventLog {
        EventLog { counts: vec![0; events], last: vec![None; events], ..EventLog::default() }
    }

    /// Counts an occurrence and passes it to the observer.
    fn note(&mut self, occurrence: &Occurrence) -> ControlFlow<()> {
        self.counts[occurrence.event] += 1;
        self.last[occurrence.event] = Some(occurrence.clone());
        let Some(Observer { function, user }) = &self.observer else { return ControlFlow::Continue(()) };
        let Occurrence { event, time, state_before, state_after } = occurrence;
        let (before, after) = (state_before.as_ptr(), state_after.as_ptr());
        // SAFETY: a function of that type, as pc_solver_observe_events demands; both states are as long as said.
        match unsafe { function(*event, *time, before, after, state_after.len(), user.data) } {
            0 => ControlFlow::Continue(()),
            _ => ControlFlow::Break(()),
        }
    }
}

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

impl<O: FnMut(f64, &[f64]) -> ControlFlow<()>> pc_solve::Observer for Watch<'_, O> {
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
