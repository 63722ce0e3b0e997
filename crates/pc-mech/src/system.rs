//! Mechanical systems as they are described: frame, Lagrangian, forces, bodies.
//!
//! In goes what a book says of a system, out comes a [`System`](system::System). Read `system`, then `builder`, which
//! takes each part in the form it has; `bodies` are what particles and rigid bodies add, `forces` the forms of Q_s (8),
//! `external_force` what gives forces computed outside, `signals` inputs that are functions of time; `energy_rate`
//! is what changes the energy.

pub(crate) mod bodies;
pub(crate) mod builder;
pub(crate) mod energy_rate;
pub(crate) mod external_force;
pub(crate) mod forces;
pub(crate) mod signals;
pub(crate) mod system;
