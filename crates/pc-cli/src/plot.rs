//! The picture of a motion.
//!
//! In goes a finished run, out come vector graphics or a bitmap. `picture` says what is in it, `canvas` draws it, and what
//! can go wrong is in `error`.

pub(crate) mod canvas;
pub mod error;
pub mod picture;
