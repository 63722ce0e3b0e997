//! States at the output times.

use crate::integration::statistics::Statistics;

/// The states of a motion at its output times, in the order in which they were reached.
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory {
    dim: usize,
    times: Vec<f64>,
    /// One state after another.
    states: Vec<f64>,
    complete: bool,
    statistics: Statistics,
}

impl Trajectory {
    pub(crate) fn new(dim: usize) -> Self {
        Trajectory {
            dim,
            times: Vec::new(),
            states: Vec::new(),
            complete: false,
            statistics: Statistics::default(),
        }
    }

    /// An empty trajectory with room for `outputs` outputs.
    #[cfg(feature = "cvode")] // for the members of an ensemble
    pub(crate) fn with_capacity(dim: usize, outputs: usize) -> Self {
        let (times, states) = (Vec::with_capacity(outputs), Vec::with_capacity(dim * outputs));
        Trajectory { times, states, ..Trajectory::new(dim) }
    }

    pub(crate) fn push(&mut self, t: f64, y: &[f64]) {
        self.times.push(t);
        self.states.extend_from_slice(y);
    }

    /// The first `len` outputs.
    pub(crate) fn first(&self, len: usize) -> Trajectory {
        let (times, states) = (self.times[..len].to_vec(), self.states[..len * self.dim].to_vec());
        Trajectory { times, states, ..Trajectory::new(self.dim) }
    }

    pub(crate) fn finish(&mut self, complete: bool, statistics: Statistics) {
        self.complete = complete;
        self.statistics = statistics;
    }

    /// The number of components of a state.
    pub fn dim(&self) -> usize {
        self.dim
    }

    /// The number of outputs.
    pub fn len(&self) -> usize {
        self.times.len()
    }

    /// Whether there is no output.
    pub fn is_empty(&self) -> bool {
        self.times.is_empty()
    }

    /// The output times.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The state at `times()[i]`, of length [`dim`](Trajectory::dim).
    ///
    /// # Panics
    /// Panics if `i` is not less than [`len`](Trajectory::len).
    pub fn state(&self, i: usize) -> &[f64] {
        &self.states[i * self.dim..(i + 1) * self.dim]
    }

    /// All states, one after another: component j at `times()[i]` is `states()[i * dim + j]`.
    pub fn states(&self) -> &[f64] {
        &self.states
    }

    /// Component `j` at each output time.
    ///
    /// # Panics
    /// Panics if `j` is not less than [`dim`](Trajectory::dim).
    pub fn component(&self, j: usize) -> impl Iterator<Item = f64> {
        assert!(j < self.dim, "component {j} of {}", self.dim);
        self.iter().map(move |(_, y)| y[j])
    }

    /// The outputs (t, y) in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (f64, &[f64])> {
        self.times.iter().copied().zip(self.states.chunks_exact(self.dim.max(1)))
    }

    /// The last output (t, y).
    pub fn last(&self) -> Option<(f64, &[f64])> {
        self.times.last().map(|&t| (t, self.state(self.len() - 1)))
    }

    /// Whether all requested output times were reached.
    pub fn is_complete(&self) -> bool {
        self.complete
    }

    /// The work done, including the work beyond the last output if the integration failed or was
    /// stopped.
    pub fn statistics(&self) -> &Statistics {
        &self.statistics
    }
}
