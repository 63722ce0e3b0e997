//! Expressions as text for people.
//!
//! In go expressions, out come lines. Read `piece` (text that knows how tightly it binds), `style` with `book` and `latex` (the
//! alphabets it is set in), then `writer`, which decides order, signs and parentheses, `text`, one expression, and `names`,
//! many with names for what is long or comes again.

pub(crate) mod book;
pub(crate) mod latex;
pub(crate) mod names;
pub(crate) mod piece;
pub(crate) mod style;
pub(crate) mod text;
mod writer;
