//! Errors about checkpoints.

use std::io;
use std::path::PathBuf;

use pc_solve::CheckpointError;

/// Why a run cannot continue from a file, or keep checkpoints in it.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CheckpointFileError {
    /// The file cannot be read.
    #[error("--resume {}: the file cannot be read", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The file is not a checkpoint, or is damaged.
    #[error("--resume {}: {source}; start afresh without --resume", path.display())]
    Unusable {
        /// The file.
        path: PathBuf,
        /// Why.
        source: CheckpointError,
    },
    /// The checkpoint belongs to another run.
    #[error("--resume {}: the checkpoint is from a run with {what}; repeat that command, or start afresh without --resume", path.display())]
    OtherRun {
        /// The file.
        path: PathBuf,
        /// What has changed, with its former and its present value.
        what: String,
    },
    /// A checkpoint would overwrite something else.
    #[error("--checkpoint {}: the file exists and is not a checkpoint; give another name", path.display())]
    Occupied {
        /// The file.
        path: PathBuf,
    },
    /// `--every` is given although no checkpoint is kept.
    #[error("--every sets how often checkpoints are written; give --checkpoint FILE too")]
    Nowhere,
}
