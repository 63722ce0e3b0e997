//! Tests of the second derivation, one module a topic.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod builtin;
mod energies;
mod forces;
mod large;
mod momenta;
mod resultants;
mod sizes;
