//! Programs from crates.io that some stages of the tests need.

use std::env;
use std::path::PathBuf;
use std::process::Command;

use crate::command::{announce_and_run, cargo, succeeds};
use crate::error::Error;

/// Whether nobody is there to install what is missing.
fn in_ci() -> bool {
    env::var_os("CI").is_some_and(|value| value == "true")
}

/// A program that cargo installs.
pub(crate) struct CargoTool {
    pub(crate) name: &'static str,
    pub(crate) version: &'static str,
}

impl CargoTool {
    /// Whether it is installed; where nobody installs it, it is said how to.
    pub(crate) fn is_installed(&self) -> bool {
        let installed = succeeds(self.command().arg("--help"));
        if !installed {
            println!("{0} is not installed (cargo install --locked {0})", self.name);
        }
        installed
    }

    /// Whether it can be run: in CI it is installed if it is not there.
    pub(crate) fn is_available(&self) -> Result<bool, Error> {
        if self.is_installed() {
            return Ok(true);
        }
        if !in_ci() {
            return Ok(false);
        }
        // Unoptimised it takes a third of the time to build and is fast enough for us.
        let install = ["install", "--debug", "--locked", self.name, "--version", self.version];
        announce_and_run(&mut cargo(&install))?;
        Ok(true)
    }

    /// The program, also where cargo's own directory is not on the path.
    pub(crate) fn command(&self) -> Command {
        let home = env::var_os("CARGO_HOME").map(PathBuf::from);
        let home = home.or_else(|| Some(PathBuf::from(env::var_os("HOME")?).join(".cargo")));
        let installed = home.map(|home| home.join("bin").join(self.name)).filter(|program| program.is_file());
        installed.map_or_else(|| Command::new(self.name), Command::new)
    }
}
