//! Errors of a sweep.

use std::io;
use std::path::PathBuf;

use pc_solve::{EnsembleError, Spent};

use crate::exit_code;

/// Why a sweep was not begun or not completed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SweepError {
    /// What is varied is not of the model.
    #[error(
        "`{name}` is neither a parameter nor a start value of this model; its parameters are {}, its start values {}",
        list(parameters),
        list(starts)
    )]
    UnknownName {
        /// The name asked for.
        name: String,
        /// The parameters there are.
        parameters: Vec<String>,
        /// The coordinates and quasi-velocities there are.
        starts: Vec<String>,
    },
    /// One name has values from two options.
    #[error("`{name}` is given values twice; leave one out")]
    Twice {
        /// The name.
        name: String,
    },
    /// The grid has more members than can be counted.
    #[error("the grid has more than 2^64 members; give fewer values")]
    TooMany,
    /// Another process is at work on the same file.
    #[error("another sweep is writing {}; wait for it, or give another -o", journal.display())]
    InUse {
        /// The journal.
        journal: PathBuf,
    },
    /// Another file is in the place of the journal.
    #[error("{} was not left by a sweep of this version; remove it, or give another -o", journal.display())]
    Foreign {
        /// The file.
        journal: PathBuf,
    },
    /// The journal is that of another sweep.
    #[error(
        "{} was left by a sweep with {what}; repeat that command to continue, or remove the file to start afresh",
        journal.display()
    )]
    OtherSweep {
        /// The journal.
        journal: PathBuf,
        /// What is different, then and now.
        what: String,
    },
    /// The journal cannot be read or written.
    #[error("cannot use {}", journal.display())]
    Journal {
        /// The journal.
        journal: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A finished member cannot be kept.
    #[error(
        "cannot write {}; the {done} members finished before are kept there, and the same command continues after them",
        journal.display()
    )]
    Append {
        /// The journal.
        journal: PathBuf,
        /// How many are kept.
        done: u64,
        /// Why.
        source: io::Error,
    },
    /// The threads cannot be started.
    #[error(transparent)]
    Ensemble(#[from] EnsembleError),
    /// No member was completed. The table has been written.
    #[error("none of the {members} members was completed; the first: {first}")]
    NoneCompleted {
        /// How many there are.
        members: u64,
        /// What is the matter with the first.
        first: String,
    },
    /// A limit of time.
    #[error("ended after {done} of {members} members: {limit}; the same command continues from there")]
    Ended {
        /// How many are finished.
        done: u64,
        /// How many there are.
        members: u64,
        /// The limit.
        limit: Spent,
    },
    /// Ctrl-C.
    #[error("interrupted after {done} of {members} members; the same command continues from there")]
    Interrupted {
        /// How many are finished.
        done: u64,
        /// How many there are.
        members: u64,
    },
}

impl SweepError {
    /// Exit code of the program.
    pub fn exit_code(&self) -> u8 {
        match self {
            SweepError::Ended { .. } => 4,
            SweepError::NoneCompleted { .. } => 5,
            SweepError::Interrupted { .. } => 130,
            SweepError::UnknownName { .. }
            | SweepError::Twice { .. }
            | SweepError::TooMany
            | SweepError::InUse { .. }
            | SweepError::Foreign { .. }
            | SweepError::OtherSweep { .. }
            | SweepError::Ensemble(_) => exit_code::USAGE,
            SweepError::Journal { .. } | SweepError::Append { .. } => exit_code::UNWRITTEN,
        }
    }
}

fn list(names: &[String]) -> String {
    if names.is_empty() { "none".to_owned() } else { names.join(", ") }
}
