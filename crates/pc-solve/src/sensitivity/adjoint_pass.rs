//! The forward integration of the motion, and the backward integration of the adjoint equations.

use std::cell::RefCell;
use std::ops::ControlFlow;
use std::rc::Rc;

use pc_expr::{Event, Events, Failure, VectorField};

use crate::cvode::cvode::Cvode;
use crate::cvode::forward::sensitivities::check_passages;
use crate::error::{InputError, IntegrationError, Reason, SolveError};
use crate::integration::held_sides::Passage;
use crate::integration::integration::{Ending, Integration};
use crate::integration::observer::Observed;
use crate::integration::saltation::transposed_passage;
use crate::integration::statistics::Statistics;
use crate::integration::stepper::Stepper;
use crate::sensitivity::adjoint_field::{AdjointField, Path, not_finite};
use crate::sensitivity::adjoint_options::AdjointOptions;
use crate::sensitivity::functional::{Functional, Gradient};
use crate::settings::options::Options;

/// The start of a piece of the motion.
struct Mark {
    t: f64,
    y: Vec<f64>,
    jump: Option<Jump>,
    /// The sides of its surfaces on which the field is held from there on.
    sides: Vec<f64>,
}

/// What makes λ jump.
enum Jump {
    /// A reset: the event, and the state before the event.
    Reset(usize, Vec<f64>),
    /// Surfaces on which f jumps: the surfaces, and the sides before the jump.
    Surfaces(Vec<usize>, Vec<f64>),
}

impl Mark {
    fn new(t: f64, y: &[f64], jump: Option<Jump>) -> Mark {
        Mark { t, y: y.to_vec(), jump, sides: Vec::new() }
    }

    fn is_reset(&self) -> bool {
        matches!(self.jump, Some(Jump::Reset(..)))
    }
}

/// The gradients of functionals of the motion from y(t0) = y0 to t1.
pub(crate) fn gradients<F: VectorField, E: Events, G: Functional>(
    field: F,
    mut events: E,
    functionals: Vec<G>,
    (t0, y0): (f64, &[f64]),
    t1: f64,
    options: &AdjointOptions,
) -> Result<Vec<Gradient>, SolveError> {
    let mut motion = options.motion.clone();
    motion.stop_time = motion.stop_time.or(Some(t1).filter(|t| t.is_finite()));
    let mut path = Path::new(field, &motion);
    let resets = events.events().iter().any(Event::resets);
    let by_parameters = path.field.has_parameter_jacobian() && path.field.parameters_len() > 0;
    check_passages(&path.field, None)?;
    if by_parameters {
        (0..path.field.parameters_len()).try_for_each(|j| check_passages(&path.field, Some(j)))?;
    }
    if resets && by_parameters && !events.has_parameter_derivatives() {
        return Err(InputError::EventParameters.into());
    }
    let there = there(&mut path.field, &mut events, (t0, y0), t1, &motion, options.checkpoint_interval)?;
    let back = options.back(path.has_products_only());
    let path = Rc::new(RefCell::new(path));
    let mut ways = Vec::with_capacity(functionals.len());
    for functional in functionals {
        let adjoint = AdjointField::new(Rc::clone(&path), functional);
        ways.push(Way::new(adjoint, (t1, &there.end), back.clone(), options)?);
    }
    let mut to = t1;
    for (i, mark) in there.marks.iter().enumerate().rev() {
        if mark.t != to {
            let mut path = path.borrow_mut();
            if there.has_jumps {
                // Restore the data kept by the field since the last reset.
                let since = there.marks[..=i].iter().rev().find(|mark| mark.is_reset());
                let since = since.unwrap_or(&there.marks[0]);
                path.field.restart(since.t, &since.y);
            }
            path.record(mark.t, &mark.y, to, &mark.sides, &motion)?;
            drop(path);
            for way in &mut ways {
                way.advance_to(mark.t)?;
            }
        }
        for way in &mut ways {
            match &mark.jump {
                Some(Jump::Reset(event, before)) => {
                    let before_it = i.checked_sub(1).map_or(&[][..], |i| &there.marks[i].sides);
                    let there = (mark.t, &before[..], &mark.y[..]);
                    way.jump(&path, &mut events, *event, there, (before_it, &mark.sides), &motion)?;
                }
                Some(Jump::Surfaces(due, before)) => {
                    way.pass(&path, due, (mark.t, &mark.y), (before, &mark.sides))?;
                }
                None => {}
            }
        }
        to = mark.t;
    }
    if let Some(field) = path.borrow_mut().field.switching() {
        field.hold(None);
    }
    ways.into_iter().map(|way| way.arrive((t0, y0), there.statistics)).collect()
}

/// The parts of the forward motion that are recorded.
struct There {
    marks: Vec<Mark>,
    has_jumps: bool,
    end: Vec<f64>,
    statistics: Statistics,
}

/// Integrates the motion to `t1`; records the start, every `interval`th step, and the states after
/// resets.
fn there<F: VectorField, E: Events>(
    field: &mut F,
    events: &mut E,
    (t0, y0): (f64, &[f64]),
    t1: f64,
    options: &Options,
    interval: u32,
) -> Result<There, SolveError> {
    let names: Vec<String> = events.events().iter().map(|event| event.name().to_owned()).collect();
    let resetting: Vec<bool> = events.events().iter().map(Event::resets).collect();
    let mut motion = Integration::new(field, t0, y0, options)?.with_events(events)?;
    motion.held.passages = Some(Vec::new());
    let marks = RefCell::new(vec![Mark::new(t0, y0, None)]);
    let mut together = None;
    let steps = RefCell::new(0);
    let direction = 1.0_f64.copysign(t1 - t0);
    let keep = |t: f64, y: &[f64]| {
        *steps.borrow_mut() += 1;
        if *steps.borrow() == interval && (t1 - t) * direction > 0.0 {
            *steps.borrow_mut() = 0;
            marks.borrow_mut().push(Mark::new(t, y, None));
        }
        ControlFlow::Continue(())
    };
    let occurred = |occurrence: &crate::events::events::Occurrence| {
        if !resetting[occurrence.event] {
            return ControlFlow::Continue(());
        }
        let mut marks = marks.borrow_mut();
        let last = marks.last().filter(|mark| mark.t == occurrence.time && occurrence.time != t0);
        let event = |mark: &Mark| match mark.jump {
            Some(Jump::Reset(event, _)) => Some(event),
            _ => None,
        };
        match last.map(event) {
            Some(Some(other)) => {
                together = Some((other, occurrence.clone()));
                return ControlFlow::Break(());
            }
            Some(None) => drop(marks.pop()), // the mark at y⁻ is replaced by that at y⁺
            None => {}
        }
        let jump = Jump::Reset(occurrence.event, occurrence.state_before.clone());
        marks.push(Mark::new(occurrence.time, &occurrence.state_after, Some(jump)));
        *steps.borrow_mut() = 0;
        ControlFlow::Continue(())
    };
    let ending = motion.run_observed(
        &[t1],
        Observed::new(|_, _: &[f64]| ControlFlow::Continue(())).occurrences(occurred).steps(keep),
    )?;
    let fail = |reason: Reason, time: f64, state: Vec<f64>| {
        Err(SolveError::Integration(Box::new(IntegrationError { reason, time, state, failure: None })))
    };
    if let Some((other, occurrence)) = together {
        let events = [other, occurrence.event].map(|event| names[event].clone()).to_vec();
        let reason = Reason::Together { events, t: occurrence.time };
        return fail(reason, occurrence.time, occurrence.state_before);
    }
    if let Ending::Event { event } = ending
        && motion.time() != t1
    {
        let (t, state) = (motion.time(), motion.state().to_vec());
        return fail(Reason::EndsEarly { event: names[event].clone(), t }, t, state);
    }
    let (end, statistics) = (motion.state().to_vec(), motion.statistics());
    let mut marks = marks.into_inner();
    with_passages(&mut marks, motion.held.passages.take().unwrap_or_default(), direction);
    let has_jumps = marks.iter().any(Mark::is_reset);
    Ok(There { marks, has_jumps, end, statistics })
}

/// Adds marks where surfaces are crossed, and sets the sides from each mark on.
fn with_passages(marks: &mut Vec<Mark>, passages: Vec<Passage>, direction: f64) {
    for Passage { surfaces, time, state, before, after } in passages {
        let place = marks.partition_point(|mark| (mark.t - time) * direction < 0.0);
        if surfaces.is_empty() {
            marks[place..].iter_mut().for_each(|mark| mark.sides.clone_from(&after));
            continue;
        }
        let mark = Mark::new(time, &state, Some(Jump::Surfaces(surfaces, before)));
        match marks.get_mut(place) {
            Some(known) if known.t == time && known.jump.is_none() && place > 0 => *known = mark,
            _ => marks.insert(place, mark),
        }
        marks[place..].iter_mut().for_each(|mark| mark.sides.clone_from(&after));
    }
}

/// The adjoint equations of one functional, and λ.
type Paused<F, G> = (AdjointField<F, G>, Vec<f64>);

/// The backward integration for one functional.
struct Way<F, G> {
    back: Option<Integration<Cvode<AdjointField<F, G>>>>,
    options: Options,
    tolerances: (f64, f64),
    /// The end term h plus the integrals beyond the last jump.
    value: f64,
    by_parameters: Vec<f64>,
}

impl<F: VectorField, G: Functional> Way<F, G> {
    /// Begins at y(t1) = y1.
    fn new(
        mut adjoint: AdjointField<F, G>,
        (t1, y1): (f64, &[f64]),
        options: Options,
        of: &AdjointOptions,
    ) -> Result<Self, SolveError> {
        let (value, by_state, by_parameters) = adjoint.end(t1, y1).map_err(|failure| {
            let (reason, failure) = (Reason::Functional, Some(failure));
            let state = y1.to_vec();
            SolveError::Integration(Box::new(IntegrationError { reason, time: t1, state, failure }))
        })?;
        let tolerances = (of.relative_tolerance, of.absolute_tolerance);
        let mut way = Way { back: None, options, tolerances, value, by_parameters };
        way.begin(adjoint, t1, &by_state)?;
        Ok(way)
    }

    fn begin(&mut self, adjoint: AdjointField<F, G>, t: f64, start: &[f64]) -> Result<(), SolveError> {
        let mut back = Integration::new(adjoint, t, start, &self.options)?;
        back.engine.begin_quadratures(self.tolerances.0, self.tolerances.1)?;
        self.back = Some(back);
        Ok(())
    }

    /// Integrates back to `t` along the recorded motion.
    fn advance_to(&mut self, t: f64) -> Result<(), SolveError> {
        let Some(back) = &mut self.back else { return Ok(()) };
        back.set_stop_time(Some(t))?;
        let result = back.state_at(t).map(|_| ());
        result.map_err(|error| of_motion(error, back.engine.field_mut()))
    }

    /// Adds up the integrals, and returns the equations and λ.
    fn pause(&mut self, t: f64, y: &[f64]) -> Result<Option<Paused<F, G>>, SolveError> {
        let Some(back) = self.back.take() else { return Ok(None) };
        let mut integrals = back.engine.quadratures()?;
        if let Some(j) = not_finite(&integrals) {
            let component = format!("integral number {j} (from 0) of the gradient");
            let overflow = Reason::Overflow { component, value: integrals[j], t };
            return Err(stopped(Reason::Adjoint(Box::new(overflow)), (t, y), None));
        }
        self.value += integrals.pop().unwrap_or(0.0);
        for (sum, integral) in self.by_parameters.iter_mut().zip(integrals) {
            *sum += integral;
        }
        let state = back.state().to_vec();
        Ok(Some((back.into_field(), state)))
    }

    /// Changes λ⁺ to λ⁻ at an event that changes the state from `before` to `after`.
    fn jump<E: Events>(
        &mut self,
        path: &RefCell<Path<F>>,
        events: &mut E,
        event: usize,
        (t, before, after): (f64, &[f64], &[f64]),
        sides: (&[f64], &[f64]),
        options: &Options,
    ) -> Result<(), SolveError> {
        let Some((mut adjoint, lambda)) = self.pause(t, after)? else { return Ok(()) };
        let refuse = |failure: Failure| stopped(Reason::Saltation { t }, (t, before), Some(failure));
        let step = adjoint.density(t, before).map_err(refuse)? - adjoint.density(t, after).map_err(refuse)?;
        let parameters = self.by_parameters.len();
        let jumped = {
            let field = &mut path.borrow_mut().field;
            // No step is made.
            let options = Options { stop_time: None, ..options.clone() };
            let mut there = Integration::new(field, t, after, &options)?.with_events(events)?;
            there.transposed_jump(event, (t, before, after), sides, (&lambda, step), parameters)?
        };
        for (sum, by_parameter) in self.by_parameters.iter_mut().zip(jumped.1) {
            *sum += by_parameter;
        }
        self.begin(adjoint, t, &jumped.0)
    }

    /// Changes λ⁺ to λ⁻ where f jumps on surfaces g = 0,
    /// ```text
    /// λ⁻ = λ⁺ − κ g_y,    −κ g_p for ∂G/∂p,    κ = λ⁺·(f⁻ − f⁺)/(g_t + g_y f⁻)
    /// ```
    fn pass(
        &mut self,
        path: &RefCell<Path<F>>,
        due: &[usize],
        (t, y): (f64, &[f64]),
        (before, after): (&[f64], &[f64]),
    ) -> Result<(), SolveError> {
        let Some((adjoint, lambda)) = self.pause(t, y)? else { return Ok(()) };
        let parameters = self.by_parameters.len();
        let jumped = {
            let field = &mut path.borrow_mut().field;
            transposed_passage(field, due, (t, y), (before, after), (&lambda, parameters))?
        };
        for (sum, by_parameter) in self.by_parameters.iter_mut().zip(jumped.1) {
            *sum += by_parameter;
        }
        self.begin(adjoint, t, &jumped.0)
    }

    /// The gradient, after the integration back to the start.
    fn arrive(mut self, (t0, y0): (f64, &[f64]), statistics: Statistics) -> Result<Gradient, SolveError> {
        let by_start = self.pause(t0, y0)?.map_or_else(Vec::new, |(_, lambda)| lambda);
        Ok(Gradient { value: self.value, by_start, by_parameters: self.by_parameters, statistics })
    }
}

fn stopped(reason: Reason, (time, state): (f64, &[f64]), failure: Option<Failure>) -> SolveError {
    SolveError::Integration(Box::new(IntegrationError { reason, time, state: state.to_vec(), failure }))
}

/// An error in the adjoint equations, with the state of the motion where their integration stopped.
fn of_motion<F: VectorField, G: Functional>(
    error: SolveError,
    adjoint: &mut AdjointField<F, G>,
) -> SolveError {
    match error {
        SolveError::Integration(error) => {
            let IntegrationError { reason, time, failure, .. } = *error;
            let (reason, state) = (Reason::Adjoint(Box::new(reason)), adjoint.motion(time).to_vec());
            SolveError::Integration(Box::new(IntegrationError { reason, time, state, failure }))
        }
        other => other,
    }
}
