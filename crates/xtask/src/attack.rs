//! `cargo xtask attack`: the program under hostile models, files and kills.

use std::path::PathBuf;
use std::process::Command;

use crate::command::{announce_and_run, build_as_for_tests, cargo, target_directory};
use crate::error::Error;
use crate::setup;

/// The attack with the arguments as they are, on the optimised program.
pub(crate) fn run(arguments: &[String]) -> Result<(), Error> {
    setup::native_tools()?;
    announce_and_run(&mut cargo(&["build", "--release", "--workspace", "--bin", "pc", "--bin", "attack"]))?;
    announce_and_run(Command::new(built("release")?).args(arguments))
}

/// Some rounds of it, on the program of the tests: half a minute on two cores.
pub(crate) fn quick() -> Result<(), Error> {
    build_as_for_tests(&["--bin", "pc", "--bin", "attack"])?;
    announce_and_run(Command::new(built("debug")?).args(["--count", "4"]))
}

fn built(profile: &str) -> Result<PathBuf, Error> {
    Ok(target_directory()?.join(profile).join("attack"))
}
