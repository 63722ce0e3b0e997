//! What is to be run: [`Wishes`](wishes::Wishes) and a model become a [`Plan`](plan::Plan).
//!
//! `wishes` is what whoever asks says, `plan` all that a run needs, `tolerances` those of the
//! components of the state, and `memory` whether the rows fit.

pub(crate) mod memory;
pub mod plan;
pub mod tolerances;
pub mod wishes;
