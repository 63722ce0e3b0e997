//! Comma-separated values.

use std::io::{self, Write};

use crate::motion::table::Table;

/// A header, then a line for each row, numbers with 17 significant digits: those that give the same number back.
pub(super) fn write(table: &Table, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "{}", table.columns().join(","))?; // names contain neither commas nor quotes
    for row in table.rows() {
        for (j, value) in row.iter().enumerate() {
            let comma = if j == 0 { "" } else { "," };
            write!(out, "{comma}{value:.16e}")?;
        }
        writeln!(out)?;
    }
    Ok(())
}
