//! Errors in a sweep.

use std::io;
use std::path::PathBuf;

use pc_model::UnknownValue;
use pc_solve::{EnsembleError, Spent};

use crate::category::Category;
use crate::sweep::picture_error::SweepPlotError;
use crate::sweep::shard::Shard;
use crate::sweep::sweep_columns::Misshapen;

/// Why a sweep was not begun or was not completed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SweepError {
    /// A name that is not in the model.
    #[error(transparent)]
    UnknownValue(UnknownValue),
    /// One name is given values by two options.
    #[error("`{name}` is given values twice; leave one out")]
    Twice {
        /// The name.
        name: String,
    },
    /// The grid has more members than can be counted.
    #[error("the grid has more than 2^64 members; give fewer values")]
    TooMany,
    /// There are more members than a sweep has by mistake.
    #[error(
        "the sweep has {members} members, more than the limit of {limit}; ask for fewer values, or give --limit-members {members} \
         if so many are meant"
    )]
    Many {
        /// The number of members.
        members: u64,
        /// The largest number that is begun.
        limit: u64,
    },
    /// Another process is working on the same file.
    #[error("another sweep is writing {}; wait for it, or give another -o", journal.display())]
    InUse {
        /// The journal.
        journal: PathBuf,
    },
    /// The file in the place of the journal is not a journal.
    #[error("{} was not left by a sweep of this version; remove it, or give another -o", journal.display())]
    Foreign {
        /// The file.
        journal: PathBuf,
    },
    /// The journal belongs to another sweep.
    #[error(
        "{} was left by a sweep with {what}; repeat that command to continue, or remove the file to start afresh",
        journal.display()
    )]
    OtherSweep {
        /// The journal.
        journal: PathBuf,
        /// What has changed, with its former and its present value.
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
    /// The record of a finished member cannot be written.
    #[error(
        "cannot write {}; the {done} members finished before are kept there, and the same command continues after them",
        journal.display()
    )]
    Append {
        /// The journal.
        journal: PathBuf,
        /// How many members are kept.
        done: u64,
        /// Why.
        source: io::Error,
    },
    /// A file to be merged is not a shard.
    #[error("{} was not left by `pc sweep --shard` of this version", path.display())]
    NoShard {
        /// The file.
        path: PathBuf,
    },
    /// There are no shards to merge.
    #[error("there are no shards to put together: give the files that `pc sweep --shard` has written")]
    NoShards,
    /// Two shards belong to different sweeps.
    #[error("{} and {} are not of the same sweep: the first has {what}", path.display(), other.display())]
    OtherShard {
        /// The path of one of the shards.
        path: PathBuf,
        /// The other.
        other: PathBuf,
        /// A phrase that says what is different.
        what: String,
    },
    /// The same shard is given twice.
    #[error("the shard {shard} is there twice: {} and {}", paths[0].display(), paths[1].display())]
    ShardTwice {
        /// Which.
        shard: Shard,
        /// The files.
        paths: [PathBuf; 2],
    },
    /// Shards are missing.
    #[error("of {of} shards {} missing: {}", if shards.len() == 1 { "one is" } else { "some are" }, numbers(shards))]
    Missing {
        /// The numbers of the missing shards.
        shards: Vec<u64>,
        /// How many shards there are.
        of: u64,
    },
    /// A shard is not complete.
    #[error(
        "{}, the shard {shard}, has {done} of its {members} members; repeat its command, which continues from there",
        path.display()
    )]
    Unfinished {
        /// The file.
        path: PathBuf,
        /// Which.
        shard: Shard,
        /// How many members the shard has.
        done: u64,
        /// How many members the shard should have.
        members: u64,
    },
    /// The record of a member does not fit the columns.
    #[error(transparent)]
    Misshapen(#[from] Misshapen),
    /// The finished members cannot be read back.
    #[error("cannot draw the sweep: its finished members cannot be read")]
    Read(#[source] io::Error),
    /// The requested picture cannot be drawn.
    #[error("--plot: {0}")]
    Drawn(#[from] SweepPlotError),
    /// The threads cannot be started.
    #[error(transparent)]
    Ensemble(#[from] EnsembleError),
    /// No member was completed. The table has been written.
    #[error("none of the {members} members was completed; the first: {first}")]
    NoneCompleted {
        /// How many members there are.
        members: u64,
        /// The error of the first member.
        first: String,
    },
    /// The time limit ended the sweep.
    #[error("ended after {done} of {members} members: {limit}; the same command continues from there")]
    Ended {
        /// How many members are finished.
        done: u64,
        /// How many members there are.
        members: u64,
        /// The limit.
        limit: Spent,
    },
    /// Ctrl-C.
    #[error("interrupted after {done} of {members} members; the same command continues from there")]
    Interrupted {
        /// How many members are finished.
        done: u64,
        /// How many members there are.
        members: u64,
    },
}

impl SweepError {
    /// The kind of the error.
    pub fn category(&self) -> Category {
        match self {
            SweepError::Ended { .. } | SweepError::Misshapen(_) => Category::Undefined,
            SweepError::NoneCompleted { .. } => Category::Failed,
            SweepError::Interrupted { .. } => Category::Interrupted,
            SweepError::UnknownValue(_)
            | SweepError::Twice { .. }
            | SweepError::TooMany
            | SweepError::Many { .. }
            | SweepError::InUse { .. }
            | SweepError::Foreign { .. }
            | SweepError::OtherSweep { .. }
            | SweepError::NoShard { .. }
            | SweepError::NoShards
            | SweepError::OtherShard { .. }
            | SweepError::ShardTwice { .. }
            | SweepError::Missing { .. }
            | SweepError::Unfinished { .. }
            | SweepError::Drawn(_)
            | SweepError::Ensemble(_) => Category::Request,
            SweepError::Read(_) | SweepError::Journal { .. } | SweepError::Append { .. } => {
                Category::Unwritten
            }
        }
    }
}

fn numbers(shards: &[u64]) -> String {
    shards.iter().map(u64::to_string).collect::<Vec<_>>().join(", ")
}
