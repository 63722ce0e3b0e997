//! Checkpoints, from which a motion resumes with the same numbers to the last bit.
//!
//! `checkpoint` holds the data, `encoding` their bytes; `resume` makes a checkpoint and continues
//! from it, `resume_cvode` by CVODES, `resume_chosen` by the method of options; `legs` goes from
//! checkpoint to checkpoint, for a motion that is `resumable`.

pub(crate) mod checkpoint;
pub(crate) mod encoding;
pub(crate) mod legs;
pub(crate) mod resumable;
pub(crate) mod resume;
#[cfg(feature = "cvode")]
pub(crate) mod resume_chosen;
#[cfg(feature = "cvode")]
pub(crate) mod resume_cvode;
