//! Pictures as files.
//!
//! A drawing of `pc-report` becomes a bitmap or a page: `glyphs` are the outlines of the built-in
//! font, `png`, `gif` and `pdf` write, and `error` lists the errors. SVG is written by `pc-report`.

pub mod error;
pub(crate) mod gif;
mod glyphs;
pub(crate) mod pdf;
pub(crate) mod png;
