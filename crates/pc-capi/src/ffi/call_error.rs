//! The ways in which a call can fail.

use std::error::Error;
use std::ffi::CString;

use ::pc_model::import::UrdfError;
use ::pc_model::{
    Category, ModelError, NotForced, SealError, UnknownIntegral, UnknownParameter, UnknownStart,
};
use pc_analysis::AnalysisError;
use pc_expr::{Failure, Spent};
use pc_mech::MechError;
use pc_solve::{CheckpointError, EnsembleError, SolveError};
use pc_verify::VerifyError;

use crate::ffi::status::pc_status;
use crate::ffi::strings::c_string;

/// The ways in which a call can fail.
#[derive(Debug, thiserror::Error)]
pub(crate) enum CallError {
    #[error("{what} is a null pointer")]
    Null { what: &'static str },
    #[error("{what}: {found} numbers instead of {expected}")]
    Length { what: &'static str, found: usize, expected: usize },
    #[error("{what}: memory cannot hold {found} numbers, only {most}; is the length −1?")]
    TooLong { what: &'static str, found: usize, most: usize },
    #[error("{what} is misaligned: its address must be a multiple of {alignment} bytes")]
    Misaligned { what: &'static str, alignment: usize },
    #[error("{what} is not UTF-8 text: byte number {offset} (from 0) is invalid")]
    NotText { what: &'static str, offset: usize },
    #[error("{what} is {value}, but must be finite")]
    NotFinite { what: &'static str, value: f64 },
    #[error("each axis needs one angle: there are {axes} axes and {angles} angles")]
    TurnsOfAxes { axes: usize, angles: usize },
    #[error("{first} and {second} share memory, but must be separate")]
    Overlap { first: &'static str, second: &'static str },
    #[error("{what} has no value here: it is {value}")]
    NoValue { what: &'static str, value: f64 },
    #[error("{value} is not a value of {what}")]
    Choice { what: &'static str, value: i64 },
    #[error("{what} is {value}, but must be 0: this library has no such choice")]
    Reserved { what: &'static str, value: i64 },
    #[error("the time limit is {value} s, but must be positive, or 0 for none")]
    TimeLimit { value: f64 },
    #[error("{what} have size {found}, not between {least} and {most}; set them up with the init function")]
    StructSize { what: &'static str, found: usize, least: usize, most: usize },
    #[error("{what}: index {index} is not below {count}")]
    Index { what: &'static str, index: usize, count: usize },
    #[error("{what} needs a model begun with pc_model_new; this one was read from a text")]
    NotADraft { what: &'static str },
    #[error("there is no built-in model called `{name}`; pc_builtin_name gives their names")]
    NoSuchModel { name: String },
    #[error("cannot read `{path}`: {source}")]
    Read { path: String, source: std::io::Error },
    #[error("{what} is not available for this system: {why}")]
    Unsupported { what: &'static str, why: &'static str },
    #[error("the handle is in use by another call")]
    Busy,
    #[error("an earlier call failed internally; this handle can only be freed")]
    Broken,
    #[error("a fault of the library: {message}")]
    Panic { message: String },
    #[error("{0}")]
    Limit(Spent),
    #[error("the observer stopped the integration")]
    Stopped,
    #[error("a terminal event ended the integration")]
    Terminal,
    #[error("{what} must come before the first step, and one has been taken")]
    Begun { what: &'static str },
    #[error("there is no event called `{name}`; pc_model_add_event adds one")]
    NoSuchEvent { name: String },
    #[error("the event {name} has not occurred")]
    NotOccurred { name: String },
    #[error("no terminal event ended the last call")]
    NotEnded,
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
    #[error(
        "the checkpoint belongs to another model: its names, their number or its equations differ from the system's"
    )]
    OtherModel,
    #[error("the checkpoint does not name its model: pc_solver_checkpoint did not write it")]
    NoModel,
    #[error("there is no {what} called `{name}`; there are {}", if known.is_empty() { "none".to_owned() } else { known.join(", ") })]
    UnknownName { what: &'static str, name: String, known: Vec<String> },
    #[error("the code cannot be used: {0}")]
    Code(#[from] SealError),
    #[error("{0}")]
    Ensemble(#[from] EnsembleError),
    #[error(transparent)]
    Verify(VerifyError),
    #[error(transparent)]
    Model(#[from] ModelError),
    #[error(transparent)]
    Robot(#[from] UrdfError),
    #[error(transparent)]
    UnknownParameter(#[from] UnknownParameter),
    #[error(transparent)]
    UnknownIntegral(#[from] UnknownIntegral),
    #[error(transparent)]
    UnknownStart(#[from] UnknownStart),
    #[error(transparent)]
    NotForced(#[from] NotForced),
    #[error("{0}")]
    Evaluation(#[from] Failure),
    #[error("{0}")]
    Analysis(AnalysisError),
    #[error(transparent)]
    Mechanics(#[from] MechError),
    #[error(transparent)]
    Solve(#[from] SolveError),
}

impl CallError {
    pub(crate) fn status(&self) -> pc_status {
        match self {
            CallError::Null { .. }
            | CallError::Length { .. }
            | CallError::TooLong { .. }
            | CallError::Misaligned { .. }
            | CallError::NotText { .. }
            | CallError::NotFinite { .. }
            | CallError::TurnsOfAxes { .. }
            | CallError::Overlap { .. }
            | CallError::Choice { .. }
            | CallError::Reserved { .. }
            | CallError::TimeLimit { .. }
            | CallError::StructSize { .. }
            | CallError::Index { .. }
            | CallError::NotADraft { .. }
            | CallError::Begun { .. }
            | CallError::Solve(SolveError::Input(_)) => pc_status::PC_INVALID_ARGUMENT,
            CallError::Model(error) => match error.category() {
                Category::Text => pc_status::PC_INVALID_MODEL,
                Category::Unsupported => pc_status::PC_UNSUPPORTED,
                Category::Inconsistent => pc_status::PC_INCONSISTENT_MODEL,
                Category::Spent => pc_status::PC_LIMIT,
            },
            CallError::Robot(_) => pc_status::PC_INVALID_MODEL,
            CallError::Verify(VerifyError::Disagreement(_)) => pc_status::PC_DISAGREEMENT,
            CallError::Unsupported { .. } | CallError::Verify(_) => pc_status::PC_UNSUPPORTED,
            CallError::NoSuchModel { .. }
            | CallError::UnknownName { .. }
            | CallError::UnknownParameter(_)
            | CallError::UnknownIntegral(_)
            | CallError::UnknownStart(_)
            | CallError::NotForced(_)
            | CallError::NoSuchEvent { .. }
            | CallError::NotOccurred { .. }
            | CallError::NotEnded => pc_status::PC_NOT_FOUND,
            CallError::Read { source, .. } if source.kind() == std::io::ErrorKind::NotFound => {
                pc_status::PC_NOT_FOUND
            }
            CallError::Read { .. } => pc_status::PC_IO,
            CallError::Analysis(error) => match error {
                AnalysisError::DependsOnTime | AnalysisError::LeafUnknown { .. } => pc_status::PC_UNSUPPORTED,
                _ => pc_status::PC_EVALUATION,
            },
            CallError::Evaluation(_) | CallError::Mechanics(_) | CallError::NoValue { .. } => {
                pc_status::PC_EVALUATION
            }
            CallError::Limit(_) => pc_status::PC_LIMIT,
            CallError::Solve(error) if error.ended().is_some() => pc_status::PC_LIMIT,
            CallError::Solve(SolveError::Integration(_)) => pc_status::PC_INTEGRATION,
            CallError::Stopped => pc_status::PC_STOPPED,
            CallError::Terminal => pc_status::PC_EVENT,
            CallError::Code(_) => pc_status::PC_INVALID_CODE,
            CallError::Checkpoint(_) | CallError::OtherModel | CallError::NoModel => {
                pc_status::PC_INVALID_CHECKPOINT
            }
            CallError::Busy => pc_status::PC_BUSY,
            // The remaining errors of the solver are from its set-up, which fails for want of
            // memory, as threads do.
            CallError::Broken | CallError::Panic { .. } | CallError::Ensemble(_) | CallError::Solve(_) => {
                pc_status::PC_INTERNAL
            }
        }
    }

    /// The message, with the causes of the error where the message does not contain them.
    fn message(&self) -> String {
        let mut message = self.to_string();
        let mut cause = match self {
            CallError::Solve(error) => error.source(),
            CallError::Ensemble(error) => error.source(),
            _ => None,
        };
        while let Some(error) = cause {
            message += &format!(": {error}");
            cause = error.source();
        }
        message
    }

    /// The status and the message.
    pub(crate) fn told(&self) -> (pc_status, CString) {
        (self.status(), c_string(&self.message()))
    }
}
