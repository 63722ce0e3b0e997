//! What an integration keeps to, whatever the method.

use pc_expr::Deadline;

use crate::events::events::Accumulation;
use crate::settings::inequality::Inequality;

/// What an integration keeps to, whatever the method.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Limits {
    /// Most steps from one output to the next.
    pub max_steps: u64,
    /// In how many parts of a step events are looked for.
    pub samples_per_step: u32,
    /// When occurrences of an event accumulate.
    pub accumulation: Accumulation,
    /// Signs that components keep; empty if none does.
    pub inequalities: Vec<Inequality>,
    /// When no further step is begun, if at any time.
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
