//! The picture of a motion: `plot` says what is in it, `canvas` draws it.

pub(crate) mod canvas;
pub mod plot;
