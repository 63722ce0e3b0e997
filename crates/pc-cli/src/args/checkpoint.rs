//! Arguments for checkpoints.

use std::num::NonZeroU64;
use std::path::PathBuf;

use clap::Args;
use pc_run::motion::checkpoints::CheckpointFiles;

/// The arguments of `pc run` that concern checkpoints.
#[derive(Clone, Debug, Default, Args)]
pub struct CheckpointArguments {
    /// Save the latest checkpoint in FILE, for --resume. The integrator restarts at each checkpoint, which changes the motion
    /// within its tolerance
    #[arg(long, value_name = "FILE")]
    pub checkpoint: Option<PathBuf>,
    /// Number of internal steps from one checkpoint to the next [default: 1000, or that in the FILE of --resume]
    #[arg(long, value_name = "N")]
    pub every: Option<NonZeroU64>,
    /// Continue from the checkpoint in FILE, with the same model and options; the result is that of a run that was
    /// never interrupted, to the last bit. Further checkpoints are saved in the same FILE unless --checkpoint names another
    #[arg(long, value_name = "FILE")]
    pub resume: Option<PathBuf>,
}

impl CheckpointArguments {
    /// The files.
    pub(crate) fn files(&self) -> CheckpointFiles {
        CheckpointFiles {
            checkpoint: self.checkpoint.clone(),
            every: self.every,
            resume: self.resume.clone(),
        }
    }
}
