//! States and their derivatives at the output times.

use std::error::Error;
use std::fmt;
use std::ops::ControlFlow;

use pc_expr::{Events, VectorField};

use crate::cvode::{Cvode, Ending};
use crate::dense::DenseOutput;
use crate::error::SolveError;
use crate::events::Occurrence;
use crate::options::Options;
use crate::sensitivity::Sensitivities;
use crate::trajectory::Trajectory;

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

    /// S at output time `i`, dim × columns and column-major: entry `k + j * dim` is the derivative of component k by
    /// what column j stands for.
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

/// Integrates ẏ = f(t, y) from y(t0) = y0 as [`solve`](crate::solve()) does, and derivatives of the motion with it.
///
/// # Errors
/// [`SensitivityFailure`] with the outputs reached before the failure; none if the input is not valid.
pub fn solve_with_sensitivities<F: VectorField>(
    field: F,
    t0: f64,
    y0: &[f64],
    times: &[f64],
    options: &Options,
    sensitivities: &Sensitivities,
) -> Result<SensitivityTrajectory, Box<SensitivityFailure>> {
    let mut reached = SensitivityTrajectory::new(field.dim(), sensitivities.len());
    let mut options = options.clone();
    options.stop_time = options.stop_time.or(times.last().copied().filter(|t| t.is_finite()));
    let mut cvode = match Cvode::with_sensitivities(field, t0, y0, &options, sensitivities) {
        Ok(cvode) => cvode,
        Err(error) => return Err(Box::new(SensitivityFailure { reached, error })),
    };
    let result = cvode.run_with_sensitivities(times, |t, y, matrix| {
        reached.motion.push(t, y);
        reached.matrices.extend_from_slice(matrix);
        ControlFlow::Continue(())
    });
    reached.motion.finish(matches!(result, Ok(Ending::Completed)), cvode.statistics());
    match result {
        Ok(_) => Ok(reached),
        Err(error) => Err(Box::new(SensitivityFailure { reached, error })),
    }
}

/// A failed [`solve_with_sensitivities`] with the outputs it had reached.
#[derive(Debug)]
#[non_exhaustive]
pub struct SensitivityFailure {
    /// The outputs before the failure.
    pub reached: SensitivityTrajectory,
    /// What went wrong.
    pub error: SolveError,
}

impl fmt::Display for SensitivityFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.error.fmt(f)
    }
}

impl Error for SensitivityFailure {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        self.error.source()
    }
}

/// A motion with events and the derivatives of it.
#[derive(Debug, Clone, PartialEq)]
pub struct HybridSensitivities {
    /// The states and S at the output times, y⁺ and S⁺ at those of events; a terminal event is the last.
    pub trajectory: SensitivityTrajectory,
    /// What occurred, in order.
    pub occurrences: Vec<Occurrence>,
    /// How it ended; none if it failed.
    pub ending: Option<Ending>,
}

/// As [`solve_with_sensitivities`], with events: S jumps where a reset does, by
/// [its derivatives](Events::by_parameter). The motion begins at (t0, y0); `output` sees each output time with its state, and
/// may stop the integration.
///
/// # Errors
/// [`HybridSensitivityFailure`] with what was reached before.
pub fn solve_with_sensitivities_and_events<F: VectorField, E: Events>(
    field: F,
    (t0, y0): (f64, &[f64]),
    times: &[f64],
    options: &Options,
    sensitivities: &Sensitivities,
    events: E,
    mut output: impl FnMut(f64, &[f64]) -> ControlFlow<()>,
) -> Result<HybridSensitivities, Box<HybridSensitivityFailure>> {
    let trajectory = SensitivityTrajectory::new(field.dim(), sensitivities.len());
    let mut reached = HybridSensitivities { trajectory, occurrences: Vec::new(), ending: None };
    let mut options = options.clone();
    options.stop_time = options.stop_time.or(times.last().copied().filter(|t| t.is_finite()));
    let start = Cvode::with_sensitivities(field, t0, y0, &options, sensitivities);
    let mut hybrid = match start.and_then(|cvode| cvode.with_events(events)) {
        Ok(hybrid) => hybrid,
        Err(error) => return Err(Box::new(HybridSensitivityFailure { reached, error })),
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
    let result = hybrid.run_with_sensitivities(times, keep, occurred);
    let complete = matches!(result, Ok(Ending::Completed));
    reached.trajectory.motion.finish(complete, hybrid.statistics());
    match result {
        Ok(ending) => Ok(HybridSensitivities { ending: Some(ending), ..reached }),
        Err(error) => Err(Box::new(HybridSensitivityFailure { reached, error })),
    }
}

/// Integrates ẏ = f(t, y) from y(t0) = y0 to `end` and returns the motion and S as functions of time, the
/// entries of S column-major.
///
/// # Errors
/// As for [`Cvode::run_dense_with_sensitivities`], which also gives what was reached.
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
    let mut cvode = Cvode::with_sensitivities(field, t0, y0, &options, sensitivities)?;
    cvode.run_dense_with_sensitivities(end, |of_state, of_matrix| {
        motion.extend([of_state]);
        matrix.extend([of_matrix]);
        ControlFlow::Continue(())
    })?;
    Ok((motion, matrix))
}

/// A failed [`solve_with_sensitivities_and_events`] with what it had reached.
#[derive(Debug)]
#[non_exhaustive]
pub struct HybridSensitivityFailure {
    /// Outputs and occurrences before the failure.
    pub reached: HybridSensitivities,
    /// What went wrong.
    pub error: SolveError,
}

impl fmt::Display for HybridSensitivityFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.error.fmt(f)
    }
}

impl Error for HybridSensitivityFailure {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        self.error.source()
    }
}
