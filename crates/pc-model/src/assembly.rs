//! From a document to a mechanical system.
//!
//! In goes a [`Document`](crate::document::document::Document), out comes all a model consists of. Read `assembly` first,
//! then its parts in the order in which they are put together: `parameters` and `tables`, `frame`, `definitions`,
//! `brackets`, `bodies`, `constraints` with `constraint_treatment`, `body_reactions`, `events`, `start`; `trial`
//! and `definite` look whether the start makes sense.

pub(crate) mod assembly;
pub(crate) mod bodies;
pub(crate) mod body_reactions;
pub(crate) mod brackets;
pub(crate) mod constraint_treatment;
pub(crate) mod constraints;
pub(crate) mod definite;
pub(crate) mod definitions;
pub(crate) mod event;
pub(crate) mod events;
pub(crate) mod external_force;
pub(crate) mod frame;
pub(crate) mod function;
pub(crate) mod parameters;
pub(crate) mod resultant;
pub(crate) mod start;
pub(crate) mod tables;
pub(crate) mod trial;
