//! `pc sweep`: one model for many values of parameters and starts, in one table.
//!
//! A model and the values to vary become a file. Read `design` first, the values of the members; `work` is what is done for one, which
//! is one of its `motions`, `linearizations` and `checks`; `record` is its result, kept in a `journal` on disk until the `output` is made,
//! row by row of a `sheet`, and the `plot`, which has a `plot_error`. `command` is the whole, with its `progress`, or a `shard` of it; `shards`
//! are all of these, which `merge` puts together. `error` lists the errors.

mod checks;
pub mod command;
pub(crate) mod design;
pub(crate) mod error;
pub(crate) mod journal;
mod linearizations;
pub mod merge;
mod motions;
pub mod output;
pub(crate) mod plot;
pub mod plot_error;
pub(crate) mod progress;
pub(crate) mod record;
pub mod shard;
pub(crate) mod shards;
pub(crate) mod sheet;
pub(crate) mod work;
