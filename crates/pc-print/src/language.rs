//! Equations in a language: `text`, `latex`, `mathml` and `json`; `bodies` is the page of bodies on joints in the first two.

pub(crate) mod bodies;
pub(crate) mod json;
pub(crate) mod latex;
pub(crate) mod mathml;
pub(crate) mod text;
