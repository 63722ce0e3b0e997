//! The front of an integration: the time up to which its events are known.

use std::sync::Arc;

use pc_expr::{Events, Failure, PolynomialMotion, RootSeparation, VectorField};

use crate::error::{NonFinite, Reason, SolveError};
use crate::events::root_finding::Passage;
use crate::events::samples::Look;
use crate::integration::breaks::break_at;
use crate::integration::held_sides::write_functions;
use crate::integration::integration::Integration;
use crate::integration::stepper::Stepper;

/// While the motion slides along surfaces, each step is divided into this many times as many parts
/// for the search.
const ALONG_SURFACES: u32 = 16;

impl<S: Stepper, E: Events> Integration<S, E> {
    /// Moves the front to the next event or to the end of the next step.
    pub(crate) fn go_on(&mut self, towards: f64) -> Result<(), SolveError> {
        let time = self.engine.time();
        if self.engine.end_time() == self.front.t {
            if self.arrives(towards)? {
                return Ok(());
            }
            self.begin_on_sides(1.0_f64.copysign(towards - self.front.t))?;
            self.leave_what_jumps(towards)?;
            self.check_deadline()?;
            self.engine.step(towards)?;
            let to = self.engine.end_time();
            self.ahead.copy_from_slice(self.engine.end_state());
            let from = (self.front.t, &self.front_state[..]);
            if let Err(failure) = self.engine.field_mut().leads(from, (to, &self.ahead)) {
                return Err(self.failed(Reason::Rates { t: to }, Some(failure)));
            }
            self.engine.stand_at(time);
            self.restarted = false;
            self.direction.get_or_insert(1.0_f64.copysign(towards - self.front.t));
        }
        let to = self.engine.end_time();
        if self.events.events().is_empty() && self.held.len() == 0 {
            // Without events only the end of the step is needed, which is in `ahead`.
            if time == self.front.t {
                std::mem::swap(&mut self.output, &mut self.front_state);
            }
            std::mem::swap(&mut self.front_state, &mut self.ahead);
            self.front.t = to;
            return Ok(());
        }
        if time == self.front.t {
            self.output.copy_from_slice(&self.front_state);
        }
        let mut times = std::mem::take(&mut self.times);
        let separated = match self.look_at(to, &mut times) {
            Ok(separated) => separated,
            Err(error) => return Err(self.stay(error)),
        };
        let (mut blamed, own) = (0, self.events.events().len());
        let mut place = std::mem::take(&mut self.held.place);
        let (engine, events, held) = (&mut self.engine, &mut self.events, &self.held);
        let needs_no_states = own == 0 && held.need_no_states();
        let evaluate = |t: f64, values: &mut [f64]| {
            if needs_no_states {
                return write_functions(engine.field_mut(), held, t, &place, values)
                    .map_err(|failure| SearchFailure::Event(t, failure));
            }
            let state = if t == to {
                engine.end_state()
            } else {
                engine.interpolate(t, 0).map_err(SearchFailure::Method)?
            };
            let (values, of_surfaces) = values.split_at_mut(own);
            if of_surfaces.is_empty() {
                return values_at(events, t, state, values, &mut blamed)
                    .map_err(|failure| SearchFailure::Event(t, failure));
            }
            place.copy_from_slice(state);
            values_at(events, t, &place, values, &mut blamed)
                .and_then(|()| write_functions(engine.field_mut(), held, t, &place, of_surfaces))
                .map_err(|failure| SearchFailure::Event(t, failure))
        };
        let functions = self.front.values.len();
        let mut look = Look { evaluate, functions, separated, room: &mut self.room };
        let from = look.copy(&self.front);
        self.sides_after.clone_from(&self.sides);
        let found = self.sides_after.first(from, &times, &mut look);
        self.times = times;
        self.held.place = place;
        let passage = match found {
            Ok(passage) => passage,
            Err(SearchFailure::Method(error)) => return Err(self.stay(error)),
            Err(SearchFailure::Event(t, failure)) => return Err(self.event_error(blamed, t, failure)),
        };
        let (front, noise, due, beyond) = match passage {
            Passage::Clear(end) => (end, Vec::new(), Vec::new(), Vec::new()),
            Passage::Crossing(crossing) => (crossing.at, crossing.noise, crossing.events, crossing.beyond),
        };
        let state =
            if front.t == to { Ok(self.engine.end_state()) } else { self.engine.interpolate(front.t, 0) };
        match state {
            Ok(state) => self.front_state.copy_from_slice(state),
            Err(error) => return Err(self.stay(error)),
        }
        self.engine.stand_at(time);
        std::mem::swap(&mut self.sides_before, &mut self.sides);
        std::mem::swap(&mut self.sides, &mut self.sides_after);
        self.room.take_back(std::mem::replace(&mut self.front, front));
        (self.noise, self.due, self.beyond) = (noise, due, beyond);
        Ok(())
    }

    /// Writes the times at which the event functions are evaluated, the last being `to`, or an
    /// earlier time at which the search ends. Returns whether these times separate all roots.
    ///
    /// Where the functions are a program, the times separate their roots along the polynomial of
    /// the step; for closures, and where the functions read states through constraints or as
    /// momenta, the times divide the step into equal parts.
    fn look_at(&mut self, mut to: f64, times: &mut Vec<f64>) -> Result<bool, SolveError> {
        times.clear();
        let from = self.front.t;
        let direction = 1.0_f64.copysign(to - from);
        let dim = self.engine.field().dim();
        let surfaces = match self.engine.field_mut().switching() {
            Some(switching) if self.held.len() > 0 => {
                switching.program().map(|(program, parameters)| (Arc::clone(program), parameters.to_vec()))
            }
            _ => None,
        };
        let own = self.events.program().filter(|(program, _)| program.state_len() == dim);
        let own_separated = own
            .is_some_and(|(program, _)| program.outputs_len() == self.events.events().len())
            || self.events.events().is_empty();
        let needs_no_states = self.events.events().is_empty() && self.held.need_no_states();
        let mut separated = own_separated && (surfaces.is_some() || self.held.len() == 0);
        let of_surfaces = surfaces.as_ref().map(|(program, parameters)| (program, &parameters[..]));
        // Along these g is nothing but rounding.
        let sides = self.held.sides.iter().enumerate();
        let kept: Vec<usize> = sides.filter(|(_, side)| **side == 0.0).map(|(surface, _)| surface).collect();
        let programs =
            [(own, &mut self.separation, &[][..]), (of_surfaces, &mut self.held.separation, &kept[..])];
        for (program, separation, left_out) in programs {
            let Some((program, parameters)) = program else { continue };
            let separation = match separation {
                Some(known) if Arc::ptr_eq(known.program(), program) => known,
                other => other.insert(RootSeparation::new(Arc::clone(program))),
            };
            separation.leave_out(left_out.iter().copied());
            let before = times.len();
            let motion = match needs_no_states {
                true => PolynomialMotion { start: from, coefficients: &self.front_state },
                false => self.engine.polynomial(&mut self.coefficients)?,
            };
            let start = motion.start;
            separated &= separation.separate(motion, (from - start, to - start), parameters, times);
            let ends_before = times.last() != Some(&(to - start));
            times[before..].iter_mut().for_each(|time| *time += start);
            // Drop times that rounding puts at or beyond the ends.
            times.retain(|time| (time - from) * direction > 0.0 && (to - time) * direction > 0.0);
            if ends_before {
                to = times.pop().unwrap_or(to);
            }
        }
        // Projected states do not lie on the polynomial, nor does σ follow it.
        separated &=
            needs_no_states || !self.engine.field().has_projection() && !self.held.sides.contains(&0.0);
        if !separated {
            // What keeps a motion on a surface changes with time while the state may rest: steps are then long.
            let density = if kept.is_empty() { 1 } else { ALONG_SURFACES };
            let pieces = self.engine.limits().samples_per_step.saturating_mul(density);
            let length = to - from;
            times.extend((1..pieces).map(|k| from + length * (f64::from(k) / f64::from(pieces))));
        }
        // Functions may jump at a break, and return within the step.
        if let Some(at) = break_at(self.engine.field_mut().breaks(), from) {
            times.push(if direction > 0.0 { at.next_up() } else { at.next_down() });
        }
        times.sort_unstable_by(|a, b| ((a - b) * direction).total_cmp(&0.0));
        times.dedup();
        times.retain(|time| (to - time) * direction > 0.0);
        times.push(to);
        Ok(separated)
    }

    /// Returns whether the end is so close to a restart that no step is possible; if so, moves the
    /// integration to the end.
    fn arrives(&mut self, towards: f64) -> Result<bool, SolveError> {
        let target = self.engine.stop_time().unwrap_or(towards);
        let rounding = 4.0 * f64::EPSILON * target.abs().max(self.front.t.abs());
        if !self.restarted || (target - self.front.t).abs() > rounding {
            return Ok(false);
        }
        let time = self.time();
        let columns = self.engine.columns()?;
        self.engine.restart(target, &self.front_state, &columns, self.direction)?;
        self.engine.stand_at(if time == self.front.t { target } else { time });
        self.front.t = target;
        Ok(true)
    }

    /// The event functions at a state.
    pub(crate) fn evaluate(&mut self, t: f64, state: &[f64]) -> Result<Vec<f64>, SolveError> {
        let own = self.events.events().len();
        let (mut values, mut blamed) = (vec![f64::NAN; own + self.held.len()], 0);
        if let Err(failure) = values_at(&mut self.events, t, state, &mut values[..own], &mut blamed) {
            return Err(self.event_error(blamed, t, failure));
        }
        match write_functions(self.engine.field_mut(), &self.held, t, state, &mut values[own..]) {
            Ok(()) => Ok(values),
            Err(failure) => Err(self.failed(Reason::Rates { t }, Some(failure))),
        }
    }

    /// The error for an event function that failed.
    pub(crate) fn event_error(&mut self, event: usize, t: f64, failure: Failure) -> SolveError {
        let reason = Reason::Event { event: self.name(event), t };
        self.failed(reason, Some(failure))
    }

    pub(crate) fn name(&self, event: usize) -> String {
        let own = self.events.events();
        own.get(event).map_or_else(String::new, |event| event.name().to_owned())
    }

    /// The error for a failure beyond the front; the integration stays at the front.
    pub(crate) fn failed(&mut self, reason: Reason, failure: Option<Failure>) -> SolveError {
        let error = self.engine.failed(reason, failure);
        self.stay(error)
    }

    pub(crate) fn stay(&mut self, mut error: SolveError) -> SolveError {
        self.engine.stand_at(self.front.t);
        if let SolveError::Integration(error) = &mut error {
            error.time = self.front.t;
            error.state.clone_from(&self.front_state);
        }
        error
    }
}

/// Why the search for events in a step failed.
enum SearchFailure {
    Method(SolveError),
    Event(f64, Failure),
}

/// Writes the event functions at a state to `values`, which are initially NaN; `blamed` becomes the
/// first function whose value is not finite or was not written before a failure.
fn values_at(
    events: &mut impl Events,
    t: f64,
    state: &[f64],
    values: &mut [f64],
    blamed: &mut usize,
) -> Result<(), Failure> {
    if let Err(failure) = events.evaluate(t, state, values) {
        *blamed = values.iter().position(|value| !value.is_finite()).unwrap_or(0);
        return Err(failure);
    }
    match values.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(i) => {
            *blamed = i;
            let event = events.events()[i].name().to_owned();
            Err(Failure::recoverable(NonFinite::Event { event, value: values[i], t }))
        }
    }
}
