//! Tests of integrations, one module a topic.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod adjoint;
mod boxed;
mod breaks;
mod chain;
mod checkpoint;
mod closures;
#[path = "../../src/dop853/coefficients.rs"]
mod coefficients;
mod deadline;
mod dense;
mod dop853;
mod dop853_coefficients;
mod ensemble;
mod estimate;
mod event_cascades;
mod event_checkpoints;
mod event_edges;
mod event_failures;
mod event_passages;
mod event_steps;
mod events;
mod failures;
mod far_times;
mod fields;
mod forcing;
mod forwarding;
mod gradients;
mod hybrid_motions;
mod inequalities;
mod input;
mod integrals;
mod kept_checkpoints;
mod lanes;
mod linear;
mod linear_failures;
mod lyapunov;
#[path = "common/chain.rs"]
mod model;
mod motions;
mod narrow_places;
mod offers;
mod outputs;
mod panics;
mod pieces;
mod program_events;
mod projection;
mod runge_kutta;
mod sensitivities;
mod sensitivities_with_events;
mod sensitivity_failures;
mod stiff;
mod surfaces;
mod taylor_method;
