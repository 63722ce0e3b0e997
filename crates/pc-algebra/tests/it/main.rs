//! Tests of the frames, brackets, algebras and groups of `pc-algebra`, one module a topic.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod algebras;
mod constant_brackets;
mod followers;
mod frames;
mod group_accuracy;
mod group_laws;
mod hidden_zeros;
mod units;
