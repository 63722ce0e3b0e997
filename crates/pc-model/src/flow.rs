//! The vector field to be integrated, its events, and the columns of a table of its states.
//!
//! An [`Assembly`](crate::Assembly) becomes a [`Flow`](flow::Flow). Read `equations_of_forms` first, the equations in the variables of their state;
//! then `free_form`, the equations in independent quasi-velocities, whose start is given by `formulas`, with `independent_velocities` for
//! Voronets' equations; then `compile`, which compiles
//! their motion and evaluates it at the start. `reading` converts states to coordinates, quasi-velocities and first-order states; `events`
//! evaluates the model's events on these, and `constrained_resets` finds the states that constraints allow after resets, `impacts` those after impacts of joints on their stops. `flow` combines
//! all of this; `tolerances` depend on the scales of a flow; `prototype` gives a flow other values without deriving its equations again;
//! `velocity_maps` has the Jacobians of bodies and of their momenta.

pub(crate) mod compile;
pub(crate) mod constrained_resets;
pub(crate) mod equations_of_forms;
pub(crate) mod event_slopes;
pub(crate) mod events;
pub(crate) mod flow;
pub(crate) mod formulas;
pub(crate) mod free_form;
pub(crate) mod impacts;
pub(crate) mod independent_velocities;
pub(crate) mod prototype;
pub(crate) mod reading;
pub(crate) mod start_slopes;
pub(crate) mod tolerances;
pub(crate) mod velocity_maps;
