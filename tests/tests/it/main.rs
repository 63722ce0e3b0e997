//! End-to-end tests over all crates, one module a topic.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod backends;
mod bicycle;
mod charts;
mod classics;
mod derived_equations;
mod emission;
mod energy_rate;
mod event_sensitivities;
mod forms_agree;
mod frames;
mod free_forms;
mod holonomic;
mod joints;
mod kept_costs;
mod malformed;
mod measures;
mod mechanisms;
mod model_format;
mod nonlinear_constraints;
mod printed_pages;
mod projection;
mod random_models;
mod redundant;
mod reference_states;
mod references;
mod rolling_stability;
mod schema;
mod sensitivities;
mod taylor_references;
mod theory;
