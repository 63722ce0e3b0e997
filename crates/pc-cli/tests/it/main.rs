//! Tests of the program `pc` as a user starts it, one module a topic.

#![expect(clippy::unwrap_used, unsafe_code, reason = "a test that cannot go on fails")]

mod bench;
mod book;
mod brackets;
mod browser;
mod cache;
mod change_points;
mod check;
mod checkpoint;
mod command_line_page;
mod compare;
mod constraints;
#[cfg(unix)]
mod devtools;
mod dry_friction;
mod each_model;
mod equations;
mod estimate;
mod events;
mod files;
mod followed;
mod forms;
mod help;
mod hidden_zeros;
mod hostile_names;
mod import;
mod interrupted;
mod joint_stops;
mod jumping_rates;
mod kept_on_constraints;
mod large;
mod library;
mod linear;
mod live;
#[cfg(unix)]
mod live_in_a_browser;
mod long_equations;
mod methods;
mod models;
mod named_units;
mod new;
mod numbers;
mod oblique_axes;
mod options_of_run;
mod patience;
mod piped;
mod plots;
mod prescribed_motion;
mod print;
mod program;
mod project;
#[path = "../../../../tests/src/classical/random.rs"]
mod random;
mod read_and_written;
mod report;
mod rolling_and_slipping;
mod said_of_runs;
mod second_routes;
mod sensitivities;
mod shards;
mod standard_streams;
mod states_and_inputs;
mod statics;
mod sweep;
mod sweep_of;
mod sweeps;
mod tables;
mod theory;
mod time_limits;
mod tolerances;
mod undetermined;
mod unit_quaternions;
mod units;
mod verdicts;
mod zoo;
