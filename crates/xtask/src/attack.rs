//! `cargo xtask attack`: the program under hostile models, files and kills.

use std::env;
use std::path::PathBuf;

use crate::command::{announce_and_run, cargo};
use crate::error::Error;
use crate::setup;

/// The attack with the arguments as they are, on the optimised program.
pub(crate) fn run(arguments: &[String]) -> Result<(), Error> {
    setup::native_tools()?;
    announce_and_run(&mut cargo(&["build", "--release", "--workspace", "--bin", "pc", "--bin", "attack"]))?;
    announce_and_run(std::process::Command::new(built("release")).args(arguments))
}

/// Half a minute of it, on the program of the tests.
pub(crate) fn quick() -> Result<(), Error> {
    announce_and_run(&mut cargo(&["build", "--workspace", "--bin", "pc", "--bin", "attack"]))?;
    announce_and_run(std::process::Command::new(built("debug")).args(["--minutes", "0.5"]))
}

fn built(profile: &str) -> PathBuf {
    let target = env::var_os("CARGO_TARGET_DIR").map_or_else(|| PathBuf::from("target"), PathBuf::from);
    target.join(profile).join("attack")
}
