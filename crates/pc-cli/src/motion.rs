//! The computation of a motion, from a plan to a finished run.
//!
//! In go a model and a command line, out comes a [`Run`](run::Run). Read `plan` first, the request,
//! with the `tolerances` of the components of the state, and `memory`, whether its rows fit. A `checkpoint`, with its `identity` and `checkpoint_error`,
//! continues an interrupted run; `sensitivities` are derivatives by parameters, `estimate` the global
//! errors; `given` integrates a motion whose rows are written at once. `progress` and `interrupt` are the bar and Ctrl-C.
//! `lost_integral` finds, at some `step_states`, what was proved to be kept and is `lost`, `lost_inertia`
//! why a mass matrix became singular.
//! `fine` is the motion between its rows, for pictures; `table` and `run` are the results.

pub mod checkpoint;
pub mod checkpoint_error;
pub mod estimate;
pub(crate) mod fine;
pub(crate) mod given;
pub(crate) mod identity;
pub(crate) mod interrupt;
pub mod lost;
pub(crate) mod lost_inertia;
pub mod lost_integral;
pub(crate) mod memory;
pub mod plan;
pub(crate) mod progress;
pub mod run;
pub(crate) mod sensitivities;
pub(crate) mod step_states;
pub mod table;
pub mod tolerances;
