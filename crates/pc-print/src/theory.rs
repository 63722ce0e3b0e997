//! What can be said of a model's motions without integrating them, in print.
//!
//! In goes an assembled model, out comes text. Read `description` first, what is said whatever it is printed as; then `ground`,
//! from which all start, and what is said of it, part by part: `brackets`, `integrals`, `measure`, `action`, `steady`, `routh`.
//! `names` writes the formulas, with names for what is long; `text`, `latex` and `json` are the three ways to print, `folded` has long formulas on several lines, and `page` puts these
//! together.

pub(crate) mod action;
pub(crate) mod brackets;
pub(crate) mod description;
pub(crate) mod folded;
pub(crate) mod ground;
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
