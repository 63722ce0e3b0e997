//! `cargo xtask demo`: the main demonstration.

use crate::command::{announce_and_run, cargo};
use crate::error::Error;
use crate::setup;

/// Builds and runs the demonstration, which prints and writes into `target/demo`.
pub(crate) fn run() -> Result<(), Error> {
    setup::native_tools()?;
    println!("A first build takes a few minutes: SUNDIALS and a code generator are compiled.");
    // Not in release: what is built here serves `cargo xtask test` too, and the first picture comes sooner.
    announce_and_run(&mut cargo(&["run", "-p", "pc-cli", "--example", "demo"]))
}
