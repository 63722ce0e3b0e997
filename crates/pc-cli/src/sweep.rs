//! `pc sweep`: many motions of one model, of other parameters and starts, in one table.
//!
//! In go a model and what is varied, out comes a file. Read `design` first, which values members have; `member` is the motion
//! of one, `record` what is kept of it, in a `journal` on disk until the `output` is made, row by row of a `sheet`. `command`
//! is the whole, with its `progress`, and `error` what can go wrong.

pub mod command;
pub(crate) mod design;
pub(crate) mod error;
pub(crate) mod journal;
pub(crate) mod member;
pub mod output;
pub(crate) mod progress;
pub(crate) mod record;
pub(crate) mod sheet;
