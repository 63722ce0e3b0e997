//! Comma-separated values.

use std::io::{self, Write};

use crate::output::atomic::FileWriter;
use crate::output::csv::{field, header};
use crate::sweep::journal::Records;
use crate::sweep::sheet::{Cell, Sheet};

/// A header, then a line for each row, numbers with 17 significant digits; text in quotes where it needs them.
pub(super) fn write(sheet: &Sheet, members: &dyn Records, out: &mut FileWriter<'_>) -> io::Result<()> {
    writeln!(out, "{}", header(sheet.columns().iter().map(|column| &column.name)))?;
    for record in members.records()? {
        for row in sheet.rows(&record?)? {
            for (j, cell) in row.iter().enumerate() {
                let comma = if j == 0 { "" } else { "," };
                match cell {
                    Cell::Integer(value) => write!(out, "{comma}{value}")?,
                    Cell::Number(value) => write!(out, "{comma}{value:.16e}")?,
                    Cell::Text(text) => write!(out, "{comma}{}", field(text))?,
                }
            }
            writeln!(out)?;
        }
    }
    Ok(())
}
