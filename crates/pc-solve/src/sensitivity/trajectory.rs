//! States and their derivatives at the output times.

use crate::events::events::Occurrence;
use crate::integration::held_sides::Slide;
use crate::integration::integration::Ending;
use crate::integration::statistics::Statistics;
use crate::integration::trajectory::Trajectory;

/// The states of a motion at its output times, and S(t) = ∂y(t)/∂(p, y₀) there.
#[derive(Debug, Clone, PartialEq)]
pub struct SensitivityTrajectory {
    motion: Trajectory,
    columns: usize,
    /// One matrix after another.
    matrices: Vec<f64>,
}

impl SensitivityTrajectory {
    pub(super) fn new(dim: usize, columns: usize) -> Self {
        SensitivityTrajectory { motion: Trajectory::new(dim), columns, matrices: Vec::new() }
    }

    /// The trajectory of this motion, with one matrix after another.
    pub(super) fn of(motion: Trajectory, columns: usize, matrices: Vec<f64>) -> Self {
        SensitivityTrajectory { motion, columns, matrices }
    }

    pub(super) fn push(&mut self, t: f64, y: &[f64], matrix: &[f64]) {
        self.motion.push(t, y);
        self.matrices.extend_from_slice(matrix);
    }

    pub(super) fn finish(&mut self, complete: bool, statistics: Statistics) {
        self.motion.finish(complete, statistics);
    }

    /// The motion itself.
    pub fn motion(&self) -> &Trajectory {
        &self.motion
    }

    /// The number of columns of S.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// S at output time `i`, dim × columns and column-major: entry `k + j * dim` is the derivative
    /// of component k for column j.
    ///
    /// # Panics
    /// Panics if `i` is not less than the number of outputs.
    pub fn matrix(&self, i: usize) -> &[f64] {
        let len = self.motion.dim() * self.columns;
        &self.matrices[i * len..(i + 1) * len]
    }

    /// Column `j` of S at output time `i`.
    ///
    /// # Panics
    /// Panics if there is no such output or column.
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

/// A motion with events, and its derivatives.
#[derive(Debug, Clone, PartialEq)]
pub struct SensitivitySolution {
    /// The states and S at the output times, which are y⁺ and S⁺ at events; a terminal event is the
    /// last output.
    pub trajectory: SensitivityTrajectory,
    /// The occurrences of events, in order.
    pub occurrences: Vec<Occurrence>,
    /// For each occurrence, the [derivatives of its time](crate::Integration::time_derivatives), one for
    /// each column; not recorded for motions with checkpoints.
    pub time_derivatives: Vec<Vec<f64>>,
    /// How the integration ended; none if it failed.
    pub ending: Option<Ending>,
    /// The parts of the motion that slide along surfaces on which the field jumps.
    pub slides: Vec<Slide>,
}
