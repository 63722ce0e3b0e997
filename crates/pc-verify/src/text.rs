//! The text of a model, read a second time.
//!
//! A syntax tree is turned into a `term`, and all terms form the `text`, with bodies (`body`), bodies on joints (`tree`), and the
//! reactions on them (`resultant`); `momentum` holds what bodies have as they move; `couplings` says which velocities occur together.

pub(crate) mod body;
pub(crate) mod contacts;
pub(crate) mod couplings;
pub(crate) mod momentum;
pub(crate) mod resultant;
pub(crate) mod term;
pub(crate) mod text;
pub(crate) mod tree;
