//! Errors for a motion that has no rates, or no momenta, at a state.

use pc_expr::readable;

use crate::error::lists::listed;

/// An error in the evaluation of a motion.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EvaluationError {
    /// A pivot of the mass matrix vanishes.
    #[error(
        "the mass matrix is singular: its pivot for `{quasi_velocity}` is {} at t = {t}{}",
        readable(*pivot),
        listed(state)
    )]
    SingularMassMatrix {
        /// The quasi-velocity whose acceleration is not determined.
        quasi_velocity: String,
        /// The pivot.
        pivot: f64,
        /// Time.
        t: f64,
        /// Names and values of the state.
        state: Vec<(String, f64)>,
    },
    /// Newton's method found no quasi-velocities with the given momenta.
    #[error(
        "no solution η of y = ∂L/∂η was found: after {iterations} steps |y − ∂L/∂η| is {} at t = {t}{}",
        readable(*residual),
        listed(state)
    )]
    LegendreNotSolved {
        /// |y − ∂L/∂η|
        residual: f64,
        /// Number of steps taken.
        iterations: usize,
        /// Time.
        t: f64,
        /// Names and values of the state (x, y).
        state: Vec<(String, f64)>,
    },
    /// A derivative was requested that was not [compiled](crate::CompileOptions).
    #[error("the motion was compiled without its {what}")]
    NotCompiled {
        /// The derivative.
        what: &'static str,
    },
    /// Equations of variation were requested for a piecewise motion, whose deviations jump from one
    /// piece to the next.
    #[error(
        "deviations from this motion jump where it passes through {}: integrate them as sensitivities to the start, which jump there",
        .surfaces.join(" = 0 or ") + " = 0"
    )]
    Pieces {
        /// The functions that vanish where the pieces meet.
        surfaces: Vec<String>,
    },
    /// A motion whose equations are not a single program, so that it has no Taylor series.
    #[error("Taylor's method needs equations that are solved in expressions: {because}")]
    NoSeries {
        /// Why they are not a single program.
        because: &'static str,
    },
    /// The failure of another vector field.
    #[error("{cause}")]
    NotEvaluated {
        /// Its message.
        cause: String,
    },
}
