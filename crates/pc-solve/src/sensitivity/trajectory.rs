//! States and their derivatives at the output times.

use std::error::Error;
use std::fmt;
use std::ops::ControlFlow;

use pc_expr::VectorField;

use crate::cvode::cvode::{Cvode, Ending};
use crate::error::SolveError;
use crate::integration::options::Options;
use crate::integration::trajectory::Trajectory;
use crate::sensitivity::options::Sensitivities;

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

/// Integrates ẏ = f(t, y) from y(t0) = y0 as [`solve`](crate::integration::solve()) does, and derivatives of the motion with it.
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
