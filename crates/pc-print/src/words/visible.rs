//! Foreign text made harmless, so that its characters cannot control a terminal.

use std::borrow::Cow;
use std::fmt::Write;

use pc_model::document::is_hidden;
use serde_json::Value;

/// Titles and names on one line: runs of white space become a space, and invisible characters become `�`.
pub fn one_line(text: &str) -> Cow<'_, str> {
    if !text.contains(is_hidden) {
        return Cow::Borrowed(text);
    }
    let mut line = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            c if c.is_whitespace() && is_hidden(c) => {
                if !line.ends_with(' ') {
                    line.push(' ');
                }
            }
            c if is_hidden(c) => line.push(char::REPLACEMENT_CHARACTER),
            c => line.push(c),
        }
    }
    Cow::Owned(line.trim().to_owned())
}

/// Text of several lines, safe for a terminal.
pub fn visible(text: &str) -> Cow<'_, str> {
    let acts = |c: char| is_hidden(c) && !matches!(c, '\n' | '\t');
    if text.contains(acts) { Cow::Owned(text.replace(acts, "\u{fffd}")) } else { Cow::Borrowed(text) }
}

/// JSON on several lines, safe for a terminal: the same value, with invisible characters escaped.
pub fn visible_json(value: &Value) -> String {
    let mut text = String::new();
    for c in format!("{value:#}").chars() {
        if is_hidden(c) && c != '\n' {
            let mut units = [0; 2];
            for unit in c.encode_utf16(&mut units) {
                // Writing to a string cannot fail.
                let _ = write!(text, "\\u{unit:04x}");
            }
        } else {
            text.push(c);
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn titles_stay_on_one_line() {
        assert_eq!(one_line("ẋ of the Čaplygin sleigh"), "ẋ of the Čaplygin sleigh");
        assert_eq!(one_line("a\n\r\n\\input{b}\u{2028}c\u{85}d\t"), "a \\input{b} c d");
        assert_eq!(one_line("\u{1b}[31m\u{9b}\u{202e}"), "\u{fffd}[31m\u{fffd}\u{fffd}");
    }

    #[test]
    fn shown_text_has_no_effect_on_a_terminal() {
        assert_eq!(visible("a\tb\nc"), "a\tb\nc");
        assert_eq!(visible("a\u{1b}]0;b\u{7}\rc"), "a\u{fffd}]0;b\u{fffd}\u{fffd}c");
    }

    #[test]
    fn json_has_the_same_value() {
        let value = json!({ "name\u{9b}": "a\u{7f}\u{202e}\n\"\u{1b}", "feff": "\u{feff}" });
        let text = visible_json(&value);
        assert!(!text.contains(|c| is_hidden(c) && c != '\n'), "{text}");
        assert_eq!(serde_json::from_str::<Value>(&text).expect("JSON"), value);
    }
}
