//! Comma-separated values.

use std::borrow::Cow;
use std::io::{self, Write};

use pc_print::one_line;

use crate::table::rows::{Cell, Rows};

/// Writes a header, then a line for each row. Numbers have 17 significant digits, which reproduce them
/// exactly; text is quoted if necessary.
///
/// # Errors
/// [`io::Error`]
pub fn write(table: &dyn Rows, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "{}", header(table.columns().iter().map(|column| &column.name)))?;
    table.each(&mut |cells| row(cells.iter().copied(), out))
}

/// The line for a row.
pub(crate) fn row<'a>(cells: impl IntoIterator<Item = Cell<'a>>, out: &mut dyn Write) -> io::Result<()> {
    for (j, cell) in cells.into_iter().enumerate() {
        let comma = if j == 0 { "" } else { "," };
        match cell {
            Cell::Integer(value) => write!(out, "{comma}{value}")?,
            Cell::Number(value) => write!(out, "{comma}{value:.16e}")?,
            Cell::Text(text) => write!(out, "{comma}{}", field(text))?,
        }
    }
    writeln!(out)
}

/// The line of names.
pub(crate) fn header<'n>(names: impl IntoIterator<Item = &'n String>) -> String {
    names.into_iter().map(|name| field(name)).collect::<Vec<_>>().join(",")
}

/// A text as a field on one line, in quotes if it needs them (RFC 4180).
pub fn field(text: &str) -> String {
    let text: Cow<'_, str> = one_line(text);
    if text.contains([',', '"']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.into_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_stay_fields() {
        assert_eq!(field("λ_no slip"), "λ_no slip");
        assert_eq!(field("a,b\r\n\"c\""), "\"a,b \"\"c\"\"\"");
        assert_eq!(field("\u{1b}[2J"), "\u{fffd}[2J");
    }
}
