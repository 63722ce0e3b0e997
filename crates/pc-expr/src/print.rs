//! Expressions as text for people.
//!
//! In goes an expression, out comes a line: `text` decides order, signs and parentheses, `book` and `latex` are the two
//! alphabets it is set in.

pub(crate) mod book;
pub(crate) mod latex;
pub(crate) mod text;
