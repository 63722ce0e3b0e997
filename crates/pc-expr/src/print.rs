//! Expressions as text for people.
//!
//! In goes an expression, out comes a line. Read `piece` (text that knows how tightly it binds), `book` and `latex` (the two
//! alphabets it is set in), then `text`, which decides order, signs and parentheses.

pub(crate) mod book;
pub(crate) mod latex;
pub(crate) mod piece;
pub(crate) mod text;
