//! An error in a model file, and its message.

use std::ops::Range;

use thiserror::Error;

use crate::diagnostics::category::Category;
use crate::diagnostics::error_kind::ErrorKind;
use crate::diagnostics::source::{Place, Position, Source};
use crate::document::is_hidden;

/// A message about a place in a model file: an error or a note.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Where.
    pub place: Place,
    /// The message.
    pub message: String,
    /// A correction.
    pub help: Option<String>,
}

impl Diagnostic {
    /// The message as shown: `file:line:column: entry: message`, then the line, carets under the text at
    /// fault, and the help.
    pub fn render(&self, source: &Source) -> String {
        let Position { line, column } = source.position(self.place.span.start);
        let entry = match self.place.entry.as_str() {
            "" => String::new(),
            entry => format!("{}: ", clipped(&on_one_line(entry))),
        };
        let excerpt = source.excerpt(self.place.span.clone());
        let help = self.help.as_ref().map(|help| format!("\n  help: {}", clipped(help))).unwrap_or_default();
        let (name, message) = (on_one_line(source.name()), on_one_line(&self.message));
        format!("{name}:{line}:{column}: {entry}{}\n{excerpt}{help}", clipped(&message))
    }
}

/// The text with hidden characters replaced: names of files and keys may contain line ends and control
/// characters for terminals.
fn on_one_line(text: &str) -> String {
    text.replace(is_hidden, "\u{fffd}")
}

/// The text, shortened if it is very long, such as a name of a thousand letters.
fn clipped(text: &str) -> String {
    match text.char_indices().nth(500) {
        Some((cut, _)) => format!("{}…", &text[..cut]),
        None => text.into(),
    }
}

/// An error in a model file. The error is shown with its place in the file, the line, and a correction.
#[derive(Clone, Debug, Error)]
#[error("{}", .0.rendered)]
pub struct ModelError(Box<Details>);

#[derive(Clone, Debug)]
struct Details {
    kind: ErrorKind,
    diagnostic: Diagnostic,
    position: Position,
    rendered: String,
}

impl ModelError {
    pub(crate) fn new(source: &Source, place: Place, kind: ErrorKind) -> Self {
        let position = source.position(place.span.start);
        let diagnostic = Diagnostic { place, message: kind.to_string(), help: Some(kind.help()) };
        let rendered = diagnostic.render(source);
        Self(Box::new(Details { kind, diagnostic, position, rendered }))
    }

    /// The kind of the error.
    pub fn kind(&self) -> &ErrorKind {
        &self.0.kind
    }

    /// The bytes of the file at fault.
    pub fn span(&self) -> Range<usize> {
        self.0.diagnostic.place.span.clone()
    }

    /// The line and column at which these bytes begin.
    pub fn position(&self) -> Position {
        self.0.position
    }

    /// The place, the message and the help, separately.
    pub fn diagnostic(&self) -> &Diagnostic {
        &self.0.diagnostic
    }

    /// Whether the text, the model, or this program is at fault.
    pub fn category(&self) -> Category {
        self.0.kind.category()
    }
}

impl Source {
    /// The error of kind `kind` at `place`.
    pub fn error(&self, place: &Place, kind: impl Into<ErrorKind>) -> ModelError {
        ModelError::new(self, place.clone(), kind.into())
    }
}
