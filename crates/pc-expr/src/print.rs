//! Expressions as text for readers.
//!
//! Expressions become lines. Read `piece` (text with its binding strength), `style` with `book` and `latex` (the
//! alphabets it is set in), then `writer`, which decides order, signs and parentheses, `text`, one expression, and
//! `names`, many expressions with names for long or repeated parts.

pub(crate) mod book;
pub(crate) mod latex;
pub(crate) mod names;
pub(crate) mod piece;
pub(crate) mod style;
pub(crate) mod text;
mod writer;
