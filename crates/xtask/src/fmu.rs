//! `cargo xtask fmu`: FMUs of models, validated and simulated by FMPy, against the numbers of the program `pc`.

use std::fs;
use std::process::Command;

use crate::command::{announce_and_run, cargo, target_directory, workspace_root};
use crate::error::Error;
use crate::setup;

/// The importer, and the packages that it needs.
const PACKAGES: [&str; 1] = ["fmpy>=0.3.22,<0.4"];

/// Builds `pc`, makes a virtual environment in target/fmu unless there is one, and runs `tests/fmu/simulate.py` in it.
///
/// # Errors
/// That of the first program that is wrong; without `python3` that it cannot be started.
pub(crate) fn run() -> Result<(), Error> {
    setup::native_tools_and_cpp()?;
    announce_and_run(&mut cargo(&["build", "--package", "pc-cli", "--bin", "pc"]))?;
    let (target, place) = (target_directory()?, target_directory()?.join("fmu"));
    let python = place.join("venv/bin/python");
    // Whatever stands in the way of one, the message says it.
    fs::create_dir_all(&place).map_err(|source| Error::File { path: place.display().to_string(), source })?;
    if !python.exists() {
        announce_and_run(Command::new("python3").args(["-m", "venv"]).arg(place.join("venv")))?;
    }
    announce_and_run(Command::new(&python).args(["-m", "pip", "install", "--quiet"]).args(PACKAGES))?;
    let mut simulate = Command::new(&python);
    simulate.current_dir(workspace_root()).arg("tests/fmu/simulate.py");
    announce_and_run(simulate.arg(target.join("debug/pc")).arg(&place))
}
