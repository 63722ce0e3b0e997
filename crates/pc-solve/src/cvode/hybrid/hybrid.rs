//! An integration that events interrupt.

use std::fmt;

use pc_expr::{Direction, Event, Events, Failure, VectorField};

use crate::cvode::cvode::{Cvode, Ending};
use crate::error::{InputError, NonFinite, Reason, SolveError};
use crate::events::events::{Accumulation, History};
use crate::events::root_finding::{Passage, Sample, Sides};
use crate::integration::statistics::Statistics;

/// An integration of ẏ = f(t, y) by [`Cvode`] with [`Events`].
///
/// Along each internal step the functions of the events are evaluated at states on the polynomial of the method,
/// [projected](VectorField::project) where the field does so: at the ends of so many equal parts of the step as
/// [asked for](crate::Options::samples_per_step), and where three of these values in sequence suggest that a function
/// passes through zero twice. Between two of these places an even number of passages of a function may be missed; of an odd
/// number one is found, so that it is always on the side that it is taken to be on. After a passage the rest of the step is
/// looked at in as many parts again.
///
/// A passage is located to 1e-15 max(|t|, h/1000) in a step of length h, and functions that pass through zero within 16
/// times that of each other do so together: their resets are applied one after the other, in the order of
/// the events, each to the state that the one before has left. After a reset the integration
/// [restarts](Cvode::restart) with the same options.
///
/// A function that comes to zero, or beyond it, and is back on its side that much later touches zero: nothing occurs. One
/// that comes to zero and stays there passes when it comes, and not when it leaves. What counts is the function as it is
/// computed, with its rounding.
///
/// After a reset the events that caused it have to leave zero before they can occur again: a function that the reset has
/// left so near to zero that the tolerances do not tell it from zero goes on to the side that it moves to.
///
/// CVODES has a search for roots of its own. It is not used because it knows neither projected states nor what a reset
/// does to the functions, reports one of two roots in a step at most, and may report a root again after a restart.
///
/// Where the integration stands at an event, its state is y⁺: states are continuous from the right in the direction of
/// integration. After an error or a panic it stands where it last could.
pub struct Hybrid<F, E> {
    /// Stands at the end of its last step; its `time` is that of this integration.
    pub(super) engine: Cvode<F>,
    pub(super) events: E,
    pub(super) histories: Vec<History>,
    /// 1 or −1 since the first step.
    pub(super) direction: Option<f64>,
    /// Up to where it is known what occurs, the functions there, and y.
    pub(super) front: Sample,
    pub(super) front_state: Vec<f64>,
    pub(super) sides: Sides,
    /// The sides before the front moved there.
    pub(super) sides_before: Sides,
    /// The events that occur at the front and have yet to be dealt with.
    pub(super) due: Vec<usize>,
    pub(super) noise: Vec<f64>,
    /// The side of zero that each of those due goes on to.
    pub(super) beyond: Vec<f64>,
    /// y(`time`), unless `time` is the front.
    pub(super) output: Vec<f64>,
}

impl<F: VectorField, E: Events> fmt::Debug for Hybrid<F, E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Hybrid")
            .field("time", &self.time())
            .field("state", &self.state())
            .field("events", &self.events.events())
            .field("statistics", &self.statistics())
            .finish_non_exhaustive()
    }
}

impl<F: VectorField> Cvode<F> {
    /// This integration, with events from where it stands.
    ///
    /// Its [sensitivities](Cvode::with_sensitivities), if there are any, are those of the motion with its events: they jump
    /// where a reset does. For that resets are also applied to states near by, and events that reset have to tell their
    /// [derivatives](Events::by_parameter) by the parameters that are asked for.
    ///
    /// # Errors
    /// [`SolveError::Integration`] with [`Reason::Event`] if a function of an event cannot be evaluated there;
    /// [`InputError::EventParameters`].
    pub fn with_events<E: Events>(self, events: E) -> Result<Hybrid<F, E>, SolveError> {
        let resets = events.events().iter().any(Event::resets);
        let by_parameters = self.sensitivity_parameters().iter().any(Option::is_some);
        if resets && by_parameters && !events.has_parameter_derivatives() {
            return Err(InputError::EventParameters.into());
        }
        let (t, state) = (self.time, self.state().to_vec());
        let n = events.events().len();
        let sides = Sides::new(directions(&events));
        let mut engine = self;
        if t != engine.step_time {
            let matrix = engine.sensitivities()?.to_vec();
            engine.restart_with_sensitivities(t, &state, &matrix)?;
        }
        let mut hybrid = Hybrid {
            engine,
            events,
            histories: vec![History::default(); n],
            direction: None,
            front: Sample { t, values: Vec::new() },
            output: state.clone(),
            front_state: state.clone(),
            sides_before: sides.clone(),
            sides,
            due: Vec::new(),
            noise: Vec::new(),
            beyond: Vec::new(),
        };
        hybrid.front.values = hybrid.evaluate(t, &state)?;
        hybrid.sides.pass(&hybrid.front.values);
        Ok(hybrid)
    }
}

pub(super) fn directions(events: &impl Events) -> Vec<Direction> {
    events.events().iter().map(Event::crosses).collect()
}

impl<F: VectorField, E: Events> Hybrid<F, E> {
    /// When occurrences of an event accumulate, which is an error; as the [options](crate::Options::accumulation) say unless
    /// given.
    pub fn accumulation(self, accumulation: Accumulation) -> Self {
        let mut hybrid = self;
        hybrid.engine.accumulation = accumulation;
        hybrid
    }

    /// Where the integration stands: the time last advanced to, or that of the event that stopped it.
    pub fn time(&self) -> f64 {
        self.engine.time
    }

    /// y at [`time`](Hybrid::time).
    pub fn state(&self) -> &[f64] {
        if self.engine.time == self.front.t { &self.front_state } else { &self.output }
    }

    /// S at [`time`](Hybrid::time), as [`Cvode::sensitivities`] gives it: S⁺ at an event.
    ///
    /// # Errors
    /// As there.
    pub fn sensitivities(&mut self) -> Result<&[f64], SolveError> {
        self.engine.sensitivities()
    }

    /// The integrals from the start to [`time`](Hybrid::time), over what occurred, as [`Cvode::integrals`] gives them.
    ///
    /// # Errors
    /// As there.
    pub fn integrals(&mut self) -> Result<Vec<f64>, SolveError> {
        self.engine.integrals()
    }

    /// The vector field.
    pub fn field(&self) -> &F {
        self.engine.field()
    }

    /// The events.
    pub fn events(&self) -> &E {
        &self.events
    }

    /// Ends the integration and gives the vector field and the events back.
    pub fn into_parts(self) -> (F, E) {
        (self.engine.into_field(), self.events)
    }

    /// The work so far, that before restarts included.
    pub fn statistics(&self) -> Statistics {
        self.engine.statistics()
    }

    /// Moves the front to the next event or to the end of the next internal step.
    pub(super) fn go_on(&mut self, towards: f64) -> Result<(), SolveError> {
        if self.engine.step_time == self.front.t {
            if self.arrives(towards)? {
                return Ok(());
            }
            let time = self.engine.time;
            self.engine.internal_step(towards)?;
            self.engine.time = time;
            self.direction.get_or_insert(1.0_f64.copysign(towards - self.front.t));
        }
        let to = self.engine.step_time;
        let (engine, events) = (&mut self.engine, &mut self.events);
        let pieces = engine.samples_per_step;
        let mut blamed = 0;
        let mut values = |t: f64| {
            let state = if t == to {
                engine.step_state.as_slice()
            } else {
                engine.interpolate_to_work(t, 0).map_err(Fault::Solver)?;
                engine.work.as_slice()
            };
            values_at(events, t, state, &mut blamed).map_err(|failure| Fault::Event(t, failure))
        };
        let mut sides = self.sides.clone();
        let passage = match sides.first(self.front.clone(), to, pieces, &mut values) {
            Ok(passage) => passage,
            Err(Fault::Solver(error)) => return Err(self.stay(error)),
            Err(Fault::Event(t, failure)) => return Err(self.event_error(blamed, t, failure)),
        };
        if self.engine.time == self.front.t {
            self.output.copy_from_slice(&self.front_state);
        }
        let (front, noise, due, beyond) = match passage {
            Passage::Clear(end) => (end, Vec::new(), Vec::new(), Vec::new()),
            Passage::Crossing(crossing) => (crossing.at, crossing.noise, crossing.events, crossing.beyond),
        };
        let state = if front.t == to {
            self.engine.step_state.as_slice()
        } else {
            if let Err(error) = self.engine.interpolate_to_work(front.t, 0) {
                return Err(self.stay(error));
            }
            self.engine.work.as_slice()
        };
        self.front_state.copy_from_slice(state);
        self.sides_before = std::mem::replace(&mut self.sides, sides);
        (self.front, self.noise, self.due, self.beyond) = (front, noise, due, beyond);
        Ok(())
    }

    /// Whether the end is so near to a restart that no step can go there. Then it is where the integration is.
    fn arrives(&mut self, towards: f64) -> Result<bool, SolveError> {
        let target = self.engine.stop_time.unwrap_or(towards);
        let rounding = 4.0 * f64::EPSILON * target.abs().max(self.front.t.abs());
        if !self.engine.restarted || (target - self.front.t).abs() > rounding {
            return Ok(false);
        }
        let time = self.engine.time;
        let matrix = self.engine.sensitivities_to_keep();
        self.engine.restart_with_sensitivities(target, &self.front_state, &matrix)?;
        self.engine.direction = self.direction;
        self.engine.time = if time == self.front.t { target } else { time };
        self.front.t = target;
        Ok(true)
    }

    /// The functions at a state.
    pub(super) fn evaluate(&mut self, t: f64, state: &[f64]) -> Result<Vec<f64>, SolveError> {
        let mut blamed = 0;
        values_at(&mut self.events, t, state, &mut blamed)
            .map_err(|failure| self.event_error(blamed, t, failure))
    }

    /// The error of the function of an event.
    pub(super) fn event_error(&mut self, event: usize, t: f64, failure: Failure) -> SolveError {
        let reason = Reason::Event { event: self.name(event), t };
        self.failed(reason, Some(failure))
    }

    pub(super) fn name(&self, event: usize) -> String {
        self.events.events().get(event).map_or_else(String::new, |event| event.name().to_owned())
    }

    /// The error of something that did not succeed beyond the front, where the integration stands then.
    pub(super) fn failed(&mut self, reason: Reason, failure: Option<Failure>) -> SolveError {
        let error = self.engine.failed(reason, failure);
        self.stay(error)
    }

    pub(super) fn stay(&mut self, mut error: SolveError) -> SolveError {
        self.engine.time = self.front.t;
        if let SolveError::Integration(error) = &mut error {
            error.time = self.front.t;
            error.state.clone_from(&self.front_state);
        }
        error
    }
}

enum Fault {
    Solver(SolveError),
    Event(f64, Failure),
}

/// The functions at a state; `blamed` is the first that is not finite, or was not written before the failure.
fn values_at(
    events: &mut impl Events,
    t: f64,
    state: &[f64],
    blamed: &mut usize,
) -> Result<Vec<f64>, Failure> {
    let mut values = vec![f64::NAN; events.events().len()];
    if let Err(failure) = events.evaluate(t, state, &mut values) {
        *blamed = values.iter().position(|value| !value.is_finite()).unwrap_or(0);
        return Err(failure);
    }
    match values.iter().position(|value| !value.is_finite()) {
        None => Ok(values),
        Some(i) => {
            *blamed = i;
            let event = events.events()[i].name().to_owned();
            Err(Failure::recoverable(NonFinite::Event { event, value: values[i], t }))
        }
    }
}
