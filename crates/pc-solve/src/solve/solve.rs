//! Integration in one call.

use std::ops::ControlFlow;

use pc_expr::{Events, VectorField};

use crate::error::SolveError;
use crate::events::events::{NoEvents, Occurrence};
use crate::integration::dense_output::DenseOutput;
use crate::integration::integration::{Ending, Integration};
use crate::integration::integration_method::IntegrationMethod;
use crate::integration::observer::Observed;
use crate::integration::trajectory::Trajectory;
use crate::settings::options::Options;
use crate::solve::failure::SolveFailure;
use crate::solve::solution::Solution;

/// Integrates ẏ = f(t, y) from y(t0) = y0 with the method of the options and returns the states at
/// `times`; [`Solve`] offers more choices.
///
/// `y0` has one number for each component. The times are monotonic, forwards or backwards; the
/// first may be t0. The vector field is not evaluated beyond the last time, nor beyond the stop
/// time of the options.
///
/// # Errors
/// [`SolveFailure`] with the outputs reached before the failure, of which there are none if the
/// input is invalid.
pub fn solve<F: VectorField>(
    field: F,
    t0: f64,
    y0: &[f64],
    times: &[f64],
    options: &Options,
) -> Result<Trajectory, Box<SolveFailure>> {
    match Solve::new(field, t0, y0).method(options).run(times) {
        Ok(solution) => Ok(solution.trajectory),
        Err(failure) => Err(Box::new(failure.map(|reached| reached.trajectory))),
    }
}

/// A motion to be integrated: ẏ = f(t, y) from y(t0) = y0, with a method and events.
///
/// ```
/// use pc_solve::{Event, FnEvents, Options, Solve, from_fn};
///
/// // A ball is dropped and bounces.
/// let ball = from_fn(2, |_t, y, ydot| { ydot[0] = y[1]; ydot[1] = -9.81; Ok(()) });
/// let bounce = FnEvents::new().with_reset(
///     Event::new("bounce").falling(), |_t, y| Ok(y[0]), |_t, y| { y[1] *= -0.5; Ok(()) });
/// let solution = Solve::new(ball, 0.0, &[1.0, 0.0])
///     .method(Options::default().relative_tolerance(1e-11))
///     .events(bounce)
///     .run(&[0.25, 0.5, 0.75])?;
/// assert_eq!((solution.trajectory.len(), solution.occurrences.len()), (3, 1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
#[must_use]
pub struct Solve<'a, F, M = Options, E = NoEvents> {
    pub(crate) field: F,
    pub(crate) t0: f64,
    pub(crate) y0: &'a [f64],
    pub(crate) method: M,
    pub(crate) events: E,
}

impl<'a, F: VectorField> Solve<'a, F> {
    /// An integration with the default [`Options`], without events.
    pub fn new(field: F, t0: f64, y0: &'a [f64]) -> Self {
        Solve { field, t0, y0, method: Options::default(), events: NoEvents }
    }
}

impl<'a, F: VectorField, M, E> Solve<'a, F, M, E> {
    /// Sets the method; with [`Options`], one of the built-in methods.
    pub fn method<N: IntegrationMethod<F>>(self, method: N) -> Solve<'a, F, N, E> {
        let Solve { field, t0, y0, events, .. } = self;
        Solve { field, t0, y0, method, events }
    }

    /// Adds these events to the motion.
    pub fn events<D: Events>(self, events: D) -> Solve<'a, F, M, D> {
        let Solve { field, t0, y0, method, .. } = self;
        Solve { field, t0, y0, method, events }
    }
}

impl<F: VectorField, M: IntegrationMethod<F>, E: Events> Solve<'_, F, M, E> {
    /// Begins the integration and returns it at its start, to be advanced step by step.
    ///
    /// # Errors
    /// As for [`IntegrationMethod::begin`] and [`Integration::with_events`].
    pub fn start(self) -> Result<Integration<M::Stepper, E>, SolveError> {
        self.start_towards(None)
    }

    fn start_towards(self, end: Option<f64>) -> Result<Integration<M::Stepper, E>, SolveError> {
        let Solve { field, t0, y0, method, events } = self;
        Integration::of(method.begin(field, t0, y0, end)?).with_events(events)
    }

    /// The states at `times`, and the occurrences of events.
    ///
    /// The times are monotonic, forwards or backwards; the first may be t0. The vector field is not
    /// evaluated beyond the last time, nor beyond the stop time of the method.
    ///
    /// # Errors
    /// [`SolveFailure`] with what was reached before the failure, which is nothing if the input is
    /// invalid.
    pub fn run(self, times: &[f64]) -> Result<Solution, Box<SolveFailure<Solution>>> {
        self.run_observed(times, |_, _| ControlFlow::Continue(()))
    }

    /// Like [`run`](Solve::run), but passes the end (t, y⁻) of each step, or of the part of a step
    /// before an event, to `step`, to show progress or to stop.
    ///
    /// If the integration is stopped, the solution has the outputs before that step and is not
    /// [complete](Trajectory::is_complete).
    ///
    /// # Errors
    /// As for [`run`](Solve::run).
    pub fn run_observed(
        self,
        times: &[f64],
        step: impl FnMut(f64, &[f64]) -> ControlFlow<()>,
    ) -> Result<Solution, Box<SolveFailure<Solution>>> {
        let mut trajectory = Trajectory::new(self.field.dim());
        let output = |t: f64, y: &[f64]| {
            trajectory.push(t, y);
            ControlFlow::Continue(())
        };
        let result = self.run_given(times, output, step);
        let mut with = |solution: Solution| {
            let complete = solution.ending == Some(Ending::Completed);
            trajectory.finish(complete, *solution.trajectory.statistics());
            Solution { trajectory: std::mem::replace(&mut trajectory, Trajectory::new(0)), ..solution }
        };
        match result {
            Ok(solution) => Ok(with(solution)),
            Err(failure) => Err(Box::new(failure.map(with))),
        }
    }

    /// Like [`run_observed`](Solve::run_observed), but returns the motion as far as it can be
    /// computed, and the error that stopped it, if there was one.
    pub fn follow(
        self,
        times: &[f64],
        step: impl FnMut(f64, &[f64]) -> ControlFlow<()>,
    ) -> (Solution, Option<SolveError>) {
        SolveFailure::split(self.run_observed(times, step))
    }

    /// Like [`run_observed`](Solve::run_observed), but passes each (t, y) to `output`, which may
    /// stop the integration, instead of keeping the states: the trajectory of the solution contains
    /// only the statistics.
    ///
    /// # Errors
    /// As for [`run`](Solve::run).
    pub fn run_given(
        self,
        times: &[f64],
        output: impl FnMut(f64, &[f64]) -> ControlFlow<()>,
        step: impl FnMut(f64, &[f64]) -> ControlFlow<()>,
    ) -> Result<Solution, Box<SolveFailure<Solution>>> {
        let mut solution = Solution::new(self.field.dim());
        let mut integration = match self.start_towards(times.last().copied()) {
            Ok(integration) => integration,
            Err(error) => return Err(Box::new(SolveFailure { reached: solution, error })),
        };
        let occurrences = &mut solution.occurrences;
        let occurred = |occurrence: &Occurrence| {
            occurrences.push(occurrence.clone());
            ControlFlow::Continue(())
        };
        let result = integration.run_observed(times, Observed::new(output).occurrences(occurred).steps(step));
        solution.trajectory.finish(matches!(result, Ok(Ending::Completed)), integration.statistics());
        solution.slides = integration.slides().to_vec();
        integration.release();
        match result {
            Ok(ending) => Ok(Solution { ending: Some(ending), ..solution }),
            Err(error) => Err(Box::new(SolveFailure { reached: solution, error })),
        }
    }

    /// The motion to `end`, or to an earlier terminal event, as a function of time.
    ///
    /// # Errors
    /// As for [`Integration::run_dense`], which also keeps what was reached before a failure.
    pub fn dense(self, end: f64) -> Result<DenseOutput, SolveError> {
        let mut motion = DenseOutput::default();
        let keep = |segment| {
            motion.extend([segment]);
            ControlFlow::Continue(())
        };
        let mut integration = self.start_towards(Some(end))?;
        let result = integration.run_dense(end, keep, |_| ControlFlow::Continue(()));
        integration.release();
        result.map(|_| motion)
    }
}
