//! Checkpoints, from which a motion resumes with the same numbers, to the last bit.
//!
//! `checkpoint` holds the data, and `encoding` converts them to bytes; `resume` makes a checkpoint
//! and continues from it, `resume_cvode` does so with CVODES, and `resume_chosen` with the method
//! chosen in the options; `legs` integrates from checkpoint to checkpoint, for a motion that is
//! `resumable`.

pub(crate) mod checkpoint;
pub(crate) mod encoding;
pub(crate) mod legs;
pub(crate) mod resumable;
pub(crate) mod resume;
#[cfg(feature = "cvode")]
pub(crate) mod resume_chosen;
#[cfg(feature = "cvode")]
pub(crate) mod resume_cvode;
