//! Numbers and lines for people.

use std::fmt;
use std::io::{self, Write};

use pc_print::visible;
pub use pc_print::{assignments, labelled, short, small, wrapped};

/// Writes to standard error, with control characters made harmless; a closed standard error is ignored.
pub fn say(message: fmt::Arguments<'_>) {
    let _ = io::stderr().lock().write_all(visible(&message.to_string()).as_bytes());
}
