//! Tests of text models, one module a topic.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod bodies;
mod constraints;
mod definitions;
mod definitions_under_constraints;
mod document;
mod drawing;
mod events;
mod functions;
mod inputs;
mod jumps;
mod kinematics;
mod large;
mod momenta;
mod parameters;
#[path = "../../../../tests/src/classical/random.rs"]
mod random;
mod reactions;
mod resultants;
mod stacks;
mod states;
mod tags;
mod velocity_maps;
#[path = "../../../../tests/src/verified.rs"]
mod verified;
