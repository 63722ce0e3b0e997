//! A motion that can be continued after an interruption.

use std::num::NonZeroU64;
use std::ops::ControlFlow;

use pc_expr::{Events, VectorField};

use crate::checkpoint::checkpoint::Checkpoint;
use crate::checkpoint::legs::follow;
use crate::integration::integration_method::IntegrationMethod;
use crate::settings::options::Options;
use crate::solve::failure::SolveFailure;
use crate::solve::solution::Solution;

/// A motion with checkpoints, to be integrated from one of them, or from its [start](Checkpoint::start).
///
/// It restarts at each checkpoint with the vector field and the events made by `parts`; in the legs
/// after a reset, a field that conserves an integral [keeps](VectorField::restart) the value of the
/// integral at the checkpoint. The part of a step before an event counts as a step; a checkpoint at
/// the end of this part follows all events there. So a motion resumed from any of its checkpoints
/// gives the same outputs, the same occurrences and the same ending, bit for bit, as a motion that
/// was never interrupted.
///
/// ```
/// use std::{num::NonZeroU64, ops::ControlFlow};
/// use pc_solve::{Checkpoint, Event, FnEvents, Resumable, from_fn};
///
/// // A bouncing ball.
/// let parts = || {
///     let fall = from_fn(2, |_t, y, ydot| { ydot[0] = y[1]; ydot[1] = -9.81; Ok(()) });
///     let bounce = FnEvents::new().with_reset(
///         Event::new("bounce").falling(), |_t, y| Ok(y[0]), |_t, y| { y[1] *= -0.8; Ok(()) });
///     (fall, bounce)
/// };
/// let (times, every) = ([1.0, 2.0, 3.0], NonZeroU64::new(7).unwrap());
/// let mut kept = Vec::new();
/// let start = Checkpoint::start(0.0, &[1.0, 0.0]);
/// let whole = Resumable::new(parts, start).every(every).run(&times,
///     |checkpoint, _| kept.push(checkpoint.clone()), |_, _| ControlFlow::Continue(()))?;
/// let later = kept.swap_remove(kept.len() / 2);
/// let part = Resumable::new(parts, later).every(every).run(&times, |_, _| (), |_, _| ControlFlow::Continue(()))?;
/// assert_eq!(part, whole);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
#[must_use]
pub struct Resumable<P, M = Options> {
    pub(crate) parts: P,
    pub(crate) from: Checkpoint,
    pub(crate) method: M,
    pub(crate) every: NonZeroU64,
}

impl<P> Resumable<P> {
    /// A motion from this checkpoint, with the default [`Options`] and a checkpoint [every 1000
    /// steps](Checkpoint::EVERY).
    pub fn new(parts: P, from: Checkpoint) -> Resumable<P> {
        Resumable { parts, from, method: Options::default(), every: Checkpoint::EVERY }
    }
}

impl<P, M> Resumable<P, M> {
    /// Sets the method; with [`Options`], one of the built-in methods.
    pub fn method<N>(self, method: N) -> Resumable<P, N> {
        let Resumable { parts, from, every, .. } = self;
        Resumable { parts, from, method, every }
    }

    /// Sets the number of steps from one checkpoint to the next.
    pub fn every(self, every: NonZeroU64) -> Resumable<P, M> {
        Resumable { every, ..self }
    }

    /// Returns the states at `times`, which begin with the output times of the checkpoint, and the
    /// occurrences of events.
    ///
    /// Each checkpoint, including the first, is passed to `save`, and the last one again with
    /// `true` if the motion fails or is stopped by `step`, which is called with the end of each
    /// step. The outputs beyond that checkpoint are returned, but the motion resumes from the
    /// checkpoint.
    ///
    /// # Errors
    /// As for [`Solve::run`](crate::Solve::run), and [`InputError::EventCount`](crate::InputError::EventCount);
    /// [`InputError::Sensitivities`](crate::InputError::Sensitivities) if the checkpoint has sensitivities.
    pub fn run<F: VectorField, E: Events>(
        self,
        times: &[f64],
        save: impl FnMut(&Checkpoint, bool),
        step: impl FnMut(f64, &[f64]) -> ControlFlow<()>,
    ) -> Result<Solution, Box<SolveFailure<Solution>>>
    where
        P: FnMut() -> (F, E),
        M: IntegrationMethod<F>,
    {
        let Resumable { parts, from, method, every } = self;
        match follow(&method, parts, from, (times, every), save, step) {
            Ok((solution, _)) => Ok(solution),
            Err(failure) => Err(Box::new(failure.map(|(solution, _)| solution))),
        }
    }
}
