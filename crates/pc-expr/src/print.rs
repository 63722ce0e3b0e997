//! Expressions as text for readers.
//!
//! Expressions are written as lines. Read `piece` (text with its binding strength) and `symbol` (names split
//! into their parts), `style` with `book`, `latex` and `mathml` (the notations), then `writer`, which decides
//! order, signs and parentheses, `text` (one expression) and `names` (many expressions, with names for long
//! or repeated parts).

pub(crate) mod book;
pub(crate) mod latex;
mod mathml;
pub(crate) mod names;
pub(crate) mod piece;
pub(crate) mod style;
mod symbol;
pub(crate) mod text;
mod writer;
