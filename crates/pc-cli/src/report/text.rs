//! Numbers and lines for people.

use std::fmt;
use std::io::{self, Write};

use pc_print::visible;
pub use pc_print::{short, small, wrapped};

/// Writes to standard error, with control characters made harmless; a closed standard error is ignored.
pub fn say(message: fmt::Arguments<'_>) {
    let _ = io::stderr().lock().write_all(visible(&message.to_string()).as_bytes());
}

/// `name = value` for each, comma-separated, in lines of at most `width` characters.
pub fn assignments<'a>(pairs: impl IntoIterator<Item = (&'a str, f64)>, width: usize) -> Vec<String> {
    wrapped(pairs.into_iter().map(|(name, value)| format!("{name} = {}", short(value, 10))), width)
}

/// `label`, padded, then the lines, those after the first indented alike.
pub fn labelled(label: &str, width: usize, lines: &[String]) -> String {
    let mut text = String::new();
    for (i, line) in lines.iter().enumerate() {
        text += &format!("  {:width$}{line}\n", if i == 0 { label } else { "" });
    }
    text
}
