//! What can be wrong with a model, and how it is said: file, line, column, and what would be right.
//!
//! `source` is the text with places in it, `fault` what can be wrong with a model's meaning, in `words`, and `error`
//! the one type that all of it becomes.

pub(crate) mod error;
pub(crate) mod fault;
pub(crate) mod source;
pub(crate) mod words;
