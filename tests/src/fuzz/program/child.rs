//! A call of the program, with an end.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// A command takes some hundredths of a second; one that takes so long has lost its way.
const LIMIT: Duration = Duration::from_secs(30);

/// How often it is asked whether it has ended.
const PAUSE: Duration = Duration::from_millis(2);

/// The exit code of a panic.
const PANIC: i32 = 101;

/// Where the program is.
#[derive(Clone, Debug)]
pub struct Program(PathBuf);

/// How a call ended.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Outcome {
    /// By exit code 0, with its standard output.
    Done(String),
    /// By another exit code, with what was said, from where the program says `pc:`.
    Refused(i32, String),
    /// By a panic or a signal.
    Crashed(String),
    /// Not before the limit.
    Late,
}

impl Program {
    /// The program beside the executable that runs, or in a directory above it, as tests are below it.
    pub fn near_this_executable() -> Option<Program> {
        let executable = std::env::current_exe().ok()?;
        let name = format!("pc{}", std::env::consts::EXE_SUFFIX);
        let places = executable.ancestors().skip(1).take(3).map(|place| place.join(&name));
        places.into_iter().find(|path| path.is_file()).map(Program)
    }

    /// No program: where nothing is called.
    #[cfg(test)]
    pub(super) fn nowhere() -> Program {
        Program(PathBuf::new())
    }

    /// Calls the program in a directory, where its output is kept meanwhile: a pipe that nobody reads would fill.
    pub(super) fn call(&self, directory: &Path, arguments: &[String]) -> Outcome {
        match self.ended(directory, arguments) {
            Ok((status, out, errors)) => status.map_or(Outcome::Late, |status| outcome(status, out, errors)),
            Err(error) => Outcome::Refused(-1, format!("the program cannot be called: {error}")),
        }
    }

    fn ended(
        &self,
        directory: &Path,
        arguments: &[String],
    ) -> io::Result<(Option<ExitStatus>, String, String)> {
        let (out, errors) = (directory.join("out"), directory.join("errors"));
        let child = Command::new(&self.0)
            .args(arguments)
            .current_dir(directory)
            .stdin(Stdio::null())
            .stdout(File::create(&out)?)
            .stderr(File::create(&errors)?)
            .spawn()?;
        let status = waited(child)?;
        let read = |path: &Path| fs::read(path).map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
        Ok((status, read(&out)?, read(&errors)?))
    }
}

/// The status of a child, or none where it had to be ended.
fn waited(mut child: Child) -> io::Result<Option<ExitStatus>> {
    let begin = Instant::now();
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(Some(status));
        }
        if begin.elapsed() > LIMIT {
            child.kill()?;
            child.wait()?;
            return Ok(None);
        }
        thread::sleep(PAUSE);
    }
}

fn outcome(status: ExitStatus, out: String, errors: String) -> Outcome {
    match status.code() {
        Some(0) => Outcome::Done(out),
        None | Some(PANIC) => Outcome::Crashed(format!("{status}: {errors}")),
        Some(code) => {
            let lines = errors.lines().skip_while(|line| !line.starts_with("pc: "));
            let said: Vec<&str> = lines.map(|line| line.trim_start_matches("pc: ")).collect();
            Outcome::Refused(code, if said.is_empty() { errors } else { said.join("\n") })
        }
    }
}
