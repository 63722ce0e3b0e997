//! `cargo xtask demo`: the main demonstration.

use crate::command::{announce_and_run, cargo};
use crate::error::Error;
use crate::setup;

/// Builds `pc` and runs the demonstration, which prints and writes into `target/demo`.
pub(crate) fn run() -> Result<(), Error> {
    setup::native_tools()?;
    announce_and_run(&mut cargo(&["build", "--release", "-p", "pc-cli"]))?;
    announce_and_run(&mut cargo(&["run", "--release", "-p", "pc-cli", "--example", "demo"]))
}
