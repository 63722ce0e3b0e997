//! Integration of a motion in legs, from checkpoint to checkpoint.

use std::cell::{Cell, RefCell};
use std::num::NonZeroU64;
use std::ops::ControlFlow;

use pc_expr::{Events, VectorField};

use crate::checkpoint::checkpoint::Checkpoint;
use crate::error::{InputError, IntegrationError, Reason, SolveError};
use crate::events::events::Occurrence;
use crate::integration::checks::finite;
use crate::integration::integration::{Ending, Integration};
use crate::integration::integration_method::IntegrationMethod;
use crate::integration::observer::Observed;
use crate::integration::stepper::Stepper;
use crate::solve::failure::SolveFailure;
use crate::solve::solution::Solution;

/// A motion, and its sensitivities at the outputs, one matrix after another.
pub(crate) type Reached = (Solution, Vec<f64>);

/// Integrates a motion in legs, with a method that may have sensitivities.
pub(crate) fn follow<F: VectorField, E: Events>(
    method: &impl IntegrationMethod<F>,
    mut parts: impl FnMut() -> (F, E),
    from: Checkpoint,
    (times, every): (&[f64], NonZeroU64),
    mut save: impl FnMut(&Checkpoint, bool),
    mut step: impl FnMut(f64, &[f64]) -> ControlFlow<()>,
) -> Result<Reached, Box<SolveFailure<Reached>>> {
    let mut begin = |stand: &Checkpoint| {
        let (field, events) = parts();
        let mut stepper = method.begin(field, stand.time, &stand.state, times.last().copied())?;
        take_up(&mut stepper, stand)?;
        // Steps to the next output are counted here, across legs.
        let limit = std::mem::replace(&mut stepper.limits_mut().max_steps, u64::MAX);
        let integration = Integration::resumed(stepper, stand).with_events_of(events, stand)?;
        Ok::<_, SolveError>((integration, Plan { times, every: every.get(), limit }))
    };
    let mut stand = from;
    loop {
        save(&stand, false);
        if !stand.outputs.is_empty() && stand.outputs.len() >= times.len() {
            return Ok(motion(stand, Some(Ending::Completed)));
        }
        let (mut integration, plan) = match begin(&stand) {
            Ok(begun) => begun,
            Err(error) => {
                return Err(Box::new(SolveFailure { reached: motion(stand, None), error }));
            }
        };
        let (work, outputs, occurrences) = (stand.statistics, stand.outputs.len(), stand.occurrences.len());
        let result = plan.leg(&mut integration, &mut stand, &mut step);
        stand.statistics = work.followed_by(&integration.statistics());
        let Some(ending) = result.transpose() else {
            let Checkpoint { time, state, jumped, sensitivities, past, .. } = integration.checkpoint();
            stand = Checkpoint { time, state, jumped, sensitivities, past, ..stand };
            continue;
        };
        let arrived = ending.as_ref().ok().copied();
        if matches!(arrived, Some(Ending::Stopped) | None) {
            let entries = outputs * stand.sensitivities.len();
            let at_outputs = &stand.output_sensitivities;
            let kept = Checkpoint {
                outputs: stand.outputs.first(outputs),
                occurrences: stand.occurrences[..occurrences].to_vec(),
                statistics: work,
                output_sensitivities: at_outputs[..entries.min(at_outputs.len())].to_vec(),
                ..stand.clone()
            };
            save(&kept, true);
        }
        let reached = motion(stand, arrived);
        return match ending {
            Ok(_) => Ok(reached),
            Err(error) => Err(Box::new(SolveFailure { reached, error })),
        };
    }
}

/// Passes the sensitivities at a checkpoint to a method that has begun there; at the start of a
/// motion the method keeps its own.
///
/// # Errors
/// [`InputError::Sensitivities`] if the method has a different number of columns.
fn take_up<S: Stepper>(stepper: &mut S, stand: &Checkpoint) -> Result<(), SolveError> {
    let (expected, dim) = (stepper.column_parameters().len(), stand.state.len());
    if stand.past.is_none() && stand.sensitivities.is_empty() {
        return Ok(());
    }
    if stand.sensitivities.len() != expected * dim {
        return Err(
            InputError::Sensitivities { expected, found: stand.sensitivities.len() / dim.max(1) }.into()
        );
    }
    if expected == 0 {
        return Ok(());
    }
    for &value in &stand.sensitivities {
        finite("a sensitivity of the checkpoint", value)?;
    }
    stepper.restart(stand.time, &stand.state, &stand.sensitivities, None)
}

/// The motion up to a checkpoint, given how it ended.
fn motion(stand: Checkpoint, ending: Option<Ending>) -> Reached {
    let Checkpoint { outputs: mut trajectory, occurrences, statistics, output_sensitivities, .. } = stand;
    trajectory.finish(ending == Some(Ending::Completed), statistics);
    (Solution { trajectory, occurrences, ending, slides: Vec::new() }, output_sensitivities)
}

/// The settings that all legs share.
struct Plan<'a> {
    times: &'a [f64],
    /// The number of steps in a leg.
    every: u64,
    /// The maximum number of steps from one output to the next.
    limit: u64,
}

/// Why a leg ends.
#[derive(Clone, Copy, PartialEq)]
enum End {
    Full,
    Stopped,
    Exhausted,
}

impl Plan<'_> {
    /// Integrates one leg, and adds its outputs and occurrences to `stand`, the checkpoint at which
    /// it began; returns how the motion ends, if it ends in this leg.
    ///
    /// A leg has `every` steps, or more if that many have not advanced the time.
    fn leg<S: Stepper, E: Events>(
        &self,
        integration: &mut Integration<S, E>,
        stand: &mut Checkpoint,
        step: &mut impl FnMut(f64, &[f64]) -> ControlFlow<()>,
    ) -> Result<Option<Ending>, SolveError> {
        let (start, remaining) = (stand.time, &self.times[stand.outputs.len()..]);
        let since = Cell::new(stand.steps_since_output);
        let outputs = RefCell::new(&mut stand.outputs);
        let output = |t: f64, y: &[f64]| {
            outputs.borrow_mut().push(t, y);
            since.set(0);
            ControlFlow::Continue(())
        };
        let matrices = &mut stand.output_sensitivities;
        let occurrences = &mut stand.occurrences;
        let mut occurred = |occurrence: &Occurrence| {
            occurrences.push(occurrence.clone());
            ControlFlow::Continue(())
        };
        let (mut steps, mut end) = (0, None);
        let observed = |t: f64, y: &[f64]| {
            steps += 1;
            since.set(since.get() + 1);
            if step(t, y).is_break() {
                end = Some(End::Stopped);
            } else if since.get() > self.limit {
                end = Some(End::Exhausted);
            } else if steps >= self.every && t != start {
                end = Some(End::Full);
            }
            if end.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let mut observer = Observed::new(output).occurrences(&mut occurred).steps(observed);
        let ending = integration.run_through(remaining, &mut observer, &mut |integration| {
            matrices.extend(integration.engine.columns()?);
            Ok(())
        })?;
        match end {
            Some(End::Full) => {}
            Some(End::Exhausted) => {
                let next = self.times[outputs.borrow().len()];
                return Err(too_much_work(integration, self.limit, next));
            }
            Some(End::Stopped) | None => return Ok(Some(ending)),
        }
        let next = || self.times.get(outputs.borrow().len()).copied();
        let here = integration.time();
        while let Some(t) = next().filter(|&t| integration.is_before_front(t)) {
            integration.stand_at(t)?;
            matrices.extend(integration.engine.columns()?);
            let _ = output(t, integration.state());
        }
        if next().is_none() {
            return Ok(Some(Ending::Completed)); // nothing is needed beyond the last output
        }
        let ending = integration.settle(&mut occurred)?;
        if ending.is_some() || next() == Some(here) {
            matrices.extend(integration.engine.columns()?);
            let _ = output(here, integration.state());
        }
        stand.steps_since_output = since.get();
        Ok(ending)
    }
}

/// The error for too many steps before the output at `t`.
fn too_much_work<S: Stepper, E: Events>(integration: &Integration<S, E>, steps: u64, t: f64) -> SolveError {
    let reason = Reason::Steps { steps, t, last: integration.statistics().last_step.abs() };
    let (time, state) = (integration.time(), integration.state().to_vec());
    SolveError::Integration(Box::new(IntegrationError { reason, time, state, failure: None }))
}
