//! What to run: [`Wishes`] and a model become a [`Plan`].
//!
//! `wishes` are the options of the caller, `plan` is all that a run needs, `tolerances` those of
//! the components of the state, and `memory` whether the rows fit.

pub(crate) mod memory;
pub(crate) mod plan;
pub(crate) mod tolerances;
mod wishes;

pub use plan::Plan;
pub use tolerances::Tolerances;
pub use wishes::Wishes;
