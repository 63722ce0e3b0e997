//! Comma-separated values.

use std::io::{self, Write};

use crate::output::atomic::FileWriter;
use crate::sweep::journal::Journal;
use crate::sweep::sheet::{Cell, Sheet};

/// A header, then a line for each row, numbers with 17 significant digits; text in quotes where it needs them.
pub(super) fn write(sheet: &Sheet, journal: &Journal, out: &mut FileWriter<'_>) -> io::Result<()> {
    let names: Vec<&str> = sheet.columns().iter().map(|(name, _)| name.as_str()).collect();
    writeln!(out, "{}", names.join(","))?; // names contain neither commas nor quotes
    for record in journal.records()? {
        for row in sheet.rows(&record?) {
            for (j, cell) in row.iter().enumerate() {
                let comma = if j == 0 { "" } else { "," };
                match cell {
                    Cell::Integer(value) => write!(out, "{comma}{value}")?,
                    Cell::Number(value) => write!(out, "{comma}{value:.16e}")?,
                    Cell::Text(text) if text.contains([',', '"']) => {
                        write!(out, "{comma}\"{}\"", text.replace('"', "\"\""))?;
                    }
                    Cell::Text(text) => write!(out, "{comma}{text}")?,
                }
            }
            writeln!(out)?;
        }
    }
    Ok(())
}
