//! An integration with any method; events may interrupt it.

use std::fmt;
use std::ops::ControlFlow;

use pc_expr::{Direction, Event, Events, RootSeparation, VectorField};

use crate::error::{InputError, SolveError};
use crate::events::events::{Accumulation, History, NoEvents};
use crate::events::root_finding::Sides;
use crate::events::samples::{Room, Sample};
use crate::integration::checks::{check_inequalities, check_length, finite};
use crate::integration::held_sides::HeldSides;
use crate::integration::pace::Pace;
use crate::integration::statistics::Statistics;
use crate::integration::stepper::Stepper;

/// An integration of ẏ = f(t, y) with a [method](Stepper), with or without [`Events`].
///
/// At each moment, it is at a [`time`](Integration::time) with a [`state`](Integration::state). The
/// method may be up to one step ahead; outputs in between are interpolated with the polynomial of
/// the method, so that additional outputs do not change the steps. The first step fixes the
/// direction of time. After an error or a panic of the field the integration is at the last state
/// it reached.
///
/// # Events
///
/// Along each step the event functions are evaluated at states on the polynomial of the method,
/// [projected](VectorField::project) where the field does so. Functions given as [a
/// program](Events::program) of the state are sampled at times [between
/// which](pc_expr::RootSeparation) each has at most one root along that polynomial, so that no root
/// is missed. Others are sampled at the ends of
/// [`samples_per_step`](crate::Options::samples_per_step) equal parts of the step, and further
/// between two of these where divided differences leave doubt, or where three successive values
/// suggest that a function passes through zero twice. Between two samples an even number of
/// passages of such a function may be missed; if the number is odd, one is found, so that the sign
/// of the function is always known. After a passage the rest of the step is searched anew.
///
/// A passage is located to 1e-15 max(|t|, h/1000) in a step of length h, and functions that pass
/// through zero within 16 times that distance of each other count as doing so simultaneously: their
/// resets are applied one after the other, in the order of the events. After a reset the
/// integration [restarts](Integration::restart) with the same options.
///
/// A function that reaches or crosses zero, but is back on its original side within this
/// resolution, only touches zero: no event occurs. For a function that reaches zero and stays
/// there, the event occurs on arrival, not on departure. All this holds for the function as
/// computed, with its rounding errors.
///
/// If the reset of one event makes the function of another change sign in the direction of that
/// other event, the other event occurs at the same time, from the state after the reset, and so on
/// until no further event is set off; more than 100 occurrences of one event at one time are an
/// [error](crate::Reason::Cascade). The reset of an event does not make the event itself occur
/// again.
///
/// After a reset the functions of the events that caused it have to leave zero before these events
/// can occur again: a function within the tolerances of zero counts as being on the side to which
/// it moves.
///
/// The root finding of CVODES is not used: it ignores projections and resets, reports at most one
/// of two roots in a step, and may report a root again after a restart.
///
/// At an event the state is y⁺: states are continuous from the right in the direction of
/// integration.
pub struct Integration<S, E = NoEvents> {
    /// The method; its time is the time of this integration.
    pub(crate) engine: S,
    pub(crate) events: E,
    pub(crate) histories: Vec<History>,
    /// The direction of time, 1 or −1, once the first step has been made.
    pub(crate) direction: Option<f64>,
    /// The time up to which events are known, with the event functions there, and y.
    pub(crate) front: Sample,
    pub(crate) front_state: Vec<f64>,
    pub(crate) sides: Sides,
    /// The sides before the last move of the front, and room for the sides after the next step.
    pub(crate) sides_before: Sides,
    pub(crate) sides_after: Sides,
    /// Room for samples along a step.
    pub(crate) room: Room,
    /// The events at the front that are still to be applied.
    pub(crate) due: Vec<usize>,
    pub(crate) noise: Vec<f64>,
    /// The sign that each of the `due` functions takes next.
    pub(crate) beyond: Vec<f64>,
    /// The state y(`time`), unless `time` is the time of the front.
    pub(crate) output: Vec<f64>,
    /// Room for the end of a step.
    pub(crate) ahead: Vec<f64>,
    /// Room for the times at which event functions are evaluated, and for the polynomial of a step.
    pub(crate) times: Vec<f64>,
    pub(crate) coefficients: Vec<f64>,
    /// What separates the roots of event functions given as a program.
    pub(crate) separation: Option<RootSeparation>,
    /// The sides of the surfaces of the field; the functions of the surfaces follow those of the
    /// events.
    pub(crate) held: HeldSides,
    /// The derivatives of the time of each occurrence so far, if there are columns.
    pub(crate) time_derivatives: Vec<Vec<f64>>,
    /// Whether no step has been made since a restart.
    pub(crate) restarted: bool,
    /// Whether the motion has been restarted, for example by a reset.
    pub(crate) jumped: bool,
    /// The pace of the integration.
    pub(crate) pace: Pace,
}

/// How a [`run`](Integration::run) ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    /// All output times were reached.
    Completed,
    /// An observer stopped the integration.
    Stopped,
    /// A terminal event ended the integration.
    Event {
        /// The index of the event.
        event: usize,
    },
}

impl<S: Stepper, E: Events> fmt::Debug for Integration<S, E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Integration")
            .field("time", &self.time())
            .field("state", &self.state())
            .field("events", &self.events.events())
            .field("statistics", &self.statistics())
            .finish_non_exhaustive()
    }
}

impl<S: Stepper> Integration<S> {
    /// An integration with a method that has not made a step yet.
    pub fn of(mut stepper: S) -> Self {
        let (t, state) = (stepper.time(), stepper.end_state().to_vec());
        let held = HeldSides::of(stepper.field_mut());
        let sides = Sides::new(directions(&NoEvents, &held));
        let values = vec![1.0; held.len()];
        Integration {
            engine: stepper,
            events: NoEvents,
            histories: Vec::new(),
            direction: None,
            front: Sample { t, values },
            output: state.clone(),
            ahead: state.clone(),
            front_state: state,
            sides_before: sides.clone(),
            sides_after: sides.clone(),
            room: Room::new(held.len()),
            held,
            sides,
            due: Vec::new(),
            noise: Vec::new(),
            beyond: Vec::new(),
            times: Vec::new(),
            coefficients: Vec::new(),
            separation: None,
            time_derivatives: Vec::new(),
            restarted: false,
            jumped: false,
            pace: Pace::default(),
        }
    }

    /// Adds events to this integration, from its current time on.
    ///
    /// The [sensitivities](crate::Cvode::with_sensitivities), if any, are those of the motion with
    /// its events: they jump at resets. For these sensitivities, resets are also applied to nearby
    /// states, and events with resets need [derivatives](Events::by_parameter) with respect to the
    /// parameters of the sensitivities.
    ///
    /// # Errors
    /// [`SolveError::Integration`] with [`Reason::Event`](crate::Reason::Event) if an event
    /// function cannot be evaluated there; [`InputError::EventParameters`].
    pub fn with_events<E: Events>(mut self, events: E) -> Result<Integration<S, E>, SolveError> {
        let resets = events.events().iter().any(Event::resets);
        let by_parameters = self.engine.column_parameters().iter().any(Option::is_some);
        if resets && by_parameters && !events.has_parameter_derivatives() {
            return Err(InputError::EventParameters.into());
        }
        let (t, state) = (self.time(), self.state().to_vec());
        if t != self.engine.end_time() {
            let columns = self.engine.columns()?;
            self.engine.restart(t, &state, &columns, None)?;
            (self.jumped, self.restarted, self.direction) = (true, true, None);
        }
        let n = events.events().len();
        let held = HeldSides::of(self.engine.field_mut());
        let sides = Sides::new(directions(&events, &held));
        let mut integration = Integration {
            engine: self.engine,
            events,
            histories: vec![History::default(); n],
            direction: self.direction,
            front: Sample { t, values: Vec::new() },
            output: state.clone(),
            ahead: state.clone(),
            front_state: state.clone(),
            sides_before: sides.clone(),
            sides_after: sides.clone(),
            room: Room::new(n + held.len()),
            held,
            sides,
            due: Vec::new(),
            noise: Vec::new(),
            beyond: Vec::new(),
            // Polynomials of CVODES have up to 13 coefficients a component; the order rises during
            // the integration.
            times: Vec::with_capacity(64),
            coefficients: Vec::with_capacity(16 * state.len()),
            separation: None,
            time_derivatives: Vec::new(),
            restarted: self.restarted,
            jumped: self.jumped,
            pace: Pace::default(),
        };
        integration.front.values = integration.evaluate(t, &state)?;
        integration.sides.pass(&integration.front.values);
        Ok(integration)
    }

    /// Integrates to `t` and returns the state there; returns it at once if `t` is the current
    /// time.
    ///
    /// # Errors
    /// As for [`advance_to`](Integration::advance_to).
    pub fn state_at(&mut self, t: f64) -> Result<&[f64], SolveError> {
        self.advance_to(t, |_| ControlFlow::Continue(()))?;
        Ok(self.state())
    }

    /// Takes one step in the direction of `towards` and returns its end, which may lie beyond that
    /// time.
    ///
    /// # Errors
    /// As for [`step`](Integration::step).
    pub fn step_towards(&mut self, towards: f64) -> Result<f64, SolveError> {
        self.step(towards, |_| ControlFlow::Continue(()))?;
        Ok(self.time())
    }
}

/// The directions of the events, then those of the surfaces of the field.
pub(crate) fn directions(events: &impl Events, held: &HeldSides) -> Vec<Direction> {
    let surfaces = std::iter::repeat_n(Direction::Both, held.len());
    events.events().iter().map(Event::crosses).chain(surfaces).collect()
}

impl<S: Stepper, E: Events> Integration<S, E> {
    /// Sets when occurrences of an event count as accumulated, which is an error; the default is
    /// the setting of the [options](crate::Options::accumulation).
    pub fn accumulation(mut self, accumulation: Accumulation) -> Self {
        self.engine.limits_mut().accumulation = accumulation;
        self
    }

    /// The current time: the time last advanced to, or that of the event that stopped the
    /// integration.
    pub fn time(&self) -> f64 {
        self.engine.time()
    }

    /// y at [`time`](Integration::time).
    pub fn state(&self) -> &[f64] {
        if self.time() == self.front.t { &self.front_state } else { &self.output }
    }

    /// The vector field.
    pub fn field(&self) -> &S::Field {
        self.engine.field()
    }

    /// The events.
    pub fn events(&self) -> &E {
        &self.events
    }

    /// The method.
    pub fn stepper(&self) -> &S {
        &self.engine
    }

    /// The method, mutable: it may compute what it knows of the last step, but must not make one.
    pub(crate) fn stepper_mut(&mut self) -> &mut S {
        &mut self.engine
    }

    /// Ends the integration and returns the vector field.
    pub fn into_field(mut self) -> S::Field {
        self.release();
        self.engine.into_field()
    }

    /// Releases the field, which from then on takes the sides given by its own functions.
    pub(crate) fn release(&mut self) {
        if let Some(field) = self.engine.field_mut().switching() {
            field.hold(None);
        }
    }

    /// Ends the integration and returns the vector field and the events.
    pub fn into_parts(mut self) -> (S::Field, E) {
        self.release();
        (self.engine.into_field(), self.events)
    }

    /// The work so far, including that before restarts.
    pub fn statistics(&self) -> Statistics {
        self.engine.statistics()
    }

    /// Restarts the clock of the [deadline](crate::Options::deadline), if a deadline is set.
    pub fn renew_deadline(&mut self) {
        if let Some(deadline) = &mut self.engine.limits_mut().deadline {
            deadline.renew();
        }
    }

    /// Sets a time beyond which the vector field is never evaluated, or removes it.
    ///
    /// # Errors
    /// [`SolveError::Input`] if it is not finite or lies behind the last step.
    pub fn set_stop_time(&mut self, stop_time: Option<f64>) -> Result<(), SolveError> {
        if let Some(t) = stop_time {
            finite("the stop time", t)?;
            let current = self.engine.end_time();
            if self.direction.is_some_and(|direction| (t - current) * direction < 0.0) {
                return Err(InputError::Behind { requested: t, current }.into());
            }
        }
        self.engine.set_stop_time(stop_time)
    }

    /// Restarts from y(t) = y, for example after a jump of the state.
    ///
    /// The options and the stop time stay the same, and the [statistics](Integration::statistics)
    /// continue. A multistep method begins at order 1; the next step may go in either direction of
    /// time. The signs of the event functions are those at the new state.
    ///
    /// # Errors
    /// [`SolveError::Input`] if a value is not finite or a length is wrong, or if there are
    /// sensitivities, which then [have to be given too](Integration::restart_with_sensitivities);
    /// [`SolveError::Setup`] if CVODES refuses. After an error the integration is unchanged.
    pub fn restart(&mut self, t: f64, y: &[f64]) -> Result<(), SolveError> {
        if !self.engine.column_parameters().is_empty() {
            return Err(InputError::Restart.into());
        }
        self.restart_with_columns(t, y, &[])
    }

    pub(crate) fn restart_with_columns(
        &mut self,
        t: f64,
        y: &[f64],
        columns: &[f64],
    ) -> Result<(), SolveError> {
        finite("the start time", t)?;
        check_length("the start", y.len(), self.field().dim())?;
        if let Some(i) = y.iter().position(|value| !value.is_finite()) {
            let what = format!("{} at the start", self.field().component_name(i));
            return Err(InputError::NotFinite { what, value: y[i] }.into());
        }
        check_inequalities(self.field(), y, &self.engine.limits().inequalities)?;
        self.held.are_known = false;
        let values = self.evaluate(t, y)?;
        self.engine.restart(t, y, columns, None)?;
        (self.direction, self.restarted, self.jumped) = (None, true, true);
        self.sides = Sides::new(directions(&self.events, &self.held));
        self.sides.pass(&values);
        self.sides_before = self.sides.clone();
        self.front = Sample { t, values };
        self.front_state.copy_from_slice(y);
        self.due.clear();
        Ok(())
    }

    /// Changes the field at the current time, for example the value of an input, and
    /// [restarts](Integration::restart) there: the part of a step beyond
    /// [`time`](Integration::time) is discarded.
    ///
    /// # Errors
    /// As for [`restart`](Integration::restart); the field remains changed nevertheless.
    pub fn change(&mut self, change: impl FnOnce(&mut S::Field)) -> Result<(), SolveError> {
        let (t, state) = (self.time(), self.state().to_vec());
        change(self.engine.field_mut());
        self.restart(t, &state)
    }
}
