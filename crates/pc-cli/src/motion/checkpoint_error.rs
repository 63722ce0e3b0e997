//! What can go wrong with checkpoints.

use std::io;
use std::path::PathBuf;

use pc_solve::CheckpointError;

/// Why a run cannot go on from a file, or keep checkpoints there.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CheckpointFileError {
    /// The file cannot be read.
    #[error("--resume {}: it cannot be read", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// What is in the file is no checkpoint, or no longer one.
    #[error("--resume {}: {source}; begin anew without --resume", path.display())]
    Unusable {
        /// The file.
        path: PathBuf,
        /// Why.
        source: CheckpointError,
    },
    /// The checkpoint is that of another run.
    #[error("--resume {}: it is of a run with {what}; repeat that command, or begin anew without --resume", path.display())]
    OtherRun {
        /// The file.
        path: PathBuf,
        /// What is different, then and now.
        what: String,
    },
    /// A checkpoint would overwrite something else.
    #[error("--checkpoint {}: the file is there and is no checkpoint; give another name", path.display())]
    Occupied {
        /// The file.
        path: PathBuf,
    },
    /// `--every` where no checkpoint is kept.
    #[error("--every says how often; give --checkpoint FILE too")]
    Nowhere,
}
