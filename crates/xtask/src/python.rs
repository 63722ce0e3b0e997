//! `cargo xtask python`: the wheel of the Python package, installed where there is nothing else, with all tests of the package.

use std::env;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::command::{announce_and_run, cargo, succeeds, target_directory, workspace_root};
use crate::error::Error;
use crate::setup;
use crate::tools::Tool;

/// Bytes that a wheel may have.
const LARGEST_WHEEL: u64 = 15_000_000;

/// Seconds that `import chetaev` may take, the best of several.
const SLOWEST_IMPORT: f64 = 0.15;

/// A Python from 3.10 on that can make environments.
const SUITABLE: &str = "import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 10))";

/// Builds the wheel, installs it in a fresh environment, and runs its tests there.
///
/// # Errors
/// That of the first program that fails; [`Error::Package`] for a wheel that is too large, or takes too long to import.
pub(crate) fn run() -> Result<(), Error> {
    setup::native_tools()?;
    let python = python()?;
    let place = target_directory()?.join("python");
    let (wheels, maturin) = (place.join("wheels"), place.join("maturin"));
    remove(&wheels)?;
    let builder = Environment::at(&maturin, &python)?;
    builder.install(["maturin>=1.9.4,<2"])?;
    let build = ["build", "--release", "--locked", "--compatibility", "linux", "--out"];
    announce_and_run(
        builder
            .program("maturin")
            .args(build)
            .arg(&wheels)
            .current_dir(package())
            .env("CARGO_TARGET_DIR", target_directory()?),
    )?;
    let wheel = only_file(&wheels)?;
    let size = fs::metadata(&wheel).map_err(|source| file(&wheel, source))?.len();
    println!("{}: {:.1} MB", wheel.display(), size as f64 / 1e6);
    if size > LARGEST_WHEEL {
        return Err(Error::Package {
            wrong: format!("the wheel has {size} bytes; {LARGEST_WHEEL} are allowed"),
        });
    }
    let fresh = place.join("fresh");
    remove(&fresh)?;
    let environment = Environment::at(&fresh, &python)?;
    // Without anything to build with: what is not in a wheel cannot be installed.
    let install =
        ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--only-binary", ":all:"];
    announce_and_run(environment.python().args(install).arg(&wheel).env("PATH", fresh.join("bin")))?;
    import_time(&environment)?;
    environment.install(["-r".into(), package().join("tests/requirements.txt").into_os_string()])?;
    announce_and_run(&mut cargo(&["build", "--workspace", "--bin", "pc"]))?;
    check(&environment, None)
}

/// The same tests on what is built for debugging, without a wheel.
///
/// # Errors
/// That of the first program that fails.
pub(crate) fn quick() -> Result<(), Error> {
    let python = python()?;
    let place = target_directory()?.join("python");
    announce_and_run(&mut cargo(&["build", "--workspace", "--lib", "--bin", "pc"]))?;
    let (source, built) = (package().join("python/chetaev"), place.join("built"));
    remove(&built)?;
    copy(&source, &built.join("chetaev"))?;
    let library = target_directory()?.join("debug").join(LIBRARY);
    let module = built.join("chetaev/_native.abi3.so");
    fs::copy(&library, &module).map_err(|source| file(&library, source))?;
    let environment = Environment::at(&place.join("environment"), &python)?;
    environment.install(["-r".into(), package().join("tests/requirements.txt").into_os_string()])?;
    check(&environment, Some(&built))
}

#[cfg(target_os = "macos")]
const LIBRARY: &str = "libchetaev_native.dylib";
#[cfg(not(target_os = "macos"))]
const LIBRARY: &str = "libchetaev_native.so";

/// Tests, types, and that the stubs say what there is.
fn check(environment: &Environment, path: Option<&Path>) -> Result<(), Error> {
    let pc = target_directory()?.join("debug/pc");
    let of_package = |mut command: Command| {
        command.current_dir(package()).env("PC_PROGRAM", &pc).env("PYTHONDONTWRITEBYTECODE", "1");
        if let Some(path) = path {
            command.env("PYTHONPATH", path).env("MYPYPATH", path);
        }
        command
    };
    let cache = target_directory()?.join("python/cache");
    let tests = ["-m", "pytest", "-p", "no:cacheprovider", "tests"];
    announce_and_run(of_package(environment.python()).args(tests))?;
    let types = ["-m", "mypy", "--config-file", "pyproject.toml", "--cache-dir"];
    announce_and_run(of_package(environment.python()).args(types).arg(&cache).args(["python/chetaev"]))?;
    let stubs = ["chetaev._native", "--mypy-config-file", "pyproject.toml"];
    announce_and_run(of_package(environment.program("stubtest")).args(stubs))
}

/// That the package is imported at once.
fn import_time(environment: &Environment) -> Result<(), Error> {
    let program = "import subprocess, sys, time\n\
                   def once():\n    \
                       code = 'import time; a = time.perf_counter(); import chetaev; print(time.perf_counter() - a)'\n    \
                       return float(subprocess.run([sys.executable, '-c', code], capture_output=True, check=True).stdout)\n\
                   print(min(once() for _ in range(7)))";
    let mut command = environment.python();
    let output = command.args(["-c", program]).output();
    let output = output.map_err(|source| Error::Start { program: "python".to_owned(), source })?;
    let seconds = String::from_utf8_lossy(&output.stdout).trim().parse::<f64>().unwrap_or(f64::INFINITY);
    println!("import chetaev: {seconds:.3} s");
    if seconds > SLOWEST_IMPORT {
        let wrong = format!("`import chetaev` takes {seconds} s; {SLOWEST_IMPORT} s are allowed");
        return Err(Error::Package { wrong });
    }
    Ok(())
}

/// A virtual environment.
struct Environment {
    place: PathBuf,
}

impl Environment {
    /// That at a place, made where there is none.
    fn at(place: &Path, python: &str) -> Result<Environment, Error> {
        if !place.join("bin/python").exists() {
            announce_and_run(Command::new(python).args(["-m", "venv"]).arg(place))?;
        }
        Ok(Environment { place: place.to_owned() })
    }

    fn program(&self, name: &str) -> Command {
        let mut command = Command::new(self.place.join("bin").join(name));
        // maturin looks for it, and finds Python by it.
        command.env("VIRTUAL_ENV", &self.place).env_remove("PYTHONPATH").env_remove("PYTHONHOME");
        command
    }

    fn python(&self) -> Command {
        self.program("python")
    }

    fn install<A: Into<OsString>>(&self, packages: impl IntoIterator<Item = A>) -> Result<(), Error> {
        let install = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check"];
        announce_and_run(self.python().args(install).args(packages.into_iter().map(Into::into)))
    }
}

/// The Python to be used: that which `PYTHON` names, else the first that will do; installed where we may.
fn python() -> Result<String, Error> {
    if let Some(found) = suitable() {
        return Ok(found);
    }
    setup::python()?;
    suitable().ok_or_else(|| Error::StillMissing { tools: vec![Tool::Python.name()] })
}

/// Whether there is one.
fn suitable() -> Option<String> {
    let named = env::var("PYTHON").ok();
    let known = ["python3", "python3.13", "python3.12", "python3.11", "python3.10"].map(str::to_owned);
    named.into_iter().chain(known).find(|python| succeeds(Command::new(python).args(["-c", SUITABLE])))
}

fn package() -> PathBuf {
    workspace_root().join("crates/pc-python")
}

fn file(path: &Path, source: std::io::Error) -> Error {
    Error::File { path: path.display().to_string(), source }
}

fn remove(directory: &Path) -> Result<(), Error> {
    match fs::remove_dir_all(directory) {
        Err(source) if source.kind() != std::io::ErrorKind::NotFound => Err(file(directory, source)),
        _ => Ok(()),
    }
}

/// The files of a directory without directories in it.
fn copy(from: &Path, to: &Path) -> Result<(), Error> {
    fs::create_dir_all(to).map_err(|source| file(to, source))?;
    for entry in fs::read_dir(from).map_err(|source| file(from, source))? {
        let path = entry.map_err(|source| file(from, source))?.path();
        if let Some(name) = path.file_name().filter(|_| path.is_file()) {
            fs::copy(&path, to.join(name)).map_err(|source| file(&path, source))?;
        }
    }
    Ok(())
}

fn only_file(directory: &Path) -> Result<PathBuf, Error> {
    let entries = fs::read_dir(directory).map_err(|source| file(directory, source))?;
    let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    match (files.pop(), files.is_empty()) {
        (Some(file), true) => Ok(file),
        _ => Err(Error::Package { wrong: format!("there is not one wheel in {}", directory.display()) }),
    }
}
