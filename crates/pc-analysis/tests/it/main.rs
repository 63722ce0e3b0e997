//! Tests of what `pc-analysis` says of motions, one module a topic.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod bracket;
mod casimirs;
#[path = "../../../pc-mech/tests/it/common/mod.rs"]
mod common;
mod equilibria;
mod hamilton_jacobi;
mod integrals;
mod linearization;
mod polynomial_integrals;
mod proposed_action;
mod rates;
mod reducing_multiplier;
mod routhian;
mod steady;
mod steady_motions;
mod structure;
mod variation;
