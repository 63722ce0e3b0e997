//! Linearizations, loci and equilibria in every format that they have.

use std::io::{self, Seek, Write};

use pc_print::{visible, visible_json};
use serde_json::Value;

use crate::table::array::Array;
use crate::table::format::Format;
use crate::table::{mat, npz};

/// What there is to be written, as each format needs it.
pub(crate) struct Contents<'a> {
    pub(crate) text: &'a dyn Fn() -> String,
    pub(crate) json: &'a dyn Fn() -> Value,
    pub(crate) csv: &'a dyn Fn() -> String,
    pub(crate) arrays: &'a dyn Fn() -> Vec<Array>,
    /// The names of the rows and columns of the arrays, as lists separated by commas.
    pub(crate) texts: &'a [(&'a str, String)],
}

impl Contents<'_> {
    /// Writes it in a format.
    ///
    /// # Errors
    /// [`io::Error`]
    pub(crate) fn write_as(&self, format: Format, out: &mut (impl Write + Seek)) -> io::Result<()> {
        match format {
            Format::Text => write!(out, "{}", visible(&(self.text)())),
            Format::Json => writeln!(out, "{}", visible_json(&(self.json)())),
            Format::Npz => npz::write_arrays(&(self.arrays)(), out),
            Format::Mat => mat::write(&(self.arrays)(), self.texts, out),
            _ => out.write_all((self.csv)().as_bytes()),
        }
    }
}
