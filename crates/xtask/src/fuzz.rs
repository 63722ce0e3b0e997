//! `cargo xtask fuzz`: random models against independent computations.

use crate::command::{announce_and_run, cargo};
use crate::error::Error;
use crate::setup;

/// Runs the differential tester of `pc-tests` with the arguments as they are.
pub(crate) fn run(arguments: &[String]) -> Result<(), Error> {
    setup::native_tools()?;
    announce_and_run(cargo(&["run", "--release", "-p", "pc-tests", "--bin", "fuzz", "--"]).args(arguments))
}
