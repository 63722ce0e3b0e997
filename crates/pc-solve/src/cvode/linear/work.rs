//! The data of the callbacks of a linear solver.

use crate::cvode::linear::preconditioner::Preconditioner;
use crate::cvode::linear::quotients::Quotients;

/// The data of the callbacks of the linear solver, besides the vector field.
#[derive(Default)]
pub(crate) struct Work {
    /// The entries of ∂f/∂y, in the order of the field's pattern.
    pub(super) entries: Vec<f64>,
    pub(super) quotients: Option<Quotients>,
    pub(super) preconditioner: Option<Box<dyn Preconditioner + Send>>,
}

impl Work {
    /// Resets the counts, as CVODES does when reinitialised.
    pub(crate) fn forget_counts(&mut self) {
        if let Some(quotients) = &mut self.quotients {
            quotients.forget_evaluations();
        }
    }

    /// The number of evaluations of f for our difference quotients, which CVODES does not count.
    pub(crate) fn quotient_evaluations(&self) -> u64 {
        self.quotients.as_ref().map_or(0, Quotients::evaluations)
    }
}
