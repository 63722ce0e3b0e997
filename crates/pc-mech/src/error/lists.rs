//! Names and states in messages.

use pc_expr::readable;

pub(super) fn quoted(names: &[String]) -> String {
    names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

pub(super) fn listed(values: &[(String, f64)]) -> String {
    values.iter().map(|(name, value)| format!(", {name} = {}", readable(*value))).collect()
}

/// The text for the position of a jump, when the position was found approximately.
pub(super) fn at(place: &[(String, f64)]) -> String {
    let pair = |(name, value): &(String, f64)| format!("{name} = {}", approximately(*value));
    place.iter().map(pair).collect::<Vec<_>>().join(", ")
}

/// The text for a number that was found approximately, with ten digits.
pub(super) fn approximately(value: f64) -> String {
    readable(format!("{value:.9e}").parse().unwrap_or(value))
}
