//! The agreement with a second derivation.

use pc_print::columns;
use pc_verify::{Agreement, VerifyError};
use serde_json::{Value, json};

/// An agreement, or the reason why there is none, as lines of a report of this width.
pub(super) fn lines(outcome: &Result<Agreement, VerifyError>, width: usize) -> Vec<String> {
    match outcome {
        Ok(agreement) => {
            let more = by_reason(&agreement.not_compared).into_iter();
            let more = more.map(|what| clipped(&format!("not compared: {what}"), width));
            [clipped(&agreement.to_string(), width)].into_iter().chain(more).collect()
        }
        Err(VerifyError::Unable(unable)) => vec![clipped(&format!("not made: {unable}"), width)],
        Err(error) => vec![clipped(&error.to_string(), width)],
    }
}

/// What was not compared, the pages of equations that share a reason on one line.
fn by_reason(not_compared: &[String]) -> Vec<String> {
    let mut lines: Vec<(Vec<&str>, &str)> = Vec::new();
    for what in not_compared {
        let page = what.split_once(PRINTED);
        match page.and_then(|(form, reason)| Some((form, lines.iter_mut().find(|line| line.1 == reason)?))) {
            Some((form, (forms, _))) => forms.push(form),
            None => {
                lines.push(page.map_or((Vec::new(), what.as_str()), |(form, reason)| (vec![form], reason)));
            }
        }
    }
    let line = |(forms, reason): (Vec<&str>, &str)| match forms.as_slice() {
        [] => reason.to_owned(),
        forms => format!("{}{PRINTED}{reason}", forms.join(", ")),
    };
    lines.into_iter().map(line).collect()
}

/// What stands between the name of a form and the reason why its page was not compared.
const PRINTED: &str = " as printed: ";

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
