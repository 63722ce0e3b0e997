//! Tests of what `pc-analysis` says of motions, one module a topic.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod bracket;
mod canonical_variables;
mod casimirs;
#[path = "../../../pc-mech/tests/it/common/mod.rs"]
mod common;
mod dirac;
mod equilibria;
mod field_of_parameters;
mod hamilton_jacobi;
mod integrals;
mod jacobi_motion;
mod levels;
mod linearization;
mod poissons_theorem;
mod polynomial_integrals;
mod proposed_action;
mod random_linear;
mod rates;
mod reducing_multiplier;
mod routhian;
mod steady;
mod steady_motions;
mod structure;
mod variation;
