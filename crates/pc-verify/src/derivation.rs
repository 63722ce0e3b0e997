//! The second derivation at one state.
//!
//! Terms are evaluated at a `point`, whose variables are those of a `place` (a state). Read `derivation` first: the parts that are linear
//! in velocities. These parts yield the `velocities`, the `structure` coefficients (`constants` or `brackets`) and the
//! `forces` with their `force_function` and the `friction` of contacts, which in turn yield the `equations`, with `resultants`. `here` holds the
//! results at one place, and `quantity` names the quantities that both derivations have; `states` draws random places,
//! and `summands` computes the sizes of sums.

pub(crate) mod brackets;
pub(crate) mod constants;
pub(crate) mod derivation;
pub(crate) mod equations;
pub(crate) mod force_function;
pub(crate) mod forces;
pub(crate) mod friction;
pub(crate) mod here;
pub(crate) mod place;
pub(crate) mod point;
pub(crate) mod quantity;
pub(crate) mod resultants;
pub(crate) mod states;
pub(crate) mod structure;
pub(crate) mod summands;
pub(crate) mod velocities;
