//! Observers of a motion during its integration.

use std::ops::ControlFlow;

use crate::events::events::Occurrence;
use crate::integration::statistics::Statistics;

/// An observer of a motion during its integration, which it may stop.
///
/// [`Observed`] makes an observer from closures.
pub trait Observer {
    /// An output.
    fn output(&mut self, t: f64, y: &[f64]) -> ControlFlow<()>;

    /// An event that occurred. All simultaneous events are reported, even if the observer stops the
    /// motion at one of them.
    fn occurred(&mut self, _occurrence: &Occurrence) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    /// The end (t, y⁻) of a step, or of the part of a step before an event; called before the
    /// outputs inside the step, to show progress or to stop.
    fn step(&mut self, _t: f64, _y: &[f64]) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    /// Whether it receives the ends of steps with the [work so far](Observer::measured) too, which takes time to collect.
    fn measures(&self) -> bool {
        false
    }

    /// The same end of a step with the work so far, which includes the order and the length of the step.
    fn measured(&mut self, _t: f64, _y: &[f64], _work: &Statistics) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

/// An [`Observer`] made from closures for outputs, events and steps.
///
/// ```
/// use std::ops::ControlFlow::Continue;
/// use pc_solve::{Integration, Observed, Options, from_fn};
///
/// let fall = from_fn(1, |_t, _y, ydot| { ydot[0] = -9.81; Ok(()) });
/// let (mut outputs, mut steps) = (0, 0);
/// let count = Observed::new(|_, _| { outputs += 1; Continue(()) })
///     .steps(|_, _| { steps += 1; Continue(()) });
/// Integration::new(fall, 0.0, &[1.0], &Options::default())?.run_observed(&[0.5, 1.0], count)?;
/// assert!(outputs == 2 && steps > 1);
/// # Ok::<(), pc_solve::SolveError>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Observed<O, C, S> {
    output: O,
    occurred: C,
    step: S,
}

type Occurred = fn(&Occurrence) -> ControlFlow<()>;
type Step = fn(f64, &[f64]) -> ControlFlow<()>;

impl<O: FnMut(f64, &[f64]) -> ControlFlow<()>> Observed<O, Occurred, Step> {
    /// An observer whose closure receives the outputs.
    pub fn new(output: O) -> Self {
        Observed { output, occurred: |_| ControlFlow::Continue(()), step: |_, _| ControlFlow::Continue(()) }
    }
}

impl<O, C, S> Observed<O, C, S> {
    /// Adds a closure that receives the events.
    pub fn occurrences<T: FnMut(&Occurrence) -> ControlFlow<()>>(self, occurred: T) -> Observed<O, T, S> {
        Observed { output: self.output, occurred, step: self.step }
    }

    /// Adds a closure that receives the ends of steps.
    pub fn steps<T: FnMut(f64, &[f64]) -> ControlFlow<()>>(self, step: T) -> Observed<O, C, T> {
        Observed { output: self.output, occurred: self.occurred, step }
    }
}

impl<O, C, S> Observer for Observed<O, C, S>
where
    O: FnMut(f64, &[f64]) -> ControlFlow<()>,
    C: FnMut(&Occurrence) -> ControlFlow<()>,
    S: FnMut(f64, &[f64]) -> ControlFlow<()>,
{
    fn output(&mut self, t: f64, y: &[f64]) -> ControlFlow<()> {
        (self.output)(t, y)
    }

    fn occurred(&mut self, occurrence: &Occurrence) -> ControlFlow<()> {
        (self.occurred)(occurrence)
    }

    fn step(&mut self, t: f64, y: &[f64]) -> ControlFlow<()> {
        (self.step)(t, y)
    }
}
