//! Where a motion can be taken up again, with the same numbers to the last bit.
//!
//! `checkpoint` says what is kept, `encoding` how it is written as bytes, `resume` keeps it and goes
//! on from it, `resume_cvode` by CVODES; `legs` goes from checkpoint to checkpoint.

pub(crate) mod checkpoint;
pub(crate) mod encoding;
pub(crate) mod legs;
pub(crate) mod resume;
#[cfg(feature = "cvode")]
pub(crate) mod resume_cvode;
