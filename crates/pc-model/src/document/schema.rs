//! The text format as a JSON Schema.

/// The JSON Schema (draft 7) of the text format, for editors: the sections, their entries, and the types of
/// the entries. Every text that the schema refuses is also refused by
/// [`Document::parse`](crate::Document::parse), but the schema does not check names, expressions or
/// conditions between sections.
///
/// The schema is written by hand; the tests compare each of its entries and choices with those that the
/// reader accepts.
pub const SCHEMA: &str = include_str!("../../model.schema.json");
