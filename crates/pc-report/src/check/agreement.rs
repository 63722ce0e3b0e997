//! The agreement with a second derivation.

use pc_print::columns;
use pc_verify::{Agreement, VerifyError};
use serde_json::{Value, json};

/// An agreement, or the reason why there is none, as lines of a report of this width.
pub(super) fn lines(outcome: &Result<Agreement, VerifyError>, width: usize) -> Vec<String> {
    match outcome {
        Ok(agreement) => {
            let more = agreement.not_compared.iter();
            let more = more.map(|what| clipped(&format!("not compared: {what}"), width));
            [clipped(&agreement.to_string(), width)].into_iter().chain(more).collect()
        }
        Err(VerifyError::Unable(unable)) => vec![clipped(&format!("not made: {unable}"), width)],
        Err(error) => vec![clipped(&error.to_string(), width)],
    }
}

/// The first line of a text, cut to this width.
fn clipped(text: &str, width: usize) -> String {
    let line = text.lines().next().unwrap_or_default();
    if columns(line) <= width {
        return line.to_owned();
    }
    let mut short: String = line.chars().take(width.saturating_sub(1)).collect();
    short.push('…');
    short
}

/// The agreement as JSON.
pub(super) fn object(outcome: &Result<Agreement, VerifyError>) -> Value {
    match outcome {
        Ok(agreement) => json!({
            "states": agreement.states,
            "projected": agreement.projected,
            "skipped": agreement.skipped,
            "reason": agreement.reason,
            "error": agreement.error,
            "quantity": agreement.quantity,
            "forms": agreement.forms,
            "not_compared": agreement.not_compared,
        }),
        Err(error) => json!({ "states": 0, "reason": error.to_string() }),
    }
}
