//! How long the derivation of a model and an evaluation of its equations take.
//!
//! `derivation` times the stages from the text to machine code, `kernels` are the ways to evaluate
//! the equations, `measure` times these in turns, and `page` prints [`Figures`](page::Figures).

pub(crate) mod derivation;
pub(crate) mod kernels;
pub(crate) mod measure;
pub(crate) mod page;
