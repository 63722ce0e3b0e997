//! The errors of runs.

use pc_model::{ModelError, UnknownParameter, UnknownStart};
use pc_print::{short, small};
use pc_report::{ReportError, UnknownColumn};
use pc_solve::{Code, SolveError, Spent};
use pc_verify::VerifyError;

use crate::category::Category;
use crate::compare::error::CompareError;
use crate::files::error::FileError;
use crate::linear::error::LinearError;
use crate::motion::checkpoint_error::CheckpointFileError;
use crate::motion::lost::LostIntegral;
use crate::sweep::error::SweepError;

/// An error of a run.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RunError {
    /// Sensitivities were requested with respect to something that is not a parameter.
    #[error("--sensitivities: {0}")]
    Sensitivities(UnknownParameter),
    /// A tolerance for something that is not a component of the state.
    #[error("--atol: {0}")]
    Tolerance(#[source] UnknownStart),
    /// Neither the options nor the model gives an end time.
    #[error(
        "{model}: no end time: give `--t-end T`, or `t_end = T` in the section [simulation] of the model"
    )]
    NoEnd {
        /// Name of the model file.
        model: String,
    },
    /// The end time is equal to the start time.
    #[error("the end time {t} is the start time: nothing to integrate")]
    EndIsStart {
        /// The start and end time.
        t: f64,
    },
    /// There are more rows than the memory limit allows.
    #[error(
        "{rows} rows of {numbers} numbers would take {} MiB, more than the limit of {} MiB; ask for fewer, give \
         --limit-memory {}M, or for a single motion only -o FILE.csv, whose rows are written as they are computed",
        bytes.div_ceil(1 << 20),
        limit >> 20,
        bytes.div_ceil(1 << 20)
    )]
    Rows {
        /// The number of rows requested.
        rows: u64,
        /// How many numbers are held in memory for each row.
        numbers: u64,
        /// The memory that the rows would take.
        bytes: u64,
        /// The memory that they may take.
        limit: u64,
    },
    /// Something is wrong with the model.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The equations disagree with a second derivation: one of the two is wrong, because of a
    /// defect of this program.
    #[error("{0}; no result is returned, because one of them is wrong through a defect of this program")]
    Verify(Box<VerifyError>),
    /// Something is wrong with a file.
    #[error(transparent)]
    File(#[from] FileError),
    /// Something is wrong with checkpoints.
    #[error(transparent)]
    Checkpoints(#[from] CheckpointFileError),
    /// Something is wrong with a sweep.
    #[error(transparent)]
    Sweep(#[from] SweepError),
    /// Something is wrong with a linearization or with equilibria.
    #[error(transparent)]
    Linear(#[from] LinearError),
    /// Motions differ, or cannot be compared.
    #[error(transparent)]
    Compare(#[from] CompareError),
    /// A column that is to be written does not exist.
    #[error("--columns: {0}")]
    Column(#[from] UnknownColumn),
    /// The integration could not continue.
    #[error("the integration failed{}", at(.cause, names))]
    Integration {
        /// Why.
        #[source]
        cause: Box<SolveError>,
        /// Names of the components of the state.
        names: Vec<String>,
        /// Whether forces are discontinuous functions of the state, as dry friction is.
        jumps: bool,
        /// The velocity that has lost its inertia, and the fraction of the inertia that is left.
        lost_inertia: Option<(String, f64)>,
    },
    /// An integral has changed although it is proved to be conserved.
    #[error(
        "the motion is wrong: {} is proved to be kept at {}, and drifts by {}, more than a thousandth of its scale {}; \
         the rows are written as they were computed",
        .0.name, short(.0.start, 6), small(.0.drift), small(.0.scale)
    )]
    Lost(LostIntegral),
    /// The time limit ended the integration.
    #[error("ended at t = {}: {limit}", short(*t, 17))]
    Ended {
        /// The time that the integration reached.
        t: f64,
        /// The limit.
        limit: Spent,
    },
    /// The observer ended the integration, for example by Ctrl-C.
    #[error("interrupted at t = {}", short(*t, 17))]
    Interrupted {
        /// The time that the integration reached.
        t: f64,
    },
}

impl From<ReportError> for RunError {
    fn from(error: ReportError) -> RunError {
        match error {
            ReportError::Model(error) => RunError::Model(error),
            ReportError::Verify(error) => RunError::Verify(error),
        }
    }
}

impl RunError {
    /// The kind of the error.
    pub fn category(&self) -> Category {
        match self {
            RunError::Model(error) => error.category().into(),
            RunError::File(error) => error.category(),
            RunError::Sweep(error) => error.category(),
            RunError::Linear(error) => error.category(),
            RunError::Compare(error) => error.category(),
            RunError::Verify(_) | RunError::Rows { .. } | RunError::Ended { .. } => Category::Undefined,
            RunError::Integration { .. } | RunError::Lost(_) => Category::Failed,
            RunError::Interrupted { .. } => Category::Interrupted,
            RunError::Sensitivities(_)
            | RunError::Column(_)
            | RunError::Tolerance(_)
            | RunError::NoEnd { .. }
            | RunError::EndIsStart { .. }
            | RunError::Checkpoints(_) => Category::Request,
        }
    }

    /// Advice that may help, if there is any.
    pub fn help(&self) -> Vec<String> {
        let mut help = Vec::new();
        if let RunError::Lost(_) = self {
            help.push(
                "take a smaller --rtol and compare; --project keeps an integral, though not the motion; if it is lost at \
                 one time, the motion is singular there"
                    .to_owned(),
            );
        }
        if let RunError::Integration { lost_inertia: Some((velocity, part)), .. } = self {
            help.push(format!(
                "the mass matrix becomes singular there: of the inertia of {velocity} at the start {} is left",
                small(*part)
            ));
        }
        if let RunError::Integration { cause, jumps: true, .. } = self
            && cause.code() == Some(Code::TooMuchWork)
        {
            help.push(
                "the forces jump, as dry friction does, and the motion may stay where they do, chattering: have [events] \
                 change the law there, as the built-in model stick-slip-block does"
                    .to_owned(),
            );
        }
        help
    }
}

/// The time and state of the integration, with the names of the state.
fn at(cause: &SolveError, names: &[String]) -> String {
    let Some((t, state)) = cause.reached() else { return String::new() };
    let state: String =
        names.iter().zip(state).map(|(name, value)| format!(", {name} = {}", short(*value, 17))).collect();
    format!(" at t = {}{state}", short(t, 17))
}
