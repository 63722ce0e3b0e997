//! `pc sweep`: many motions of one model, over parameters and starts, in one table.
//!
//! A model and the values to vary become a file. Read `design` first, the values of the members;
//! `member` is the motion of one, `record` its result, kept in a `journal` on disk until the
//! `output` is made, row by row of a `sheet`, and the `plot` with its `plot_error`. `command` is
//! the whole sweep, with its `progress`, or a `shard` of it; `merge` puts all `shards` together.
//! `error` lists the errors.

pub mod command;
pub(crate) mod design;
pub(crate) mod error;
pub(crate) mod journal;
pub(crate) mod member;
pub mod merge;
pub mod output;
pub(crate) mod plot;
pub mod plot_error;
pub(crate) mod progress;
pub(crate) mod record;
pub mod shard;
pub(crate) mod shards;
pub(crate) mod sheet;
