//! What to run: [`Wishes`] and a model become a [`Plan`].
//!
//! `wishes` are the options of the caller, `plan` is everything that a run needs, `tolerances` are the
//! tolerances of the components of the state, and `memory` finds whether there is enough memory for the rows.

pub(crate) mod memory;
pub(crate) mod plan;
pub(crate) mod tolerances;
mod wishes;

pub use plan::Plan;
pub use tolerances::Tolerances;
pub use wishes::Wishes;
