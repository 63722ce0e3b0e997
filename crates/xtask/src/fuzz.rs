//! `cargo xtask fuzz`: random models against independent computations, and random calls of the C library.

use std::process::Command;

use crate::command::{announce_and_run, cargo, target_directory};
use crate::error::Error;
use crate::{fuzz_c, setup};

/// Runs the differential tester of `pc-tests` with the arguments as they are, beside the program that it calls; or, where the first
/// one is `c`, the calls.
pub(crate) fn run(arguments: &[String]) -> Result<(), Error> {
    if let [first, rest @ ..] = arguments
        && first == "c"
    {
        return fuzz_c::run(rest);
    }
    setup::native_tools()?;
    let packages = ["-p", "pc-tests", "-p", "pc-cli"];
    announce_and_run(cargo(&["build", "--release", "--bin", "fuzz", "--bin", "pc"]).args(packages))?;
    announce_and_run(Command::new(target_directory()?.join("release/fuzz")).args(arguments))
}
