//! Tests of constraints on velocities, one module a topic.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod combinations;
mod constraints;
mod n_trailer;
mod nonlinear;
