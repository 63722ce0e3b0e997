//! End-to-end tests over all crates, one module a topic. What is claimed of every built-in model is in the program `models`.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod bicycle;
mod charts;
mod classics;
#[path = "../common/divergence.rs"]
mod divergence;
mod emission;
mod energy_rate;
#[path = "../common/estimated.rs"]
mod estimated;
mod estimates;
mod event_sensitivities;
mod frames;
mod free_forms;
mod holonomic;
mod instructions;
mod integrable_systems;
mod joints;
mod malformed;
mod measures;
mod mechanisms;
mod model_format;
mod nonlinear_constraints;
mod printed_pages;
mod projection;
mod random_models;
#[path = "../common/read_back.rs"]
mod read_back;
mod redundant;
mod references;
mod rolling_stability;
mod schema;
mod sensitivities;
mod tables_at_surfaces;
mod taylor_references;
