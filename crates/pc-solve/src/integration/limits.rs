//! Limits on an integration with any method.

use pc_expr::Deadline;

use crate::events::events::Accumulation;
use crate::settings::inequality::Inequality;

/// Limits on an integration with any method.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Limits {
    /// The maximum number of steps from one output to the next.
    pub max_steps: u64,
    /// The number of parts into which each step is divided for the search for events.
    pub samples_per_step: u32,
    /// When occurrences of an event count as accumulated.
    pub accumulation: Accumulation,
    /// The inequalities that components have to satisfy, one for each component; empty if there are
    /// none.
    pub inequalities: Vec<Inequality>,
    /// The time after which no further step begins, if there is one.
    pub deadline: Option<Deadline>,
}

impl Default for Limits {
    fn default() -> Limits {
        let accumulation = Accumulation::default();
        Limits {
            max_steps: 500_000,
            samples_per_step: 4,
            accumulation,
            inequalities: Vec::new(),
            deadline: None,
        }
    }
}
