//! The errors of the program, with their exit codes.

use std::error::Error;
use std::io;

use pc_fmu::FmuError;
use pc_model::import::UrdfError;
use pc_model::{ModelError, UnknownIntegral, UnknownStart, UnknownValue};
use pc_report::files::PictureError;
use pc_report::{ReportError, UnknownColumn};
use pc_run::RunError;
use pc_run::compare::error::CompareError;
use pc_run::files::error::FileError;
use pc_run::linear::error::LinearError;
use pc_run::sweep::error::SweepError;

use crate::exit_code;

/// An error of the program.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CliError {
    /// MODEL is neither a file nor the name of a built-in model.
    #[error(
        "there is no file `{name}`, nor a built-in model of that name{}",
        if meant.is_empty() { " (`pc models` lists them)".to_owned() } else { format!("; did you mean {}?", any_of(meant)) }
    )]
    NoSuchModel {
        /// As written.
        name: String,
        /// The built-in models that have the name as a part of theirs, or the one with nearly that name.
        meant: Vec<&'static str>,
    },
    /// No command has this manual page.
    #[error(
        "there is no command `{name}`; {}",
        nearest.as_ref().map_or_else(|| format!("the commands are {}", known.join(", ")), |name| format!("did you mean `{name}`?"))
    )]
    NoSuchCommand {
        /// As written.
        name: String,
        /// The command with nearly that name.
        nearest: Option<String>,
        /// All commands.
        known: Vec<String>,
    },
    /// `--reactions` in a form that has none in its variables.
    #[error(
        "--reactions: the form {form} has no reactions in its variables; use poincare, lagrange, voronets, maggi, kane or gibbs-appell"
    )]
    NoReactions {
        /// The form.
        form: &'static str,
    },
    /// No built-in model has this tag.
    #[error(
        "there is no tag `{name}`{}",
        nearest.map_or(" (`pc models --tags` lists them)".to_owned(), |name| format!("; did you mean `{name}`?"))
    )]
    NoSuchTag {
        /// As written.
        name: String,
        /// The tag with nearly that name.
        nearest: Option<&'static str>,
    },
    /// Several files where only one can be written.
    #[error("-o -: the source is in several files, {}; give a directory", files.join(" and "))]
    SeveralFiles {
        /// Their names.
        files: Vec<String>,
    },
    /// The page of `pc live` cannot be served.
    #[error("cannot serve a page{}", if *port == 0 { String::new() } else { format!(" on port {port}; give another one, or none for any that is free") })]
    Port {
        /// The port that was asked for; 0 is any.
        port: u16,
        /// Why.
        source: io::Error,
    },
    /// The model file cannot be read.
    #[error("cannot read {name}")]
    Read {
        /// The file.
        name: String,
        /// Why.
        source: io::Error,
    },
    /// `--set` of something that is neither a parameter nor a start value.
    #[error("--set: {0}")]
    UnknownValue(#[from] UnknownValue),
    /// `--project` of something that is not an integral.
    #[error("--project: {0}")]
    UnknownIntegral(UnknownIntegral),
    /// `--keep` of something that has no start value.
    #[error("--keep: {0}")]
    UnknownStart(#[from] UnknownStart),
    /// Quasi-velocities that are given to a form that does not take them.
    #[error("`{name}` is a definition, which only --form hamel takes; give nothing else after the model")]
    Definitions {
        /// The first of them.
        name: String,
    },
    /// New coordinates without as many new momenta.
    #[error(
        "--canonical: give new coordinates, then as many new momenta, as in `--canonical \"Q=2*x\" \"P=p_x/2\"`"
    )]
    NotInPairs,
    /// Two `--set` with the same name.
    #[error("--set: `{name}` is given two values; leave one out")]
    SetTwice {
        /// The parameter or start value.
        name: String,
    },
    /// `--set` to something that is not a number.
    #[error("--set {name}={value}: `{value}` is not a finite number")]
    BadValue {
        /// What is set.
        name: String,
        /// As written.
        value: String,
    },
    /// Nothing of the model can be drawn.
    #[error(
        "nothing of {model} can be drawn: it has neither bodies nor [[draw]], or the motion was computed without coordinates on \
         which these depend"
    )]
    NothingToDraw {
        /// Its title.
        model: String,
    },
    /// A frame is chosen where no single frame is written.
    #[error("--time chooses a frame, which is written by itself to `-o FILE.svg`, FILE.png or FILE.pdf")]
    NoFrame,
    /// A picture that could not be drawn.
    #[error(transparent)]
    Picture(#[from] PictureError),
    /// A column to be drawn does not exist.
    #[error("--{option}: {source}")]
    Column {
        /// The option that names it.
        option: &'static str,
        /// The column, and the existing ones.
        source: UnknownColumn,
    },
    /// Something wrong with a run, or with the file of its result.
    #[error(transparent)]
    Run(#[from] RunError),
    /// Something wrong with an FMU.
    #[error(transparent)]
    Fmu(FmuError),
    /// Something wrong with the file of a robot.
    #[error(transparent)]
    Urdf(#[from] UrdfError),
    /// Standard output for a table that goes to a file alone.
    #[error("this is written only to a file; name it by -o FILE")]
    NoFile,
    /// A format that a terminal cannot show.
    #[error(
        "--format {format}: a terminal cannot show this; name a file by -o FILE, or send it to a program or file by a pipe"
    )]
    Unreadable {
        /// The format.
        format: &'static str,
    },
    /// An option that has no effect on what a sweep computes for each member.
    #[error("{option} has no effect on what `--of {of}` computes; leave it out")]
    Idle {
        /// The option.
        option: &'static str,
        /// What is found.
        of: &'static str,
    },
}

/// `a`, `b` or `c`
fn any_of(names: &[&str]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    match quoted.split_last() {
        Some((last, others)) if !others.is_empty() => format!("{} or {last}", others.join(", ")),
        _ => quoted.concat(),
    }
}

impl From<FmuError> for CliError {
    fn from(error: FmuError) -> CliError {
        match error {
            FmuError::Model(error) => error.into(),
            other => CliError::Fmu(other),
        }
    }
}

impl From<ModelError> for CliError {
    fn from(error: ModelError) -> CliError {
        CliError::Run(RunError::Model(error))
    }
}

impl From<ReportError> for CliError {
    fn from(error: ReportError) -> CliError {
        CliError::Run(error.into())
    }
}

impl From<FileError> for CliError {
    fn from(error: FileError) -> CliError {
        CliError::Run(RunError::File(error))
    }
}

impl From<SweepError> for CliError {
    fn from(error: SweepError) -> CliError {
        CliError::Run(RunError::Sweep(error))
    }
}

impl From<LinearError> for CliError {
    fn from(error: LinearError) -> CliError {
        CliError::Run(RunError::Linear(error))
    }
}

impl From<CompareError> for CliError {
    fn from(error: CompareError) -> CliError {
        CliError::Run(RunError::Compare(error))
    }
}

impl CliError {
    /// Exit code of a wrong command line.
    pub const USAGE: u8 = exit_code::USAGE;

    /// Exit code where a result could not be written.
    pub const UNWRITTEN: u8 = exit_code::UNWRITTEN;

    /// Whether the reader of standard output has read enough and gone (`pc run … | head`).
    pub fn is_reader_gone(&self) -> bool {
        matches!(self, CliError::Run(RunError::File(FileError::Write { path, source, .. }))
            if path == STANDARD_OUTPUT && source.kind() == io::ErrorKind::BrokenPipe)
    }

    /// Exit code of the program.
    pub fn exit_code(&self) -> u8 {
        match self {
            CliError::Run(error) => exit_code::of(error.category()),
            CliError::Urdf(_) => 3,
            CliError::Fmu(error) if error.is_of_model() => 4,
            CliError::Fmu(FmuError::Step { .. }) => CliError::USAGE,
            CliError::Fmu(_) => CliError::UNWRITTEN,
            CliError::NoSuchModel { .. }
            | CliError::NoSuchCommand { .. }
            | CliError::NoSuchTag { .. }
            | CliError::NoReactions { .. }
            | CliError::SeveralFiles { .. }
            | CliError::Port { .. }
            | CliError::Read { .. }
            | CliError::UnknownValue(_)
            | CliError::UnknownIntegral(_)
            | CliError::UnknownStart(_)
            | CliError::SetTwice { .. }
            | CliError::Definitions { .. }
            | CliError::NotInPairs
            | CliError::BadValue { .. }
            | CliError::NothingToDraw { .. }
            | CliError::NoFrame
            | CliError::Idle { .. }
            | CliError::NoFile
            | CliError::Unreadable { .. }
            | CliError::Column { .. }
            | CliError::Picture(_) => CliError::USAGE,
        }
    }

    /// The message with its causes and what may help, a line for each.
    pub fn report(&self) -> String {
        let mut report = with_causes(self);
        if let CliError::Run(error) = self {
            error.help().iter().for_each(|help| report += &format!("\n  help: {help}"));
        }
        report
    }
}

/// An error with its causes, a line for each.
pub(crate) fn with_causes(error: &dyn Error) -> String {
    let mut report = format!("pc: {error}");
    let mut last = error.to_string();
    let mut source = error.source();
    while let Some(error) = source {
        let message = error.to_string();
        // The message of some errors ends with that of their source.
        if !last.ends_with(&message) {
            report += &format!("\n  because: {message}");
        }
        last = message;
        source = error.source();
    }
    report
}

/// The name of standard output in messages.
pub(crate) const STANDARD_OUTPUT: &str = "standard output";
