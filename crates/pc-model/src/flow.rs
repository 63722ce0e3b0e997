//! The vector field that is integrated, what happens on its way, and what a table shows of its states.
//!
//! Read `flow` first; `variables` are the equations in the variables of their state, `events` the model's events on
//! them, `reading` gives states as coordinates, quasi-velocities and first-order states.

pub(crate) mod event_slopes;
pub(crate) mod events;
pub(crate) mod flow;
pub(crate) mod reading;
pub(crate) mod start_slopes;
pub(crate) mod variables;
