//! Errors of models and their messages: file, line, column, and a correction.
//!
//! An error and its place become a [`ModelError`](error::ModelError) with its message and its `category`,
//! which decides the exit code. Read `source` first (the text, places in it, and how a line of it is
//! shown); then `meaning`, errors in the meaning of a model, in `words`, and the `correction` of each;
//! `error_kind`, errors in its text as well; and `error`, the one type that all of them become.

pub(crate) mod category;
pub(crate) mod correction;
pub(crate) mod error;
pub(crate) mod error_kind;
pub(crate) mod meaning;
pub(crate) mod source;
pub(crate) mod words;
