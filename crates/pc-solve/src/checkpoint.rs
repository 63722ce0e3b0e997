//! Checkpoints, from which a motion resumes with the same numbers to the last bit.
//!
//! `checkpoint` holds the data, `encoding` their bytes; `resume` makes a checkpoint and continues
//! from it, `resume_cvode` with CVODES, `resume_chosen` with the method that options choose; `legs`
//! integrates from checkpoint to checkpoint, for a motion that is `resumable`.

pub(crate) mod checkpoint;
pub(crate) mod encoding;
pub(crate) mod legs;
pub(crate) mod resumable;
pub(crate) mod resume;
#[cfg(feature = "cvode")]
pub(crate) mod resume_chosen;
#[cfg(feature = "cvode")]
pub(crate) mod resume_cvode;
