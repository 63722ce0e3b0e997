//! Tests of the C interface, called from Rust as from C, one module a topic.

#![expect(clippy::unwrap_used, unsafe_code, reason = "a test that cannot go on fails")]

#[macro_use]
mod common;
mod abi;
mod bracket;
mod builder;
mod builder_keys;
mod checkpoint;
mod code;
mod ensemble;
mod events;
mod force_functions;
mod forces;
mod forms;
#[path = "../../examples/header/generate.rs"]
mod generate;
mod gradient;
mod header;
mod hold_start;
#[path = "../../examples/header/interface.rs"]
mod interface;
mod kinematics;
mod laws;
mod limits;
mod linearization;
mod misuse;
mod monitor;
mod numbers;
mod own_events;
mod owned_observer;
mod parts;
mod poses;
mod refused;
mod sensitivities;
mod slopes;
mod stacks;
mod states_and_inputs;
mod theory;
mod threads;
mod verify;
