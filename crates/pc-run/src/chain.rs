//! An error in one line.

use std::error::Error;

/// An error with its causes, each after its effect; some messages already end with that of their cause.
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
