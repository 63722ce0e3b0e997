//! The vector field that is integrated, what happens on its way, and what a table shows of its states.
//!
//! In goes an [`Assembly`](crate::Assembly), out comes a [`Flow`](flow::Flow). Read `variables` first, the equations in the
//! variables of their state, `free_form`, those of independent quasi-velocities, and `compile`, their motion, tried at the start; `reading` gives states as coordinates,
//! quasi-velocities and first-order states; `events` are the model's events on them, and `flow` is all of these.

pub(crate) mod compile;
pub(crate) mod event_slopes;
pub(crate) mod events;
pub(crate) mod flow;
pub(crate) mod free_form;
pub(crate) mod reading;
pub(crate) mod start_slopes;
pub(crate) mod variables;
