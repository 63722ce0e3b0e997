//! Errors in models and their messages: file, line, column, and a correction.
//!
//! An error and its place in the file become a [`ModelError`](error::ModelError) with its message and its
//! `category`, which decides the exit code. Read `source` first (the text, places in it, and how a line of
//! the text is shown). Then read `meaning`, the errors in the meaning of a model, with their `words`, the
//! `notation` of other programs, and the `correction` of each; `error_kind`, which adds the errors in its text; and `error`, the one type that all
//! of them become.

pub(crate) mod category;
pub(crate) mod correction;
pub(crate) mod error;
pub(crate) mod error_kind;
pub(crate) mod meaning;
pub(crate) mod notation;
pub(crate) mod source;
pub(crate) mod words;
