//! Numbers and lists in words.

use crate::words::lines::columns;

/// A number with at most `digits` significant digits and without superfluous zeros.
pub fn short(value: f64, digits: usize) -> String {
    let rounded: f64 = format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value);
    let size = rounded.abs();
    if rounded == 0.0 || (1e-4..1e9).contains(&size) || !rounded.is_finite() {
        rounded.to_string()
    } else {
        format!("{rounded:e}")
    }
}

/// A small number, such as a residual or a drift, to two digits.
pub fn small(value: f64) -> String {
    if value == 0.0 { "0".to_owned() } else { format!("{value:.1e}") }
}

/// The items, comma-separated, on lines of at most `width` characters if they fit.
pub fn wrapped(items: impl IntoIterator<Item = String>, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for item in items {
        match lines.last_mut() {
            Some(line) if columns(line) + columns(&item) + 2 <= width => *line += &format!(", {item}"),
            Some(line) => {
                line.push(',');
                lines.push(item);
            }
            None => lines.push(item),
        }
    }
    lines
}

/// `name = value` for each, comma-separated, on lines of at most `width` characters.
pub fn assignments<'a>(pairs: impl IntoIterator<Item = (&'a str, f64)>, width: usize) -> Vec<String> {
    wrapped(pairs.into_iter().map(|(name, value)| format!("{name} = {}", short(value, 10))), width)
}

/// `label`, padded to `width`, followed by the first line; further lines are indented by the same width.
pub fn labelled(label: &str, width: usize, lines: &[String]) -> String {
    let mut text = String::new();
    for (i, line) in lines.iter().enumerate() {
        text += &format!("  {:width$}{line}\n", if i == 0 { label } else { "" });
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!(short(0.1 + 0.2, 10), "0.3");
        assert_eq!(short(-1234.5678901234, 6), "-1234.57");
        assert_eq!(short(1.5e-7, 10), "1.5e-7");
        assert_eq!(short(0.0, 3), "0");
        assert_eq!(short(f64::NAN, 3), "NaN");
        assert_eq!(small(1.234e-12), "1.2e-12");
    }

    #[test]
    fn long_lists_are_wrapped() {
        let lines = wrapped(["aaaa", "bbbb", "cccc"].map(str::to_owned), 11);
        assert_eq!(lines, ["aaaa, bbbb,", "cccc"]);
    }
}
