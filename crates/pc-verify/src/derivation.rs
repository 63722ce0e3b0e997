//! The second derivation at one state.
//!
//! Terms are evaluated at a `point`, in the variables of a `place`. Read `derivation` first: the parts that are linear in velocities. From them
//! follow `velocities`, the `structure` coefficients (`constants` or `brackets`) and `forces` with their `force_function`, and from these the
//! `equations`, with `resultants`. `here` holds all of it at one place, `quantity` what both derivations have; `states` draws the places, and
//! `summands` are the sizes of sums.

pub(crate) mod brackets;
pub(crate) mod constants;
pub(crate) mod derivation;
pub(crate) mod equations;
pub(crate) mod force_function;
pub(crate) mod forces;
pub(crate) mod here;
pub(crate) mod place;
pub(crate) mod point;
pub(crate) mod quantity;
pub(crate) mod resultants;
pub(crate) mod states;
pub(crate) mod structure;
pub(crate) mod summands;
pub(crate) mod velocities;
