//! The options of a run; everything else is supplied by the text of the model and the defaults.

use pc_model::Variables;
use pc_model::document::AbsoluteTolerance;
use pc_solve::Method;

/// The options of a run; none by default.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Wishes {
    /// Form of the equations.
    pub form: Option<Variables>,
    /// End time.
    pub t_end: Option<f64>,
    /// The number of rows, at least 2.
    pub samples: Option<usize>,
    /// The times of the rows, given instead of their number, in order; the last is the end time.
    pub times: Option<Vec<f64>>,
    /// Relative tolerance.
    pub rtol: Option<f64>,
    /// The absolute tolerances, as far as they are given.
    pub atol: AbsoluteTolerance,
    /// The largest length of a step.
    pub max_step: Option<f64>,
    /// The largest number of steps from one row to the next.
    pub max_steps: Option<u64>,
    /// The number of parts of each step that are searched for events.
    pub samples_per_step: Option<u32>,
    /// The fraction of the first interval between events at which they count as accumulated.
    pub accumulation: Option<f64>,
    /// Method.
    pub method: Option<Method>,
    /// The names of the parameters with respect to which the motion is differentiated.
    pub sensitivities: Vec<String>,
}
