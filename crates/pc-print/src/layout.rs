//! The layout of a sheet on a page.
//!
//! A `layout` holds the choices for printing, in a `format`; a `part` of a sheet consists of rows, with names
//! for long expressions, and may have a `remark`.

pub(crate) mod format;
pub(crate) mod layout;
pub(crate) mod part;
pub(crate) mod remark;
