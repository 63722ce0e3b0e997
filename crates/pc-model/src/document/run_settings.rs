//! The settings of a run, `[simulation]`, with their defaults.

use pc_expr::Method;

use crate::diagnostics::source::Place;
use crate::document::expression::{Located, NamedExpression};
use crate::document::tolerance::AbsoluteTolerance;
use crate::variables::Variables;

/// The settings of a run; the program chooses those that are left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Simulation {
    /// The section's header.
    pub place: Option<Place>,
    /// Start time.
    pub t_start: Option<Located<f64>>,
    /// End time.
    pub t_end: Option<Located<f64>>,
    /// The number of rows; at least 2 (start and end).
    pub samples: Option<Located<usize>>,
    /// The relative tolerance; positive.
    pub rtol: Option<Located<f64>>,
    /// The absolute tolerances; positive.
    pub atol: Option<Located<AbsoluteTolerance>>,
    /// The largest length of a step; positive.
    pub max_step: Option<Located<f64>>,
    /// The number of parts into which each step is divided in the search for events; at least 1.
    pub samples_per_step: Option<Located<u32>>,
    /// Events count as accumulated once the time remaining until they accumulate has shrunk to this fraction
    /// of the first interval between them; at least 0 and less than 1.
    pub accumulation: Option<Located<f64>>,
    /// Integration method.
    pub method: Option<Located<Method>>,
    /// The form of the equations.
    pub form: Option<Located<Variables>>,
    /// The quasi-velocities of the form `hamel`, as linear forms in the velocities.
    pub hamel: Vec<NamedExpression>,
    /// The velocities that are to be independent; if empty, the program chooses them.
    pub independent: Vec<Located<String>>,
    /// The integrals, or `energy`, that projection keeps at their values at the start.
    pub project: Vec<Located<String>>,
}

impl Simulation {
    /// The default number of rows of a table.
    pub const ROWS: usize = 201;
    /// The default relative tolerance.
    pub const RELATIVE_TOLERANCE: f64 = 1e-9;

    /// The start time; 0 if it is left out.
    pub fn start_time(&self) -> f64 {
        self.t_start.as_ref().map_or(0.0, |t| t.value)
    }

    /// The number of rows, [`ROWS`](Simulation::ROWS) if it is left out.
    pub fn rows(&self) -> usize {
        self.samples.as_ref().map_or(Simulation::ROWS, |samples| samples.value)
    }

    /// The relative tolerance, [`RELATIVE_TOLERANCE`](Simulation::RELATIVE_TOLERANCE) if it is left out.
    pub fn relative_tolerance(&self) -> f64 {
        self.rtol.as_ref().map_or(Simulation::RELATIVE_TOLERANCE, |rtol| rtol.value)
    }
}
