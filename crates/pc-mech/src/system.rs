//! Descriptions of mechanical systems: frame, Lagrangian, forces, bodies.
//!
//! The description of a system, in the form in which books give it, becomes a [`System`](system::System). Read `system`, then `builder`,
//! which takes each part in its usual form, and `build`, which combines them; `continuity` checks for jumps; `bodies` are the
//! contributions of particles and rigid bodies, `forces` the forms of Q_s (8), `external_force` forces that the caller
//! computes, `states` checks for first-order states, and `signals` inputs that are functions of time, by a `table`, with
//! `spline`s; `energy_rate` is the rate of the energy, and `holds` what holds joints at rest.

pub(crate) mod bodies;
pub(crate) mod build;
pub(crate) mod builder;
pub(crate) mod continuity;
pub(crate) mod energy_rate;
pub(crate) mod external_force;
pub(crate) mod forces;
pub(crate) mod holds;
pub(crate) mod signals;
pub(crate) mod spline;
pub(crate) mod states;
pub(crate) mod system;
pub(crate) mod table;
