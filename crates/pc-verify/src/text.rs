//! The text of a model, read a second time.
//!
//! With its `names`, a syntax tree is turned into a `term` (`arithmetic` adds and multiplies terms), and all terms form the `text`, with bodies (`body`), bodies on joints (`tree`), and the
//! reactions on them (`resultant`); `contacts` finds where they touch the ground (`ground`, with the `slope` of its height), `contacts_by_name` what the text calls this, and `friction` how it slides; `momentum` holds what bodies have as they move; `couplings` says which velocities occur together.

pub(crate) mod arithmetic;
pub(crate) mod body;
pub(crate) mod contacts;
pub(crate) mod contacts_by_name;
pub(crate) mod couplings;
pub(crate) mod friction;
pub(crate) mod ground;
pub(crate) mod momentum;
pub(crate) mod names;
pub(crate) mod resultant;
pub(crate) mod slope;
pub(crate) mod term;
pub(crate) mod text;
pub(crate) mod tree;
