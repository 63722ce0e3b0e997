//! The printed analysis of a model's motions.
//!
//! An assembled model is turned into text that describes its motions. Read `description` first, the content
//! in any format; then `basis`, the common basis of all parts, and the parts themselves: `brackets`,
//! `integrals`, `measure`, `action`, `steady`, `routh`. `names` writes the formulas, with names for long
//! expressions; `text`, `latex` and `json` are the three ways to print, `folded` breaks long formulas into
//! several lines, and `page` combines these. `bracket_of` computes the bracket of two functions, for
//! programs.

pub(crate) mod action;
pub(crate) mod basis;
pub(crate) mod bracket_of;
pub(crate) mod brackets;
pub(crate) mod description;
pub(crate) mod folded;
pub(crate) mod integrals;
pub(crate) mod json;
pub(crate) mod latex;
pub(crate) mod measure;
pub(crate) mod names;
pub(crate) mod options;
pub(crate) mod page;
pub(crate) mod routh;
pub(crate) mod steady;
pub(crate) mod text;
