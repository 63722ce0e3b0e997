//! `cargo xtask fmu`: FMUs of models, validated and simulated by FMPy, against the numbers of the program `pc`.

use crate::command::{announce_and_run, built_program, cargo, target_directory, workspace_root};
use crate::error::Error;
use crate::python_environment::Environment;
use crate::setup;

/// The importer, which brings what it needs.
const PACKAGES: [&str; 1] = ["fmpy>=0.3.22,<0.4"];

/// Builds `pc` and runs `tests/fmu/simulate.py` with it.
///
/// # Errors
/// That of the first program that is wrong; [`Error::Unavailable`] without Python or the package index.
pub(crate) fn run() -> Result<(), Error> {
    setup::native_tools()?;
    announce_and_run(&mut cargo(&["build", "--package", "pc-cli", "--bin", "pc"]))?;
    quick()
}

/// The same with the program that the tests have built.
///
/// # Errors
/// As there.
pub(crate) fn quick() -> Result<(), Error> {
    let place = target_directory()?.join("fmu");
    let environment = Environment::kept(&place.join("environment"), &PACKAGES)?;
    let mut simulate = environment.python();
    simulate.current_dir(workspace_root()).arg("tests/fmu/simulate.py");
    announce_and_run(simulate.arg(built_program()?).arg(&place))
}
