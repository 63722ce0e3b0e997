//! The picture of a motion.
//!
//! A finished run becomes vector graphics or a bitmap. `picture` is its contents, `canvas` draws it, and `error` lists
//! its errors.

pub(crate) mod canvas;
pub mod error;
pub mod picture;
