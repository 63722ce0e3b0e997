//! `cargo xtask fuzz`: random models against independent computations.

use std::process::Command;

use crate::command::{announce_and_run, cargo, target_directory};
use crate::error::Error;
use crate::setup;

/// Runs the differential tester of `pc-tests` with the arguments as they are, beside the program that it calls.
pub(crate) fn run(arguments: &[String]) -> Result<(), Error> {
    setup::native_tools()?;
    let packages = ["-p", "pc-tests", "-p", "pc-cli"];
    announce_and_run(cargo(&["build", "--release", "--bin", "fuzz", "--bin", "pc"]).args(packages))?;
    announce_and_run(Command::new(target_directory()?.join("release/fuzz")).args(arguments))
}
