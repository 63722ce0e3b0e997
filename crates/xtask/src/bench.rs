//! `cargo xtask bench`: the benchmarks.

use crate::command::{announce_and_run, cargo};
use crate::error::Error;
use crate::setup;

/// Runs the benchmark program of `pc-tests` with the arguments as they are.
pub(crate) fn run(arguments: &[String]) -> Result<(), Error> {
    setup::native_tools()?;
    announce_and_run(cargo(&["run", "--release", "-p", "pc-tests", "--bin", "bench", "--"]).args(arguments))
}
