//! Words and numbers for people.
//!
//! `words` shortens numbers and fills lines, `lines` counts the columns of lines, `visible` makes the
//! contents of a text harmless.

pub(crate) mod lines;
pub(crate) mod visible;
pub(crate) mod words;
