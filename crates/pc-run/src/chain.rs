//! An error on one line.

use std::error::Error;

/// The message of an error, followed by those of its causes in turn; the message of a cause is left out if
/// the text already ends with it.
pub fn chain(error: &dyn Error) -> String {
    let mut text = error.to_string();
    let mut source = error.source();
    while let Some(error) = source {
        let cause = error.to_string();
        if !text.ends_with(&cause) {
            text += &format!("; because: {cause}");
        }
        source = error.source();
    }
    text
}

/// The text on one line.
pub(crate) fn line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
