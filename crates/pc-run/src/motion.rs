//! The computation of a motion, from a plan to a finished run.
//!
//! In go a model and its plan, out comes a [`Run`](run::Run), by `integrate`, of equations that may have been `derived` before. `checkpoints`, with their `identity` and `checkpoint_error`,
//! continue an interrupted run; `sensitivities` are derivatives by parameters, `gradient` those of one function of the motion by all of them, `estimate` the global
//! errors; `streamed` is a motion whose rows are written at once. `verification` compares it with a second derivation, `remarks` are what to
//! know of the equations. `lost_integral` finds, at some `step_states`, what was proved to be kept and is `lost`, `lost_inertia`
//! why a mass matrix became singular.
//! `fine` is the motion between its rows, for pictures; `table` and `run` are the results, which `output` writes, `summary` puts into words and
//! `record` prepares for pages and pictures.

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
mod record;
pub mod remarks;
pub mod run;
mod sensitivities;
mod step_states;
mod streamed;
pub mod summary;
pub mod table;
pub mod verification;
