//! Many motions at once, over all cores.

use std::ffi::{CString, c_char, c_int, c_void};
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::ptr;
use std::sync::{Arc, Mutex, PoisonError};

use ::pc_model::FlowEvents;
use pc_expr::LaneField;
use pc_solve::{
    Checkpoint, Chosen, Ending, Ensemble, Events, Observed, Options, Panicked, Sensitivities, Stepper, Stop,
    Trajectory, VectorField,
};

use crate::api::options::{pc_solver_options, take};
use crate::ffi::boundary::entry;
use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::{finite, handle, numbers};
use crate::ffi::status::pc_status;
use crate::machinery::engine::{Engine, engine};
use crate::machinery::event_set::Followed;
use crate::machinery::motion_field::MotionField;
use crate::machinery::system::pc_system;

/// The result of a member of an ensemble. The structure may grow at the end.
#[repr(C)]
pub struct pc_member {
    /// The number of the member, counted from 0.
    pub number: usize,
    /// PC_OK, PC_EVENT if a terminal event ended the motion, or the status of the failure.
    pub status: pc_status,
    /// Why the member failed; NULL if it did not.
    pub message: *const c_char,
    /// The output times that the member reached, as many as `rows`; the time of a terminal event is
    /// the last one.
    pub times: *const f64,
    /// The states at these times, one after the other, each of `dim` numbers. Like `times`, it is
    /// NULL where there are none.
    pub states: *const f64,
    /// The number of these times and states, even if the member failed.
    pub rows: usize,
    /// The length of a state.
    pub dim: usize,
}

/// Receives each member in order, on the thread of the call; the data to which `member` points are
/// valid during the call. Returns 0 to continue; anything else ends the ensemble with PC_STOPPED.
/// Otherwise it is like pc_observer.
pub type pc_member_observer =
    Option<unsafe extern "C" fn(member: *const pc_member, user: *mut c_void) -> c_int>;

/// The data that all members share, and the states and parameters in which they differ.
struct Plan<'a> {
    prototype: Mutex<(MotionField, FlowEvents)>,
    t: f64,
    /// The start of the model.
    start: &'a [f64],
    /// One state after the other, or none.
    states: Option<&'a [f64]>,
    parameters: Option<&'a [f64]>,
    times: &'a [f64],
    options: Options,
}

/// The result of a member.
struct Outcome {
    status: pc_status,
    message: Option<CString>,
    times: Vec<f64>,
    states: Vec<f64>,
}

impl Outcome {
    fn new() -> Outcome {
        Outcome { status: pc_status::PC_OK, message: None, times: Vec::new(), states: Vec::new() }
    }

    fn completed(motion: &Trajectory) -> Outcome {
        Outcome { times: motion.times().to_vec(), states: motion.states().to_vec(), ..Outcome::new() }
    }

    fn of(fault: &CallError) -> Outcome {
        let mut outcome = Outcome::new();
        outcome.fail(fault);
        outcome
    }

    fn fail(&mut self, fault: &CallError) {
        let (status, message) = fault.told();
        (self.status, self.message) = (status, Some(message));
    }

    /// Passes the member to the observer, and returns whether to continue.
    ///
    /// # Safety
    /// The observer is a function of type `pc_member_observer`.
    unsafe fn tell(
        &self,
        number: usize,
        dim: usize,
        observer: unsafe extern "C" fn(*const pc_member, *mut c_void) -> c_int,
        user: *mut c_void,
    ) -> ControlFlow<()> {
        let member = pc_member {
            number,
            status: self.status,
            message: self.message.as_ref().map_or(ptr::null(), |message| message.as_ptr()),
            times: if self.times.is_empty() { ptr::null() } else { self.times.as_ptr() },
            states: if self.states.is_empty() { ptr::null() } else { self.states.as_ptr() },
            rows: self.times.len(),
            dim,
        };
        // SAFETY: as promised; what the member points to lives.
        match unsafe { observer(&raw const member, user) } {
            0 => ControlFlow::Continue(()),
            _ => ControlFlow::Break(()),
        }
    }
}

impl Plan<'_> {
    /// The motion of a member, as a single solver would give it.
    fn follow(&self, member: usize, stop: &Stop<'_>) -> Outcome {
        let mut outcome = Outcome::new();
        let ended = self.engine(member).and_then(|mut engine| {
            let output = |t, y: &[f64]| {
                outcome.times.push(t);
                outcome.states.extend_from_slice(y);
                ControlFlow::Continue(())
            };
            let step = |_: f64, _: &[f64]| {
                if stop.requested() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            };
            Ok(engine.run_observed(self.times, Observed::new(output).steps(step))?)
        });
        match ended {
            Ok(Ending::Completed) => {}
            Ok(Ending::Stopped) => outcome.status = pc_status::PC_STOPPED,
            Ok(Ending::Event { .. }) => outcome.status = pc_status::PC_EVENT,
            Err(fault) => outcome.fail(&fault),
        }
        outcome
    }

    /// The field and start of a member, if it can be integrated together with others in vectors.
    fn lane(&self, member: usize) -> Option<(LaneField, Vec<f64>)> {
        let mut prototype = self.prototype.lock().unwrap_or_else(PoisonError::into_inner);
        let (field, events) = &mut *prototype;
        if !events.events().is_empty() || !field.breaks().is_empty() {
            return None;
        }
        if let Some(all) = self.parameters {
            let values = row(all, member, field.parameters().len());
            if !values.iter().all(|value| value.is_finite()) {
                return None;
            }
            field.parameters_mut().copy_from_slice(values);
        }
        Some((field.lanes()?, self.start_of(member).to_vec()))
    }

    fn start_of(&self, member: usize) -> &[f64] {
        self.states.map_or(self.start, |all| row(all, member, self.start.len()))
    }

    fn engine(&self, member: usize) -> Result<Engine, CallError> {
        let (mut field, mut events) = self.prototype.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let start = self.start_of(member);
        if let Some(all) = self.parameters {
            let values = row(all, member, field.parameters().len()).to_vec();
            for &value in &values {
                finite(value, "a parameter")?;
            }
            field.parameters_mut().copy_from_slice(&values);
            events.set_parameters(&values);
        }
        let (start, events) = (Checkpoint::start(self.t, start), Followed::new(events));
        Ok(engine(field, &start, &self.options, events, &Sensitivities::new())?)
    }
}

/// The numbers that belong to a member, among those of all members.
fn row(all: &[f64], member: usize, length: usize) -> &[f64] {
    &all[member * length..(member + 1) * length]
}

/// Integrates many members through the times, each from its own state and with its own parameters,
/// as a single solver would: the numbers are the same for any number of threads. The events of the
/// model are followed. With PC_AUTO and PC_DOP853, members of a model without events, constraints,
/// integrals to be kept, tables or explicit dependence on time are integrated side by side in
/// vectors: their last digits may differ from those of a solver, within the tolerances. With
/// PC_AUTO, members that turn out to be stiff are integrated by themselves.
///
/// `states` has members × dim numbers, member by member, at the time t; NULL for the start of
/// the model, and then t is ignored. `parameters` has members × pc_system_parameter_count
/// numbers; NULL for the current parameters of the system. The length given with NULL is 0.
/// `options` may be NULL. `threads` is the number of threads, 0 for one on each core; all of them
/// have ended when the call returns. A member that fails is passed to the observer like any other,
/// with the rows that it reached, and the others continue. An error that all members share, such as
/// one in the times, is reported for each member. Returns PC_STOPPED if the observer stops the
/// ensemble, and PC_LIMIT if the time limit or the pc_cancel of the system's options ends it; the
/// members that were finished have then been passed to the observer. The system may be used during
/// the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_ensemble_run(
    system: *const pc_system,
    options: *const pc_solver_options,
    members: usize,
    t: f64,
    states: *const f64,
    states_length: usize,
    parameters: *const f64,
    parameters_length: usize,
    times: *const f64,
    times_length: usize,
    threads: usize,
    observer: pc_member_observer,
    user: *mut c_void,
    error: *mut *mut pc_error,
) -> pc_status {
    let run = || {
        // SAFETY: null or a live handle, as the preamble demands.
        let system = unsafe { handle(system, "system") }?;
        // The observer may use the system, and not free it.
        let _kept = system.inner.keep();
        let inventory = Arc::clone(&system.inventory);
        let deadline = inventory.deadline();
        let (mut field, events) = {
            let inner = system.inner.take()?;
            (inner.field.clone(), inner.events.clone())
        };
        let (t_start, start) = inventory.start();
        let rows = |data: *const f64, found: usize, width: usize, what| {
            if data.is_null() && found == 0 {
                return Ok(None);
            }
            let too_many = CallError::Length { what, found, expected: usize::MAX };
            let expected = members.checked_mul(width).ok_or(too_many)?;
            // SAFETY: `found` numbers, as the preamble demands.
            unsafe { numbers(data, found, expected, what) }.map(Some)
        };
        let states = rows(states, states_length, start.len(), "states")?;
        let parameters = rows(parameters, parameters_length, field.parameters().len(), "parameters")?;
        // SAFETY: null or `times_length` numbers, as the preamble demands.
        let times = unsafe { numbers(times, times_length, times_length, "times") }?;
        // SAFETY: null or options, as the preamble demands.
        let options = unsafe { take(options, "options")?.options(start.len(), deadline.clone()) }?;
        let observer = observer.ok_or(CallError::Null { what: "observer" })?;
        let t = if states.is_none() { t_start } else { t };
        if let Some(&end) = times.last() {
            // One step of one member compiles the derivatives that all need. Each member reports
            // its own errors.
            let first = states.and_then(|all| all.get(..start.len())).unwrap_or(start);
            let _ = Chosen::new(&mut field, t, first, &options)
                .and_then(|mut method| Stepper::step(&mut method, end));
        }
        let prototype = Mutex::new((field, events));
        let plan = Plan { prototype, t, start, states, parameters, times, options };
        let mut ensemble = Ensemble::new();
        if let Some(threads) = NonZeroUsize::new(threads.min(members)) {
            ensemble = ensemble.threads(threads);
        }
        let span = (plan.t, plan.times, &plan.options);
        let begin = |member: u64| ((), plan.lane(member as usize));
        let in_lane = |_, (), motion: Trajectory| Outcome::completed(&motion);
        let alone = |member: u64, (), stop: &Stop<'_>| plan.follow(member as usize, stop);
        let mut ended = None;
        let consume = |member: u64, outcome: Result<Outcome, Panicked>| {
            let outcome =
                outcome.unwrap_or_else(|Panicked { message }| Outcome::of(&CallError::Panic { message }));
            // A limit ends the ensemble; it is no failure of a member.
            if outcome.status == pc_status::PC_LIMIT {
                ended = deadline.passed();
                return ControlFlow::Break(());
            }
            // SAFETY: a function of that type, as the preamble demands.
            unsafe { outcome.tell(member as usize, start.len(), observer, user) }
        };
        match ensemble.map_in_lanes(0..members as u64, span, begin, in_lane, alone, consume)? {
            Ending::Stopped => Err(ended.map_or(CallError::Stopped, CallError::Limit)),
            Ending::Completed | Ending::Event { .. } => Ok(()),
        }
    };
    // SAFETY: `error` is null or memory for a pointer.
    unsafe { entry(error, run) }
}
