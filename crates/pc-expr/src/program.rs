//! Chosen expressions as a tape of operations that is independent of the graph.
//!
//! Expressions and the order of their inputs give a [`Program`](program::Program). Read `program` first. A
//! tape is made by `sharing` (which factors products have in common), `angle_addition` (sines of sums from those of the
//! summands) and `lower` (n-ary nodes as binary operations), in this order; `fuse` makes multiply-adds and counts;
//! `bind` puts parameters in as numbers, `hoist` takes out what they determine, `factor` what they multiply too (by a `builder`), and
//! `digest` identifies tapes.

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
