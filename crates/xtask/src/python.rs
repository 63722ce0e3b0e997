//! `cargo xtask python`: the wheel of the Python package, installed where there is nothing else, with all tests of the package.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::command::{
    announce_and_run, build_as_for_tests, built_program, cargo, target_directory, text_of, workspace_root,
};
use crate::error::Error;
use crate::notices::of_dependencies;
use crate::python_environment::{Environment, remove};
use crate::setup;

/// Bytes that a wheel may have.
const LARGEST_WHEEL: u64 = 15_000_000;

/// Seconds that `import chetaev` may take, the best of several.
const SLOWEST_IMPORT: f64 = 0.15;

/// What builds the wheel.
const BUILDER: &str = "maturin>=1.9.4,<2";

/// Builds the wheel for users, installs it in a fresh environment, and runs its tests there.
///
/// # Errors
/// That of the first program that fails; [`Error::Package`] for a wheel that is too large, or takes too long to import;
/// [`Error::Unavailable`] without Python or the package index.
pub(crate) fn run() -> Result<(), Error> {
    setup::native_tools()?;
    announce_and_run(&mut cargo(&["build", "--package", "pc-cli", "--bin", "pc"]))?;
    tested(&wheel(&target_directory()?)?)
}

/// Installs a wheel in a fresh environment, and runs its tests there.
///
/// # Errors
/// As for [`run`].
pub(crate) fn tested(wheel: &Path) -> Result<(), Error> {
    let size = fs::metadata(wheel).map_err(|source| Error::of_file(wheel, source))?.len();
    println!("{}: {:.1} MB", wheel.display(), size as f64 / 1e6);
    if size > LARGEST_WHEEL {
        let wrong = format!("the wheel has {size} bytes; {LARGEST_WHEEL} are allowed");
        return Err(Error::Package { wrong });
    }
    let environment = installed(wheel)?;
    import_time(&environment)?;
    check(&environment)
}

/// The same tests of the package as the tests of the workspace have built it, for debugging: put together without a wheel.
///
/// # Errors
/// That of the first program that fails, and [`Error::Unavailable`], as there.
pub(crate) fn quick() -> Result<(), Error> {
    build_as_for_tests(&["--lib", "--bin", "pc"])?;
    let place = target_directory()?.join("python");
    let (built, requirements) = (place.join("built"), package().join("tests/requirements.txt"));
    let listed = fs::read_to_string(&requirements).map_err(|source| Error::of_file(&requirements, source))?;
    let listed: Vec<&str> = listed.lines().filter(|line| !line.starts_with('#')).collect();
    let environment = Environment::kept(&place.join("environment"), &listed)?;
    remove(&built)?;
    copy(&package().join("python/chetaev"), &built.join("chetaev"))?;
    let (library, module) =
        (target_directory()?.join("debug").join(LIBRARY), built.join("chetaev/_native.abi3.so"));
    fs::copy(&library, &module).map_err(|source| Error::of_file(&library, source))?;
    check(&environment.with_modules(&built))
}

#[cfg(target_os = "macos")]
const LIBRARY: &str = "libchetaev_native.dylib";
#[cfg(not(target_os = "macos"))]
const LIBRARY: &str = "libchetaev_native.so";

/// The wheel as users get it, with the licences of all that is in it, compiled in a target directory; its time is that of the last
/// commit, so that its bytes follow from the sources.
///
/// # Errors
/// That of the first program that fails; [`Error::Unavailable`] without Python or the package index.
pub(crate) fn wheel(target: &Path) -> Result<PathBuf, Error> {
    let wheels = target.join("python/wheels");
    remove(&wheels)?;
    let maturin = Environment::kept(&target_directory()?.join("python/maturin"), &[BUILDER])?;
    let mut last = Command::new("git");
    let time = text_of(last.args(["log", "-1", "--format=%ct"]).current_dir(workspace_root()))?;
    let notices = package().join("LICENSE-OF-DEPENDENCIES");
    fs::write(&notices, of_dependencies("pc-python")?).map_err(|source| Error::of_file(&notices, source))?;
    let build = ["build", "--release", "--locked", "--compatibility", "linux", "--out"];
    announce_and_run(
        maturin
            .program("maturin")
            .args(build)
            .arg(&wheels)
            .current_dir(package())
            .env("CARGO_TARGET_DIR", target)
            .env("SOURCE_DATE_EPOCH", time.trim()),
    )?;
    only_file(&wheels)
}

/// An environment with the wheel and what it needs, where its quick start has run, and with what its tests need.
fn installed(wheel: &Path) -> Result<Environment, Error> {
    let environment = Environment::fresh(&target_directory()?.join("python/fresh"))?;
    environment.install(&[wheel])?;
    announce_and_run(environment.alone("python").arg("tests/quick_start.py").current_dir(package()))?;
    environment.install(&["-r".as_ref(), package().join("tests/requirements.txt").as_os_str()])?;
    Ok(environment)
}

/// Tests, types, and that the stubs say what there is.
fn check(environment: &Environment) -> Result<(), Error> {
    let pc = built_program()?;
    let of_package = |program: &str| {
        let mut command = environment.alone(program);
        command.current_dir(package()).env("PC_PROGRAM", &pc).env("PYTHONDONTWRITEBYTECODE", "1");
        command
    };
    let cache = target_directory()?.join("python/cache");
    announce_and_run(of_package("python").args(["-m", "pytest", "-p", "no:cacheprovider", "tests"]))?;
    let types = ["-m", "mypy", "--config-file", "pyproject.toml", "--cache-dir"];
    announce_and_run(of_package("python").args(types).arg(&cache).args(["python/chetaev"]))?;
    let stubs = ["chetaev._native", "--mypy-config-file", "pyproject.toml"];
    announce_and_run(of_package("stubtest").args(stubs))
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

fn package() -> PathBuf {
    workspace_root().join("crates/pc-python")
}

/// The files of a directory and of those in it, without what Python has compiled.
fn copy(from: &Path, to: &Path) -> Result<(), Error> {
    fs::create_dir_all(to).map_err(|source| Error::of_file(to, source))?;
    for entry in fs::read_dir(from).map_err(|source| Error::of_file(from, source))? {
        let path = entry.map_err(|source| Error::of_file(from, source))?.path();
        let Some(name) = path.file_name().filter(|name| *name != "__pycache__") else { continue };
        if path.is_dir() {
            copy(&path, &to.join(name))?;
        } else {
            fs::copy(&path, to.join(name)).map_err(|source| Error::of_file(&path, source))?;
        }
    }
    Ok(())
}

fn only_file(directory: &Path) -> Result<PathBuf, Error> {
    let entries = fs::read_dir(directory).map_err(|source| Error::of_file(directory, source))?;
    let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    match (files.pop(), files.is_empty()) {
        (Some(file), true) => Ok(file),
        _ => Err(Error::Package { wrong: format!("there is not one wheel in {}", directory.display()) }),
    }
}
