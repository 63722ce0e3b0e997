//! Equations in several output languages: `text`, `latex`, `mathml` and `json`; `bodies` prints trees of bodies, body by
//! body.

pub(crate) mod bodies;
pub(crate) mod json;
pub(crate) mod latex;
pub(crate) mod mathml;
pub(crate) mod text;
