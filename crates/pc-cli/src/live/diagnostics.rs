//! Errors as data for an editor.

use pc_model::{ModelError, Source};
use pc_run::RunError;
use serde_json::{Value, json};

use crate::error::CliError;

/// What an error says, at its place in the text; at the start of it where it has none.
pub(super) fn diagnostic(error: &CliError, source: &Source) -> Value {
    match error {
        CliError::Run(RunError::Model(error)) => placed(error, source),
        other => {
            let report = other.report();
            let message = report.strip_prefix("pc: ").unwrap_or(&report);
            json!({ "line": 1, "column": 1, "length": 1, "message": message, "severity": "error" })
        }
    }
}

fn placed(error: &ModelError, source: &Source) -> Value {
    let (position, diagnostic) = (error.position(), error.diagnostic());
    let marked = source.slice(error.span());
    let length = marked.lines().next().unwrap_or_default().chars().count().max(1);
    json!({
        "line": position.line,
        "column": position.column,
        "length": length,
        "message": diagnostic.message,
        "help": diagnostic.help,
        "severity": "error",
    })
}
