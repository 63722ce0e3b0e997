//! Numbers and lines for people.

use std::fmt;
use std::io::{self, Write};
use std::path::Path;

use pc_print::visible;
pub use pc_print::{assignments, labelled, short, small, wrapped};

/// Writes to standard error, with control characters made harmless; a closed standard error is ignored.
pub fn say(message: fmt::Arguments<'_>) {
    let _ = io::stderr().lock().write_all(visible(&message.to_string()).as_bytes());
}

/// Says where the result is that stands for the file `instead_of`, because its computation was interrupted.
pub(crate) fn say_so_far(path: &Path, instead_of: Option<&Path>) {
    if let Some(file) = instead_of {
        say(format_args!(
            "note: the result up to the interruption is in {}; {} stays as it was\n",
            path.display(),
            file.display()
        ));
    }
}
