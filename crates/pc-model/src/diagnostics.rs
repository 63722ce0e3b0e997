//! What can be wrong with a model, and how it is said: file, line, column, and what would be right.
//!
//! In goes what is wrong and where, out comes a [`ModelError`](error::ModelError) with its message and its `category`,
//! which decides the exit code. Read `source` first, the text with places in it and how a line of it is shown; then
//! `meaning`, what can be wrong with the meaning of a model, in `words`; `error_kind`, what can be wrong with its text as
//! well; and `error`, the one type that all of it becomes.

pub(crate) mod category;
pub(crate) mod error;
pub(crate) mod error_kind;
pub(crate) mod meaning;
pub(crate) mod source;
pub(crate) mod words;
