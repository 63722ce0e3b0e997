//! What can go wrong, and the exit code of each.

use std::fmt;
use std::io;
use std::path::Path;
use std::process::{ExitCode, ExitStatus};
use std::time::Duration;

use crate::counts::Counts;

/// The exit code of what this machine cannot do and the workspace does without.
pub(crate) const SKIPPED: u8 = 77;

/// A failure of a command of this program.
#[derive(Debug)]
pub(crate) enum Error {
    /// The command line is wrong.
    Usage { message: String },
    /// Tools are missing and only the user can install them.
    Missing { tools: Vec<&'static str>, remedy: String },
    /// `LIBCLANG_PATH` is obeyed by bindgen even where it holds no libclang.
    LibclangPath { path: String },
    /// The installation went through but a tool is still not found.
    StillMissing { tools: Vec<&'static str> },
    /// A program could not be started.
    Start { program: String, source: io::Error },
    /// The output of a program could not be passed on.
    Output { program: String, source: io::Error },
    /// A file could not be read, written or removed.
    File { path: String, source: io::Error },
    /// A program ran and failed.
    Failed { command: String, status: ExitStatus },
    /// Something took longer than it may and was killed; what was at work then.
    TimeLimit { what: String, limit: Duration, at_work: Vec<String> },
    /// Tests failed, or their programs did.
    Tests { counts: Counts, failure: Box<Error> },
    /// The installed library is not as it should be.
    Installed { wrong: String },
    /// An example does not give the numbers of the program `pc`.
    Numbers { example: String, wrong: String },
    /// The wheel of the Python package is not as it should be.
    Package { wrong: String },
    /// Something about a release is not as it should be.
    Unfit { wrong: String },
    /// Points of the list of a release that failed.
    Release { points: Vec<&'static str> },
    /// A command needs what this machine does not have and the workspace does without.
    Unavailable { what: String },
    /// Links of the book lead nowhere.
    Links { lost: Vec<String> },
    /// Installing on a system that has other names and tools for it.
    NotLinux { system: String },
    /// Every test binary was empty, or none was run.
    NoTests,
}

impl Error {
    /// That of a file which cannot be read, written or removed.
    pub(crate) fn of_file(path: &Path, source: io::Error) -> Error {
        Error::File { path: path.display().to_string(), source }
    }

    /// That of something killed after `limit`.
    pub(crate) fn time_limit(what: String, limit: Duration, at_work: Vec<String>) -> Error {
        Error::TimeLimit { what, limit, at_work }
    }

    /// 2 for a wrong command line, [`SKIPPED`] for what cannot be done here, 1 for everything else.
    pub(crate) fn exit_code(&self) -> ExitCode {
        match self {
            Error::Usage { .. } => ExitCode::from(2),
            Error::Unavailable { .. } => ExitCode::from(SKIPPED),
            _ => ExitCode::FAILURE,
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Usage { message } => f.write_str(message),
            Error::Missing { tools, remedy } => write!(f, "missing: {}\n{remedy}", tools.join(", ")),
            Error::LibclangPath { path } => {
                write!(f, "LIBCLANG_PATH is `{path}`, where there is no libclang; correct it or unset it")
            }
            Error::StillMissing { tools } => {
                write!(f, "installed, but still not found: {}", tools.join(", "))
            }
            Error::Start { program, source } => write!(f, "cannot start `{program}`: {source}"),
            Error::Output { program, source } => {
                write!(f, "cannot pass on the output of `{program}`: {source}")
            }
            Error::File { path, source } => write!(f, "{path}: {source}"),
            Error::Failed { command, status } => write!(f, "`{command}` failed: {status}"),
            Error::TimeLimit { what, limit, at_work } => {
                write!(f, "`{what}` was killed after {} s", limit.as_secs())?;
                if at_work.is_empty() { Ok(()) } else { write!(f, "; at work: {}", at_work.join(", ")) }
            }
            Error::Tests { failure, .. } => failure.fmt(f),
            Error::Installed { wrong } => write!(f, "the installed library: {wrong}"),
            Error::Numbers { example, wrong } => write!(f, "the example {example}: {wrong}"),
            Error::Unfit { wrong } => f.write_str(wrong),
            Error::Release { points } => write!(f, "not fit to be published: {}", points.join(", ")),
            Error::Package { wrong } => write!(f, "the Python package: {wrong}"),
            Error::Unavailable { what } => f.write_str(what),
            Error::Links { lost } => write!(f, "links that lead nowhere:\n  {}", lost.join("\n  ")),
            Error::NotLinux { system } => write!(
                f,
                "installing is made for Linux; on {system} take the library from target/release and the headers from \
                 include"
            ),
            Error::NoTests => f.write_str("no test was run"),
        }
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Error::Tests { failure, .. } => failure.source(),
            Error::Start { source, .. } | Error::Output { source, .. } | Error::File { source, .. } => {
                Some(source)
            }
            _ => None,
        }
    }
}
