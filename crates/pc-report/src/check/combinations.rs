//! Combinations of constraints that have an integral, in words.

use pc_mech::Style;
use pc_nonholo::IntegrableCombination;
use pc_print::{columns, combination};
use serde_json::{Value, json};

/// The width of a line, in columns: a formula that does not fit on the line is put on a separate line, and
/// one wider than this is left out.
const WIDEST: usize = 100;

/// μ_1 φ_1 + …
fn written(found: &IntegrableCombination<'_>) -> String {
    let terms = found.coefficients.iter();
    combination(terms.map(|(name, mu)| (mu.display(Style::Book), name.clone())))
}

/// The combinations found, with their integrals, and how many of `count` remain unknown.
pub(super) fn lines(found: &[IntegrableCombination<'_>], count: usize) -> Vec<String> {
    let line = |found: &IntegrableCombination<'_>| {
        let integral = format!("{} = const", found.integral.display(Style::Book));
        let named = format!("integrable combination  {}", written(found));
        match columns(&named) + columns(&integral) + 2 {
            width if width <= WIDEST => vec![format!("{named}: {integral}")],
            _ if columns(&named).max(columns(&integral)) <= WIDEST => vec![format!("{named}:"), integral],
            _ => vec!["integrable combination, too long to be written here".to_owned()],
        }
    };
    let open = match (count.saturating_sub(found.len()), found.is_empty()) {
        (0, _) => None,
        (1, true) => Some("1 integrable combination, not found in closed form".to_owned()),
        (1, false) => Some("1 more integrable combination, not found in closed form".to_owned()),
        (n, true) => Some(format!("{n} independent integrable combinations, not found in closed form")),
        (n, false) => Some(format!("{n} more integrable combinations, not found in closed form")),
    };
    found.iter().flat_map(line).chain(open).collect()
}

/// A combination as JSON.
pub(super) fn object(found: &IntegrableCombination<'_>) -> Value {
    let coefficients: serde_json::Map<String, Value> =
        found.coefficients.iter().map(|(name, mu)| (name.clone(), json!(mu.to_string()))).collect();
    json!({ "coefficients": coefficients, "integral": found.integral.to_string() })
}
