//! Tests of the program `pc` as a user starts it, one module a topic.

#![expect(clippy::unwrap_used, unsafe_code, reason = "a test that cannot go on fails")]

mod bench;
mod book;
mod brackets;
mod browser;
mod check;
mod checkpoint;
mod command_line_page;
mod compare;
mod constraints;
mod each_model;
mod equations;
mod events;
mod files;
mod followed;
mod forms;
mod help;
mod hidden_zeros;
mod hostile_names;
mod import;
mod jumping_rates;
mod kept_on_constraints;
mod large;
mod library;
mod linear;
mod long_equations;
mod methods;
mod models;
mod new;
mod numbers;
mod options_of_run;
mod patience;
mod piped;
mod plots;
mod print;
mod program;
mod project;
#[path = "../../../../tests/src/classical/random.rs"]
mod random;
mod report;
mod rolling_and_slipping;
mod said_of_runs;
mod sensitivities;
mod shards;
mod standard_streams;
mod states_and_inputs;
mod sweep;
mod sweep_of;
mod sweeps;
mod theory;
mod time_limits;
mod unit_quaternions;
mod units;
mod verdicts;
