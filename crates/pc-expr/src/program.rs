//! Chosen expressions as a tape of operations that is independent of the graph.
//!
//! Expressions and the order of their inputs give a [`Program`](program::Program). Read `program` first. A
//! tape is made by `sharing` (common factors of products), `angle_addition` (sines of sums from those of the
//! summands) and `lower` (n-ary nodes as binary operations), in this order; `fuse` makes multiply-adds and
//! counts operations; `bind` replaces parameters by numbers; `hoist` separates the part that parameters alone
//! determine, and `factor` the factors made from them (with a `builder`); `digest` identifies tapes. `sliding` is
//! the tape of a motion along surfaces on which another one jumps, `variation` that of a motion with its
//! derivatives.

pub(crate) mod angle_addition;
pub(crate) mod bind;
mod builder;
pub(crate) mod digest;
mod factor;
pub(crate) mod fuse;
pub(crate) mod hoist;
pub(crate) mod lower;
pub(crate) mod program;
pub(crate) mod sharing;
pub(crate) mod sliding;
mod variation;
