//! A motion and its derivatives in one call.

use std::borrow::Borrow;
use std::ops::ControlFlow;

use pc_expr::{Events, VectorField};

use crate::checkpoint::checkpoint::Checkpoint;
use crate::checkpoint::legs::{Reached, follow};
use crate::checkpoint::resumable::Resumable;
use crate::cvode::forward::sensitivities::Sensitivities;
use crate::error::SolveError;
use crate::events::events::Occurrence;
use crate::integration::dense_output::DenseOutput;
use crate::integration::integration::{Ending, Integration};
use crate::sensitivity::explicit::{Differentiated, Differentiating};
use crate::sensitivity::trajectory::{SensitivitySolution, SensitivityTrajectory};
use crate::settings::options::Options;
use crate::solve::failure::SolveFailure;
use crate::solve::solve::Solve;

/// A motion to be integrated together with its derivatives; [`Solve::sensitivities`] makes it.
#[derive(Debug, Clone)]
#[must_use]
pub struct SolveSensitivities<'a, F, E> {
    field: F,
    t0: f64,
    y0: &'a [f64],
    options: Options,
    events: E,
    sensitivities: &'a Sensitivities,
}

impl<'a, F: VectorField, M: Borrow<Options>, E: Events> Solve<'a, F, M, E> {
    /// Adds the integration of S = ∂y/∂(p, y₀), which jumps at resets as the [derivatives of the
    /// resets](Events::by_parameter) require.
    ///
    /// ```
    /// use pc_solve::{Sensitivities, Solve, from_fn};
    ///
    /// let decay = from_fn(1, |_t, y, ydot| { ydot[0] = -y[0]; Ok(()) });
    /// let by_start = Sensitivities::new().by_start(0);
    /// let solution = Solve::new(decay, 0.0, &[2.0]).sensitivities(&by_start).run(&[1.0])?;
    /// assert!((solution.trajectory.column(0, 0)[0] - (-1.0_f64).exp()).abs() < 1e-6);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn sensitivities(self, sensitivities: &'a Sensitivities) -> SolveSensitivities<'a, F, E> {
        let Solve { field, t0, y0, method, events } = self;
        SolveSensitivities { field, t0, y0, options: method.borrow().clone(), events, sensitivities }
    }
}

impl<F: VectorField, E: Events> SolveSensitivities<'_, F, E> {
    /// The states and derivatives at `times`, and the occurrences of events.
    ///
    /// # Errors
    /// [`SolveFailure`] with what was reached before the failure, which is nothing if the input is
    /// invalid.
    pub fn run(self, times: &[f64]) -> Result<SensitivitySolution, Box<SolveFailure<SensitivitySolution>>> {
        self.run_with_outputs(times, |_, _| ControlFlow::Continue(()))
    }

    /// Like [`run`](SolveSensitivities::run), but passes each output (t, y) to `output`, to show
    /// progress or to stop.
    ///
    /// # Errors
    /// As for [`run`](SolveSensitivities::run).
    pub fn run_with_outputs(
        self,
        times: &[f64],
        mut output: impl FnMut(f64, &[f64]) -> ControlFlow<()>,
    ) -> Result<SensitivitySolution, Box<SolveFailure<SensitivitySolution>>> {
        let mut reached = SensitivitySolution {
            trajectory: SensitivityTrajectory::new(self.field.dim(), self.sensitivities.len()),
            occurrences: Vec::new(),
            time_derivatives: Vec::new(),
            ending: None,
            slides: Vec::new(),
        };
        let mut integration = match self.towards(times.last().copied()) {
            Ok(integration) => integration,
            Err(error) => return Err(Box::new(SolveFailure { reached, error })),
        };
        let keep = |t: f64, y: &[f64], matrix: &[f64]| {
            reached.trajectory.push(t, y, matrix);
            output(t, y)
        };
        let occurred = |occurrence: &Occurrence| {
            reached.occurrences.push(occurrence.clone());
            ControlFlow::Continue(())
        };
        let result = integration.run_with_sensitivities(times, keep, occurred);
        reached.trajectory.finish(matches!(result, Ok(Ending::Completed)), integration.statistics());
        reached.slides = integration.slides().to_vec();
        reached.time_derivatives = integration.time_derivatives().to_vec();
        integration.release();
        match result {
            Ok(ending) => Ok(SensitivitySolution { ending: Some(ending), ..reached }),
            Err(error) => Err(Box::new(SolveFailure { reached, error })),
        }
    }

    /// The motion up to `end`, and S, as functions of time; the entries of S are column-major.
    ///
    /// # Errors
    /// As for [`Integration::run_dense_with_sensitivities`], which also gives what was reached
    /// before a failure.
    pub fn dense(self, end: f64) -> Result<(DenseOutput, DenseOutput), SolveError> {
        let (mut motion, mut matrix) = (DenseOutput::default(), DenseOutput::default());
        let SolveSensitivities { field, t0, y0, options, events, sensitivities } = self;
        let options = towards(options, Some(end));
        let integration = Integration::with_sensitivities(field, t0, y0, &options, sensitivities)?;
        let mut integration = integration.with_events(events)?;
        let result = integration.run_dense_with_sensitivities(
            end,
            |of_state, of_matrix| {
                motion.extend([of_state]);
                matrix.extend([of_matrix]);
                ControlFlow::Continue(())
            },
            |_| ControlFlow::Continue(()),
        );
        integration.release();
        result.map(|_| (motion, matrix))
    }

    /// The integration at its start, before any step.
    fn towards(self, end: Option<f64>) -> Result<Integration<Differentiated<F>, E>, SolveError> {
        let SolveSensitivities { field, t0, y0, options, events, sensitivities } = self;
        let method = Differentiated::new(field, t0, y0, &towards(options, end), sensitivities)?;
        Integration::of(method).with_events(events)
    }
}

/// Options with which the field is not evaluated beyond the end.
fn towards(mut options: Options, end: Option<f64>) -> Options {
    options.stop_time = options.stop_time.or(end.filter(|t| t.is_finite()));
    options
}

/// A motion to be integrated together with its derivatives from checkpoint to checkpoint;
/// [`Resumable::sensitivities`] makes it.
#[derive(Debug)]
#[must_use]
pub struct ResumableSensitivities<'a, P> {
    motion: Resumable<P, Options>,
    sensitivities: &'a Sensitivities,
}

impl<P, M: Borrow<Options>> Resumable<P, M> {
    /// Adds the integration of S = ∂y/∂(p, y₀). A checkpoint contains S at the time of the
    /// checkpoint and at the outputs before it.
    pub fn sensitivities(self, sensitivities: &Sensitivities) -> ResumableSensitivities<'_, P> {
        let options = self.method.borrow().clone();
        ResumableSensitivities { motion: self.method(options), sensitivities }
    }
}

impl<P> ResumableSensitivities<'_, P> {
    /// Like [`Resumable::run`]. Derivatives of the times of events are not recorded.
    ///
    /// # Errors
    /// As for [`Resumable::run`]; [`InputError::Sensitivities`](crate::InputError::Sensitivities)
    /// if the checkpoint has a different number of columns.
    pub fn run<F: VectorField, E: Events>(
        self,
        times: &[f64],
        save: impl FnMut(&Checkpoint, bool),
        step: impl FnMut(f64, &[f64]) -> ControlFlow<()>,
    ) -> Result<SensitivitySolution, Box<SolveFailure<SensitivitySolution>>>
    where
        P: FnMut() -> (F, E),
    {
        let ResumableSensitivities { motion: Resumable { parts, from, method, every }, sensitivities } = self;
        let method = Differentiating { options: &method, sensitivities };
        let with_matrices = |(motion, matrices): Reached| SensitivitySolution {
            trajectory: SensitivityTrajectory::of(motion.trajectory, sensitivities.len(), matrices),
            occurrences: motion.occurrences,
            time_derivatives: Vec::new(),
            ending: motion.ending,
            slides: motion.slides,
        };
        match follow(&method, parts, from, (times, every), save, step) {
            Ok(reached) => Ok(with_matrices(reached)),
            Err(failure) => Err(Box::new(failure.map(with_matrices))),
        }
    }
}
