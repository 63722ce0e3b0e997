//! Tables as one JSON object: members, columns, rows, and more members.

use std::io::{self, Write};

use serde_json::{Value, json};

use crate::table::rows::{Cell, Rows};

/// Numbers have as few digits as reproduce them exactly; values that are not finite are null.
///
/// # Errors
/// [`io::Error`]
pub(crate) fn write(
    before: &[(&str, Value)],
    table: &dyn Rows,
    after: &[(&str, Value)],
    out: &mut dyn Write,
) -> io::Result<()> {
    writeln!(out, "{{")?;
    for (name, value) in before {
        writeln!(out, "\"{name}\": {value},")?;
    }
    let names: Vec<String> = table.columns().into_iter().map(|column| column.name).collect();
    write!(out, "\"columns\": {},\n\"rows\": [", json!(names))?;
    let mut comma = "";
    table.each(&mut |row| {
        let cells = row.iter().map(|cell| match *cell {
            Cell::Integer(value) => json!(value),
            Cell::Number(value) => json!(value),
            Cell::Text(text) => json!(text),
        });
        writeln!(out, "{comma}")?;
        comma = ",";
        Ok(serde_json::to_writer(&mut *out, &cells.collect::<Value>())?)
    })?;
    write!(out, "\n]")?;
    for (name, value) in after {
        write!(out, ",\n\"{name}\": {value}")?;
    }
    writeln!(out, "\n}}")
}
