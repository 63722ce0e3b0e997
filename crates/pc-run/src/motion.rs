//! The computation of a motion, from a plan to a finished run.
//!
//! `integrate` makes a [`Run`](run::Run) from a model and its plan, with equations that may have been `derived` before, and
//! kept in a `cache`. `checkpoints`, with
//! their `identity` and `checkpoint_error`, continue an interrupted run; `sensitivities` computes derivatives with respect to parameters,
//! `gradient` differentiates one function of the motion with respect to all parameters, and `estimate` computes the global errors, by
//! the companion that `accuracy` gives row by row;
//! `streamed` is a motion whose rows are written as they are computed. `verification` compares a motion with a second derivation, and
//! `remarks` are notes on the equations. `lost_integral` finds, from some `step_states`, an integral that is proved to be conserved but is
//! `lost`; `lost_inertia` finds why a mass matrix became singular. `fine` is the motion between its rows, for pictures; `table` and `run`
//! are the results, which `output` writes, `summary` describes and `recording` prepares for pages and pictures.

pub mod accuracy;
pub mod cache;
pub mod checkpoint_error;
pub mod checkpoints;
pub mod derived;
pub mod estimate;
mod fine;
pub mod gradient;
pub(crate) mod identity;
pub mod integrate;
pub mod lost;
mod lost_inertia;
mod lost_integral;
mod output;
mod recording;
pub mod remarks;
pub mod run;
mod sensitivities;
mod step_states;
mod streamed;
pub mod summary;
pub mod table;
pub mod verification;
