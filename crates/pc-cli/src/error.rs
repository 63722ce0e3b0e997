//! The errors of the program, with their exit codes.

use std::error::Error;
use std::io;
use std::path::{Path, PathBuf};

use pc_fmu::FmuError;
use pc_model::{ModelError, UnknownIntegral, UnknownParameter, UnknownStart, UnknownValue};
use pc_report::ReportError;
use pc_solve::{Code, SolveError, Spent};
use pc_verify::VerifyError;

use crate::compare::error::CompareError;
use crate::exit_code;
use crate::import::UrdfError;
use crate::linear::error::LinearError;
use crate::motion::checkpoint_error::CheckpointFileError;
use crate::motion::lost::LostIntegral;
use crate::output::kept::Kept;
use crate::plot::error::PlotError;
use crate::report::text::{short, small};
use crate::sweep::error::SweepError;

/// An error of the program.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CliError {
    /// MODEL is neither a file nor the name of a built-in model.
    #[error(
        "there is no file `{name}`, nor a built-in model of that name{}",
        nearest.map_or(" (`pc models` lists them)".to_owned(), |name| format!("; did you mean `{name}`?"))
    )]
    NoSuchModel {
        /// As written.
        name: String,
        /// The built-in model with nearly that name.
        nearest: Option<&'static str>,
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
    /// `--sensitivities` by something that is not a parameter.
    #[error("--sensitivities: {0}")]
    Sensitivities(UnknownParameter),
    /// `--atol` of something that is no component of the state.
    #[error("--atol: {0}")]
    Tolerance(#[source] UnknownStart),
    /// `--keep` of something that has no start value.
    #[error("--keep: {0}")]
    UnknownStart(#[from] UnknownStart),
    /// Quasi-velocities that are given to a form that does not take them.
    #[error("`{name}` is a definition, which only --form hamel takes; give nothing else after the model")]
    Definitions {
        /// The first of them.
        name: String,
    },
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
    #[error("--at chooses a frame, which is written by itself to `-o FILE.svg`, FILE.png or FILE.pdf")]
    NoFrame,
    /// Neither the command line nor the model gives an end time.
    #[error(
        "{model}: no end time: give `--t-end T`, or `t_end = T` in the section [simulation] of the model"
    )]
    NoEnd {
        /// Name of the model file.
        model: String,
    },
    /// An end time equal to the start time.
    #[error("the end time {t} is the start time: nothing to integrate")]
    EndIsStart {
        /// That time.
        t: f64,
    },
    /// A file whose name does not say what to write.
    #[error("{option} {}: the name must end in {expected}", path.display())]
    UnknownExtension {
        /// The option that names the file.
        option: &'static str,
        /// The file.
        path: PathBuf,
        /// The extensions that are accepted.
        expected: &'static str,
    },
    /// A file that cannot be written, found before anything is computed.
    #[error("cannot write {}; nothing was computed", path.display())]
    Place {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A result that could not be written.
    #[error("cannot write {path}{kept}")]
    Write {
        /// The file, or `standard output`.
        path: String,
        /// Where the result was kept.
        kept: Kept,
        /// Why.
        source: io::Error,
    },
    /// More rows than the memory limit allows.
    #[error(
        "{rows} rows of {numbers} numbers would take {} MiB, more than the limit of {} MiB; ask for fewer, give \
         --limit-memory {}M, or for a single motion only -o FILE.csv, whose rows are written as they are computed",
        bytes.div_ceil(1 << 20),
        limit >> 20,
        bytes.div_ceil(1 << 20)
    )]
    Rows {
        /// How many are wanted.
        rows: u64,
        /// Numbers in memory for each row.
        numbers: u64,
        /// Memory that they would take.
        bytes: u64,
        /// Memory that they may take.
        limit: u64,
    },
    /// A picture that could not be drawn.
    #[error(transparent)]
    Plot(#[from] PlotError),
    /// Something wrong with the model.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// Something wrong with an FMU.
    #[error(transparent)]
    Fmu(FmuError),
    /// Something wrong with a robot in URDF.
    #[error(transparent)]
    Urdf(#[from] UrdfError),
    /// The equations disagree with a second derivation: one of the two is wrong, by a defect of
    /// this program.
    #[error("{0}; no result is returned, because one of them is wrong through a defect of this program")]
    Verify(Box<VerifyError>),
    /// Something wrong with checkpoints.
    #[error(transparent)]
    Checkpoints(#[from] CheckpointFileError),
    /// Something wrong with a sweep.
    #[error(transparent)]
    Sweep(#[from] SweepError),
    /// Something wrong with a linearization or with equilibria.
    #[error(transparent)]
    Linear(#[from] LinearError),
    /// Motions that differ, or cannot be compared.
    #[error(transparent)]
    Compare(#[from] CompareError),
    /// The integration could not continue.
    #[error("the integration failed{}", at(.cause, names))]
    Integration {
        /// Why.
        #[source]
        cause: Box<SolveError>,
        /// Names of the components of the state.
        names: Vec<String>,
        /// Whether forces jump where the state changes, as dry friction does.
        jumps: bool,
        /// The velocity that has lost its inertia, and what is left of it.
        lost_inertia: Option<(String, f64)>,
    },
    /// An integral that is proved to be kept has changed.
    #[error(
        "the motion is wrong: {} is proved to be kept at {}, and drifts by {}, more than a thousandth of its scale {}; \
         the rows are written as they were computed",
        .0.name, short(.0.start, 6), small(.0.drift), small(.0.scale)
    )]
    Lost(LostIntegral),
    /// The time limit ended the integration.
    #[error("ended at t = {}: {limit}", short(*t, 17))]
    Ended {
        /// How far the integration was.
        t: f64,
        /// The limit.
        limit: Spent,
    },
    /// Ctrl-C.
    #[error("interrupted at t = {}", short(*t, 17))]
    Interrupted {
        /// How far the integration was.
        t: f64,
    },
}

impl From<FmuError> for CliError {
    fn from(error: FmuError) -> CliError {
        match error {
            FmuError::Model(error) => CliError::Model(error),
            other => CliError::Fmu(other),
        }
    }
}

impl From<ReportError> for CliError {
    fn from(error: ReportError) -> CliError {
        match error {
            ReportError::Model(error) => CliError::Model(error),
            ReportError::Verify(error) => CliError::Verify(error),
        }
    }
}

impl CliError {
    /// A result that could not be written and is not kept anywhere.
    pub(crate) fn cannot_write(path: &Path, source: io::Error) -> CliError {
        CliError::Write { path: path.display().to_string(), kept: Kept::Nowhere, source }
    }

    /// A file that cannot be written, found before anything is computed.
    pub(crate) fn no_place(path: &Path, source: io::Error) -> CliError {
        CliError::Place { path: path.to_owned(), source }
    }

    /// Exit code of a wrong command line.
    pub const USAGE: u8 = exit_code::USAGE;

    /// Exit code where a result could not be written.
    pub const UNWRITTEN: u8 = exit_code::UNWRITTEN;

    /// Whether the reader of standard output has read enough and gone (`pc run … | head`).
    pub fn is_reader_gone(&self) -> bool {
        matches!(self, CliError::Write { path, source, .. }
            if path == STANDARD_OUTPUT && source.kind() == io::ErrorKind::BrokenPipe)
    }

    /// Exit code of the program.
    pub fn exit_code(&self) -> u8 {
        match self {
            CliError::Model(error) => error.category().exit_code(),
            CliError::Sweep(error) => error.exit_code(),
            CliError::Linear(error) => error.exit_code(),
            CliError::Compare(error) => error.exit_code(),
            CliError::Urdf(_) => 3,
            CliError::Fmu(error) if error.is_of_model() => 4,
            CliError::Fmu(FmuError::Step { .. }) => CliError::USAGE,
            CliError::Fmu(_) => CliError::UNWRITTEN,
            CliError::Verify(_) | CliError::Rows { .. } | CliError::Ended { .. } => 4,
            CliError::Integration { .. } | CliError::Lost(_) => 5,
            CliError::Interrupted { .. } => 130,
            CliError::NoSuchModel { .. }
            | CliError::NoSuchCommand { .. }
            | CliError::NoSuchTag { .. }
            | CliError::SeveralFiles { .. }
            | CliError::Read { .. }
            | CliError::UnknownValue(_)
            | CliError::UnknownIntegral(_)
            | CliError::Sensitivities(_)
            | CliError::UnknownStart(_)
            | CliError::Tolerance(_)
            | CliError::SetTwice { .. }
            | CliError::Definitions { .. }
            | CliError::BadValue { .. }
            | CliError::NothingToDraw { .. }
            | CliError::NoFrame
            | CliError::NoEnd { .. }
            | CliError::EndIsStart { .. }
            | CliError::UnknownExtension { .. }
            | CliError::Place { .. }
            | CliError::Checkpoints(_)
            | CliError::Plot(_) => CliError::USAGE,
            CliError::Write { .. } => CliError::UNWRITTEN,
        }
    }

    /// The message with its causes, a line for each.
    pub fn report(&self) -> String {
        let mut report = format!("pc: {self}");
        let mut last = self.to_string();
        let mut source = self.source();
        while let Some(error) = source {
            let message = error.to_string();
            // The message of some errors ends with that of their source.
            if !last.ends_with(&message) {
                report += &format!("\n  because: {message}");
            }
            last = message;
            source = error.source();
        }
        if let CliError::Lost(_) = self {
            report += "\n  help: take a smaller --rtol and compare; --project keeps an integral, though not the motion; \
                       if it is lost at one time, the motion is singular there";
        }
        if let CliError::Integration { lost_inertia: Some((velocity, part)), .. } = self {
            report += &format!(
                "\n  help: the mass matrix becomes singular there: of the inertia of {velocity} at the start {} is left",
                small(*part)
            );
        }
        if let CliError::Integration { cause, jumps: true, .. } = self
            && cause.code() == Some(Code::TooMuchWork)
        {
            report += "\n  help: the forces jump, as dry friction does, and the motion may stay where they do, chattering: \
                       have [events] change the law there, as the built-in model stick-slip-block does";
        }
        report
    }
}

/// The name of standard output in messages.
pub(crate) const STANDARD_OUTPUT: &str = "standard output";

/// The time and state of the integration, with the names of the state.
fn at(cause: &SolveError, names: &[String]) -> String {
    let Some((t, state)) = cause.reached() else { return String::new() };
    let state: String =
        names.iter().zip(state).map(|(name, value)| format!(", {name} = {}", short(*value, 17))).collect();
    format!(" at t = {}{state}", short(t, 17))
}
