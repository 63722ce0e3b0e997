//! One JSON object: model, columns, rows.

use std::io::{self, Write};

use serde_json::{Value, json};

use crate::output::atomic::FileWriter;
use crate::sweep::journal::Records;
use crate::sweep::sheet::{Cell, Sheet};

/// Numbers have the fewest digits that reproduce them exactly; values that are not finite are null.
pub(super) fn write(
    title: &str,
    sheet: &Sheet,
    members: &dyn Records,
    out: &mut FileWriter<'_>,
) -> io::Result<()> {
    let names: Vec<&str> = sheet.columns().iter().map(|column| column.name.as_str()).collect();
    write!(out, "{{\n\"model\": {},\n\"columns\": {},\n\"rows\": [", json!(title), json!(names))?;
    let mut comma = "";
    for record in members.records()? {
        for row in sheet.rows(&record?)? {
            let cells = row.iter().map(|cell| match *cell {
                Cell::Integer(value) => json!(value),
                Cell::Number(value) => json!(value),
                Cell::Text(text) => json!(text),
            });
            writeln!(out, "{comma}")?;
            serde_json::to_writer(&mut *out, &cells.collect::<Value>())?;
            comma = ",";
        }
    }
    writeln!(out, "\n]\n}}")
}
