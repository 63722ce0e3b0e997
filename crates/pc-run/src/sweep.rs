//! One model for many values of parameters and starts, in one table.
//!
//! Read `design` first: the values of the members form a grid of `values` or are drawn from a `law`, both as they are `written`; `of` says
//! what is computed for each. `members` are their models. `work` is done for each member, and is one of `motions`, `linearizations` and
//! `checks`; `record` is its result, which is kept in a `journal` on disk until the `output` is written, row by row in its `sweep_columns`,
//! and the `picture` is drawn, with `eigenvalues` as a root locus, which has a `picture_error`. All of this is the `whole`, or a `shard` of it; `shards` are all shards
//! together. `error` lists the errors.

mod checks;
pub mod design;
mod eigenvalues;
pub mod error;
pub mod journal;
pub mod law;
mod linearizations;
mod members;
mod motions;
pub mod of;
pub mod output;
pub mod picture;
pub mod picture_error;
pub mod record;
pub mod shard;
pub mod shards;
pub mod sweep_columns;
pub mod values;
mod whole;
mod work;
pub mod written;

pub use whole::{Sweep, SweepWishes, Swept};
