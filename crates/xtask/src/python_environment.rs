//! Virtual environments of Python, with packages from the package index.

use std::env;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::command::{announce_and_run, succeeds};
use crate::error::Error;
use crate::setup;

/// A Python from 3.10 on that can make environments.
const SUITABLE: &str = "import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 10))";

/// What is asked of the package index to see whether it answers: a package without dependencies, of some kilobytes.
const PROBE: &str = "iniconfig";

/// A virtual environment.
pub(crate) struct Environment {
    place: PathBuf,
    /// Where modules are looked for before those that are installed.
    modules: Option<PathBuf>,
}

impl Environment {
    /// A new one in place of whatever is there.
    ///
    /// # Errors
    /// [`Error::Unavailable`] without a suitable Python.
    pub(crate) fn fresh(place: &Path) -> Result<Environment, Error> {
        remove(place)?;
        announce_and_run(Command::new(python()?).args(["-m", "venv"]).arg(place))?;
        Ok(Environment { place: place.to_owned(), modules: None })
    }

    /// One with these packages, that of the last time if it has the same.
    ///
    /// # Errors
    /// As for [`fresh`](Environment::fresh) and [`install`](Environment::install).
    pub(crate) fn kept(place: &Path, packages: &[&str]) -> Result<Environment, Error> {
        let (list, wanted) = (place.join("packages"), packages.join("\n"));
        if fs::read_to_string(&list).is_ok_and(|installed| installed == wanted) {
            return Ok(Environment { place: place.to_owned(), modules: None });
        }
        let environment = Environment::fresh(place)?;
        environment.install(packages)?;
        fs::write(&list, wanted).map_err(|source| Error::of_file(&list, source))?;
        Ok(environment)
    }

    /// The same with modules that are not installed.
    pub(crate) fn with_modules(self, place: &Path) -> Environment {
        Environment { modules: Some(place.to_owned()), ..self }
    }

    /// A program of the environment.
    pub(crate) fn program(&self, name: &str) -> Command {
        let mut command = Command::new(self.programs().join(name));
        // maturin looks for it, and finds Python by it.
        command.env("VIRTUAL_ENV", &self.place).env_remove("PYTHONPATH").env_remove("PYTHONHOME");
        if let Some(modules) = &self.modules {
            command.env("PYTHONPATH", modules).env("MYPYPATH", modules);
        }
        command
    }

    /// Its Python.
    pub(crate) fn python(&self) -> Command {
        self.program("python")
    }

    /// A program that finds no other programs than those of the environment: nothing to compile or to build with.
    pub(crate) fn alone(&self, name: &str) -> Command {
        let mut command = self.program(name);
        command.env("PATH", self.programs());
        command
    }

    fn programs(&self) -> PathBuf {
        self.place.join("bin")
    }

    /// Installs what these arguments of `pip install` name, from wheels: nothing is built.
    ///
    /// # Errors
    /// [`Error::Unavailable`] where the package index does not answer, else the failure of pip.
    pub(crate) fn install<A: Into<OsString> + Clone>(&self, packages: &[A]) -> Result<(), Error> {
        let install =
            ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--only-binary", ":all:"];
        let packages = packages.iter().cloned().map(Into::into);
        let outcome = announce_and_run(self.alone("python").args(install).args(packages));
        if outcome.is_err() && !self.reaches_the_index() {
            return Err(Error::Unavailable {
                what: "the package index of Python does not answer".to_owned(),
            });
        }
        outcome
    }

    fn reaches_the_index(&self) -> bool {
        let download = ["-m", "pip", "download", "--no-deps", "--no-cache-dir", "--timeout", "20", "--dest"];
        succeeds(self.python().args(download).arg(self.place.join("probe")).arg(PROBE))
    }
}

/// The Python to be used: that which `PYTHON` names, else the first that will do; installed where we may.
fn python() -> Result<String, Error> {
    if let Some(found) = suitable() {
        return Ok(found);
    }
    let missing =
        |remedy: String| Error::Unavailable { what: format!("no Python from 3.10 on with venv{remedy}") };
    match setup::python() {
        Err(Error::Missing { remedy, .. }) => Err(missing(format!("; {remedy}"))),
        Err(error) => Err(error),
        Ok(()) => suitable().ok_or_else(|| missing(String::new())),
    }
}

fn suitable() -> Option<String> {
    let named = env::var("PYTHON").ok();
    let known = ["python3", "python3.13", "python3.12", "python3.11", "python3.10"].map(str::to_owned);
    named.into_iter().chain(known).find(|python| succeeds(Command::new(python).args(["-c", SUITABLE])))
}

/// Removes a directory, if there is one.
///
/// # Errors
/// [`Error::File`]
pub(crate) fn remove(directory: &Path) -> Result<(), Error> {
    match fs::remove_dir_all(directory) {
        Err(source) if source.kind() != std::io::ErrorKind::NotFound => {
            Err(Error::of_file(directory, source))
        }
        _ => Ok(()),
    }
}
