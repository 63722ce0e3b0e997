//! How a motion is computed: the way from a plan to a table.
//!
//! `plan` is what was asked for, `follow` integrates it, with a `progress` bar, an `interrupt`, and `checkpoint`s known by
//! their `identity`; `table` is what comes out.

pub mod checkpoint;
pub(crate) mod follow;
pub(crate) mod identity;
pub(crate) mod interrupt;
pub mod plan;
pub(crate) mod progress;
pub(crate) mod sensitivities;
pub mod table;
