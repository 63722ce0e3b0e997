//! `bench start`: a whole run of the program `pc`, start to exit.

use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use crate::error::Error;
use crate::measure::Times;
use crate::report::{Report, target_directory, triple};

const RUNS: usize = 30;
/// What is timed: loading the program alone, and a derivation with an integration that is over at once.
const COMMAND_LINES: [&[&str]; 2] =
    [&["--version"], &["run", "heavy-top-lagrange", "--rows", "2", "--t-end", "1e-6"]];

/// Times the program.
///
/// # Errors
/// [`Error::Missing`] where there is no program and none can be built.
pub(crate) fn run(report: &mut Report) -> Result<(), Error> {
    let program = program()?;
    report
        .line(format!("ms from start to exit, {RUNS} runs of each command in turns, output thrown away.\n"));
    let mut times = [Times::default(), Times::default()];
    for _ in 0..RUNS {
        for (arguments, times) in COMMAND_LINES.iter().zip(&mut times) {
            times.0.push(once(&program, arguments)?);
        }
    }
    report.columns(&["command", "min / p10 / median"]);
    for (arguments, times) in COMMAND_LINES.iter().zip(&times) {
        report.row(&[format!("`pc {}`", arguments.join(" ")), triple(times, 2)]);
    }
    Ok(())
}

fn once(program: &Path, arguments: &[&str]) -> Result<f64, Error> {
    let name = || format!("{} {}", program.display(), arguments.join(" "));
    let mut command = Command::new(program);
    command.args(arguments).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
    let start = Instant::now();
    let output = command.output().map_err(|source| Error::Start { command: name(), source })?;
    let elapsed = start.elapsed();
    if !output.status.success() {
        let message = String::from_utf8_lossy(&output.stderr).trim().to_owned();
        return Err(Error::Failed { command: name(), message: format!("{}; {message}", output.status) });
    }
    Ok(elapsed.as_secs_f64() * 1e3)
}

/// The program as the sources now are, built beside us; the one that is there if cargo is not.
fn program() -> Result<PathBuf, Error> {
    let target = target_directory();
    let path = target.join("release").join(format!("pc{}", env::consts::EXE_SUFFIX));
    let cause = match build(&target) {
        Ok(()) => "`cargo build` made no such file".to_owned(),
        Err(cause) => cause,
    };
    if path.is_file() { Ok(path) } else { Err(Error::Missing { path, cause }) }
}

fn build(target: &Path) -> Result<(), String> {
    let mut command = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(["build", "--release", "--quiet", "-p", "pc-cli", "--target-dir"]).arg(target);
    command.current_dir(env!("CARGO_MANIFEST_DIR"));
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("`cargo build -p pc-cli`: {status}")),
        Err(error) => Err(format!("cargo: {error}")),
    }
}
