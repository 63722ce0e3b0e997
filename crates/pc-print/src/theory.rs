//! The printed analysis of a model's motions.
//!
//! An assembled model is turned into text that describes its motions. Read `description` first, the content
//! in any format; then `basis`, the common basis of all parts, and the parts themselves: `functions`, `brackets`,
//! `dependent_momenta`, `dirac`, `canonical_variables`, `integrals`, `poissons_theorem`, `measure`, `action`, `jacobi`, `separation`,
//! `steady`, `routh`. `names` writes the formulas, with names for long
//! expressions; `text`, `latex` and `json` are the three ways to print, `folded` breaks long formulas into
//! several lines, and `page` combines these. `bracket_of` computes the bracket of two functions, for
//! programs.

pub(crate) mod action;
pub(crate) mod basis;
pub(crate) mod bracket_of;
pub(crate) mod brackets;
pub(crate) mod canonical_variables;
pub(crate) mod dependent_momenta;
pub(crate) mod description;
pub(crate) mod dirac;
pub(crate) mod extent;
pub(crate) mod folded;
pub(crate) mod functions;
pub(crate) mod integrals;
pub(crate) mod jacobi;
pub(crate) mod json;
pub(crate) mod latex;
pub(crate) mod linear_model;
pub(crate) mod measure;
pub(crate) mod names;
pub(crate) mod options;
pub(crate) mod page;
pub(crate) mod poissons_theorem;
pub(crate) mod routh;
pub(crate) mod separation;
pub(crate) mod steady;
pub(crate) mod text;
