//! Errors in a file of another format, which are shown like those in a model.

use std::ops::Range;

use crate::diagnostics::error::Diagnostic;
use crate::diagnostics::source::{Place, Source};

/// An element of a URDF file that is invalid, or cannot be part of a model.
#[derive(Clone, Debug, thiserror::Error)]
#[error("{rendered}")]
pub struct UrdfError {
    /// The text of the error: file, line and column, the message, the line and a remedy.
    pub rendered: String,
}

impl UrdfError {
    /// The error at these bytes of the file, in the element `entry`.
    pub(crate) fn at(
        source: &Source,
        span: Range<usize>,
        entry: impl Into<String>,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> UrdfError {
        let place = Place { entry: entry.into(), span };
        let diagnostic = Diagnostic { place, message: message.into(), help: Some(help.into()) };
        UrdfError { rendered: diagnostic.render(source) }
    }
}
