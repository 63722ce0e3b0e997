//! Why a benchmark could not be run.

use std::io;
use std::path::PathBuf;

use pc_expr::{ExprError, Failure};
use pc_mech::MechError;
use pc_model::ModelError;
use pc_nonholo::NonholoError;
use pc_solve::SolveFailure;

/// Why a benchmark could not be run.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Error {
    /// A built-in model was not found.
    #[error("there is no built-in model `{name}`")]
    NoModel { name: &'static str },
    /// A model was refused.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A robot was refused.
    #[error("the robot was refused: {cause}")]
    Robot { cause: String },
    /// A system was refused.
    #[error(transparent)]
    Mech(#[from] MechError),
    /// Constraints were refused.
    #[error(transparent)]
    Nonholo(#[from] NonholoError),
    /// A program could not be made.
    #[error(transparent)]
    Expr(#[from] ExprError),
    /// A motion could not be evaluated.
    #[error(transparent)]
    Failure(#[from] Failure),
    /// A kernel could not be made.
    #[error("no {kernel} for {system}: {cause}")]
    Kernel { kernel: &'static str, system: String, cause: String },
    /// Two variants of a right-hand side differ by more than rounding.
    #[error(
        "{system}: `{variant}` differs from `{reference}` in component {component} by {error:e} at {state:?}"
    )]
    Disagreement {
        system: String,
        variant: String,
        reference: String,
        component: usize,
        error: f64,
        state: Vec<f64>,
    },
    /// The program to be timed is not there and could not be built.
    #[error("the program {} is missing and could not be built: {cause}", path.display())]
    Missing { path: PathBuf, cause: String },
    /// The program to be timed failed.
    #[error("`{command}` failed: {message}")]
    Failed { command: String, message: String },
    /// libpc refused a call.
    #[error("libpc refused {call}")]
    Refused { call: &'static str },
    /// A program could not be started.
    #[error("cannot start `{command}`")]
    Start { command: String, source: io::Error },
    /// A motion could not be integrated.
    #[error(transparent)]
    Solve(#[from] Box<SolveFailure>),
    /// A program answered what cannot be read.
    #[error("`{command}` answered `{answer}`")]
    Answer { command: String, answer: String },
    /// The C library that was built for us was not found.
    #[error("no SUNDIALS among what `cargo build` says it has built")]
    NoSundials,
    /// Two integrations of one motion end apart.
    #[error("{system}, rtol {rtol:e}: ours ends {distance:e} from that of plain C")]
    Apart { system: &'static str, rtol: f64, distance: f64 },
    /// Members of an ensemble did not come to their end.
    #[error("of {members} members {ended} came to their end")]
    Ensemble { members: usize, ended: usize },
    /// The report could not be written.
    #[error("cannot write {}", path.display())]
    Write { path: PathBuf, source: io::Error },
}
