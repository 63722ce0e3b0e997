//! States and their derivatives at the output times.

use std::num::NonZeroU64;
use std::ops::ControlFlow;

use pc_expr::{Events, VectorField};

use crate::checkpoint::checkpoint::Checkpoint;
use crate::checkpoint::legs::{Reached, follow};
use crate::cvode::forward::sensitivities::Sensitivities;
use crate::error::SolveError;
use crate::events::events::Occurrence;
use crate::integration::dense_output::DenseOutput;
use crate::integration::held_sides::Slide;
use crate::integration::integration::{Ending, Integration};
use crate::integration::trajectory::Trajectory;
use crate::sensitivity::explicit::{Differentiated, Differentiating};
use crate::settings::options::Options;
use crate::solve::failure::SolveFailure;

/// The states of a motion at its output times, and S(t) = ∂y(t)/∂(p, y₀) there.
#[derive(Debug, Clone, PartialEq)]
pub struct SensitivityTrajectory {
    motion: Trajectory,
    columns: usize,
    /// One matrix after the other.
    matrices: Vec<f64>,
}

impl SensitivityTrajectory {
    fn new(dim: usize, columns: usize) -> Self {
        SensitivityTrajectory { motion: Trajectory::new(dim), columns, matrices: Vec::new() }
    }

    /// The motion itself.
    pub fn motion(&self) -> &Trajectory {
        &self.motion
    }

    /// Number of columns of S.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// S at output time `i`, dim × columns and column-major: entry `k + j * dim` is the derivative
    /// of component k for column j.
    ///
    /// # Panics
    /// If `i` is not less than the number of outputs.
    pub fn matrix(&self, i: usize) -> &[f64] {
        let len = self.motion.dim() * self.columns;
        &self.matrices[i * len..(i + 1) * len]
    }

    /// Column `j` of S at output time `i`.
    ///
    /// # Panics
    /// If there is no such output or column.
    pub fn column(&self, i: usize, j: usize) -> &[f64] {
        assert!(j < self.columns, "column {j} of {}", self.columns);
        let dim = self.motion.dim();
        &self.matrix(i)[j * dim..(j + 1) * dim]
    }

    /// The outputs (t, y, S) in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (f64, &[f64], &[f64])> {
        (0..self.motion.len()).map(|i| (self.motion.times()[i], self.motion.state(i), self.matrix(i)))
    }
}

/// Integrates ẏ = f(t, y) from y(t0) = y0 as [`solve`](crate::solve()) does, and derivatives of the
/// motion with it.
///
/// # Errors
/// [`SolveFailure`] with the outputs reached before the failure; none if the input is invalid.
pub fn solve_with_sensitivities<F: VectorField>(
    field: F,
    t0: f64,
    y0: &[f64],
    times: &[f64],
    options: &Options,
    sensitivities: &Sensitivities,
) -> Result<SensitivityTrajectory, Box<SolveFailure<SensitivityTrajectory>>> {
    let mut reached = SensitivityTrajectory::new(field.dim(), sensitivities.len());
    let mut options = options.clone();
    options.stop_time = options.stop_time.or(times.last().copied().filter(|t| t.is_finite()));
    let mut integration = match Differentiated::new(field, t0, y0, &options, sensitivities) {
        Ok(method) => Integration::of(method),
        Err(error) => return Err(Box::new(SolveFailure { reached, error })),
    };
    let result = integration.run_with_sensitivities(
        times,
        |t: f64, y: &[f64], matrix: &[f64]| {
            reached.motion.push(t, y);
            reached.matrices.extend_from_slice(matrix);
            ControlFlow::Continue(())
        },
        |_| ControlFlow::Continue(()),
    );
    reached.motion.finish(matches!(result, Ok(Ending::Completed)), integration.statistics());
    integration.release();
    match result {
        Ok(_) => Ok(reached),
        Err(error) => Err(Box::new(SolveFailure { reached, error })),
    }
}

/// A motion with events, and its derivatives.
#[derive(Debug, Clone, PartialEq)]
pub struct SensitivitySolution {
    /// The states and S at the output times, y⁺ and S⁺ at events; a terminal event is the last
    /// output.
    pub trajectory: SensitivityTrajectory,
    /// The occurrences, in order.
    pub occurrences: Vec<Occurrence>,
    /// For each occurrence the [derivatives of its time](Integration::time_derivatives), one for each column; none are
    /// kept with checkpoints.
    pub time_derivatives: Vec<Vec<f64>>,
    /// How it ended; none if it failed.
    pub ending: Option<Ending>,
    /// The parts that slide along surfaces on which the field jumps.
    pub slides: Vec<Slide>,
}

/// As [`solve_with_sensitivities`], with events: S jumps at resets, by [their
/// derivatives](Events::by_parameter). `output` receives each output time with its state, and may
/// stop the integration.
///
/// # Errors
/// [`SolveFailure`] with what was reached before the failure.
pub fn solve_with_sensitivities_and_events<F: VectorField, E: Events>(
    field: F,
    (t0, y0): (f64, &[f64]),
    times: &[f64],
    options: &Options,
    sensitivities: &Sensitivities,
    events: E,
    mut output: impl FnMut(f64, &[f64]) -> ControlFlow<()>,
) -> Result<SensitivitySolution, Box<SolveFailure<SensitivitySolution>>> {
    let trajectory = SensitivityTrajectory::new(field.dim(), sensitivities.len());
    let mut reached = SensitivitySolution {
        trajectory,
        occurrences: Vec::new(),
        time_derivatives: Vec::new(),
        ending: None,
        slides: Vec::new(),
    };
    let mut options = options.clone();
    options.stop_time = options.stop_time.or(times.last().copied().filter(|t| t.is_finite()));
    let start = Differentiated::new(field, t0, y0, &options, sensitivities);
    let mut integration = match start.and_then(|method| Integration::of(method).with_events(events)) {
        Ok(integration) => integration,
        Err(error) => return Err(Box::new(SolveFailure { reached, error })),
    };
    let keep = |t: f64, y: &[f64], matrix: &[f64]| {
        reached.trajectory.motion.push(t, y);
        reached.trajectory.matrices.extend_from_slice(matrix);
        output(t, y)
    };
    let occurred = |occurrence: &Occurrence| {
        reached.occurrences.push(occurrence.clone());
        ControlFlow::Continue(())
    };
    let result = integration.run_with_sensitivities(times, keep, occurred);
    let complete = matches!(result, Ok(Ending::Completed));
    reached.trajectory.motion.finish(complete, integration.statistics());
    reached.slides = integration.slides().to_vec();
    reached.time_derivatives = integration.time_derivatives().to_vec();
    integration.release();
    match result {
        Ok(ending) => Ok(SensitivitySolution { ending: Some(ending), ..reached }),
        Err(error) => Err(Box::new(SolveFailure { reached, error })),
    }
}

/// As [`solve_checkpointed`](crate::solve_checkpointed), with sensitivities, by any method; a checkpoint contains its own
/// and those of the outputs before it. Derivatives of the times of events are not kept.
///
/// # Errors
/// As there; [`InputError::Sensitivities`](crate::InputError::Sensitivities) if the checkpoint has another number of columns.
pub fn solve_checkpointed_with_sensitivities<F: VectorField, E: Events>(
    (options, sensitivities): (&Options, &Sensitivities),
    parts: impl FnMut() -> (F, E),
    from: Checkpoint,
    times: &[f64],
    every: NonZeroU64,
    save: impl FnMut(&Checkpoint, bool),
    step: impl FnMut(f64, &[f64]) -> ControlFlow<()>,
) -> Result<SensitivitySolution, Box<SolveFailure<SensitivitySolution>>> {
    let method = Differentiating { options, sensitivities };
    let with_matrices = |(motion, matrices): Reached| SensitivitySolution {
        trajectory: SensitivityTrajectory {
            motion: motion.trajectory,
            columns: sensitivities.len(),
            matrices,
        },
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

/// Integrates ẏ = f(t, y) from y(t0) = y0 to `end` and returns the motion and S as functions of
/// time, the entries of S column-major.
///
/// # Errors
/// As for [`Integration::run_dense_with_sensitivities`], which also gives what was reached.
pub fn solve_dense_with_sensitivities<F: VectorField>(
    field: F,
    t0: f64,
    y0: &[f64],
    end: f64,
    options: &Options,
    sensitivities: &Sensitivities,
) -> Result<(DenseOutput, DenseOutput), SolveError> {
    let mut options = options.clone();
    options.stop_time = options.stop_time.or(Some(end).filter(|t| t.is_finite()));
    let (mut motion, mut matrix) = (DenseOutput::default(), DenseOutput::default());
    let mut integration = Integration::with_sensitivities(field, t0, y0, &options, sensitivities)?;
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
