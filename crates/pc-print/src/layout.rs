//! How a sheet stands on a page.
//!
//! A `layout` is what whoever prints chooses, in a `format`; a `part` of a sheet is rows with names for what is long.

pub(crate) mod format;
pub(crate) mod layout;
pub(crate) mod part;
