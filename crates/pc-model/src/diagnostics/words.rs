//! Phrases from which messages are built.

use pc_expr::parse::nearest;
use pc_expr::readable;

use crate::diagnostics::notation::meant;

pub(crate) fn at(state: &[(String, f64)]) -> String {
    let values: Vec<String> = state.iter().map(|(name, value)| format!("{name} = {value}")).collect();
    if values.is_empty() { String::new() } else { format!(" ({})", values.join(", ")) }
}

/// Six digits.
pub(crate) fn rounded(value: f64) -> String {
    readable(format!("{value:.5e}").parse().unwrap_or(value))
}

pub(crate) fn against(others: &[String]) -> String {
    let names: Vec<String> = others.iter().map(|name| format!("`{name}`")).collect();
    match names.as_slice() {
        [] => "cannot hold: it is always ".to_owned(),
        [name] => format!("contradicts {name}: where that holds, it is "),
        _ => format!("contradicts {}: where these hold, it is ", names.join(" and ")),
    }
}

pub(crate) fn undetermined_text(names: &[String]) -> String {
    let rates: Vec<String> = names.iter().map(|name| format!("{name}'")).collect();
    rates.join(", ") + if rates.len() == 1 { " is" } else { " are" }
}

pub(crate) fn listed(names: &[String]) -> String {
    if names.is_empty() { "none".to_owned() } else { names.join(", ") }
}

pub(crate) fn suggest(name: &str, known: &[String], otherwise: &str) -> String {
    let known = || known.iter().map(String::as_str);
    match meant(name, known()).or_else(|| nearest(name, known())) {
        Some(word) => format!("did you mean `{word}`? {otherwise}"),
        None => otherwise.to_owned(),
    }
}
