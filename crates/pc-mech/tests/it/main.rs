//! Tests of Poincaré's and Chetaev's equations in `pc-mech`, one module a topic.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod bodies;
mod canonical;
mod carried;
mod common;
mod constraint_manifold;
mod coriolis;
mod derivatives;
mod external;
mod force_balance;
mod given_brackets;
mod input_forms;
mod kept;
mod legendre;
mod momenta_under_constraints;
mod multipliers;
mod projection;
#[path = "../../../../tests/src/classical/random.rs"]
mod random;
mod relativistic;
mod tree_bits;
mod trees;
mod velocity_maps;
