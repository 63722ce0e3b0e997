//! Arguments for checkpoints.

use std::num::NonZeroU64;
use std::path::{Path, PathBuf};

use clap::Args;

/// Arguments of `pc run` for checkpoints.
#[derive(Clone, Debug, Default, Args)]
pub struct CheckpointArguments {
    /// Keep a checkpoint in FILE, for --resume. The integrator restarts at each, which changes the motion within its tolerance
    #[arg(long, value_name = "FILE")]
    pub checkpoint: Option<PathBuf>,
    /// Internal steps from one checkpoint to the next [default: 1000, or as in the FILE of --resume]
    #[arg(long, value_name = "N")]
    pub every: Option<NonZeroU64>,
    /// Continue from the checkpoint in FILE, with the same model and options; the result is that of a run that was
    /// never interrupted, to the last bit. Further checkpoints are kept there unless --checkpoint names another file
    #[arg(long, value_name = "FILE")]
    pub resume: Option<PathBuf>,
}

impl CheckpointArguments {
    /// The file in which checkpoints are kept, if they are.
    pub fn path(&self) -> Option<&Path> {
        self.checkpoint.as_deref().or(self.resume.as_deref())
    }
}
