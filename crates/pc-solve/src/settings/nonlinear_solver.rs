//! How implicit equations are solved.

/// How the implicit equation of a step is solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum NonlinearSolver {
    /// Newton's iteration, with a [`LinearSolver`](crate::LinearSolver).
    Newton,
    /// Fixed-point iteration, which needs no matrix, but converges only for small steps if the
    /// system is stiff.
    FixedPoint,
}
