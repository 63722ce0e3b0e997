//! One JSON object: model, parameters, columns, rows, summary.

use std::io::{self, Write};

use serde_json::{Map, Value, json};

use crate::motion::run::Run;
use crate::report::summary;

/// Numbers have the fewest digits that reproduce them exactly; values that are not finite are null.
pub(super) fn write(run: &Run, out: &mut dyn Write) -> io::Result<()> {
    let parameters: Map<String, Value> =
        run.parameters.iter().map(|(name, value)| (name.clone(), json!(value))).collect();
    writeln!(out, "{{\n\"model\": {},", json!(run.title))?;
    writeln!(out, "\"parameters\": {},", Value::from(parameters))?;
    writeln!(out, "\"columns\": {},", json!(run.table.columns()))?;
    writeln!(out, "\"rows\": [")?;
    let last = run.table.len().saturating_sub(1);
    for (i, row) in run.table.rows().enumerate() {
        serde_json::to_writer(&mut *out, row)?;
        writeln!(out, "{}", if i < last { "," } else { "" })?;
    }
    writeln!(out, "],")?;
    if !run.events.is_empty() {
        let occurred = |&(event, t): &(usize, f64)| json!({ "name": run.events[event], "time": t });
        writeln!(out, "\"events\": {},", run.occurrences.iter().map(occurred).collect::<Value>())?;
    }
    writeln!(out, "\"summary\": {}\n}}", summary::json(run))
}
