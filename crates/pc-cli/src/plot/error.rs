//! Errors of drawing a picture.

use pc_report::UnknownColumn;

/// A picture that could not be drawn.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PlotError {
    /// The built-in font cannot be read.
    #[error("the built-in font cannot be read")]
    Font,
    /// The picture is too large for memory.
    #[error("a picture of {width} × {height} points is too large")]
    Size {
        /// Its width.
        width: u32,
        /// Its height.
        height: u32,
    },
    /// The file could not be encoded.
    #[error("cannot encode the picture: {message}")]
    Encode {
        /// What the encoder says.
        message: String,
    },
    /// A column to be drawn does not exist.
    #[error("--{option}: {source}")]
    Column {
        /// The option that names it.
        option: &'static str,
        /// The column, and the existing ones.
        source: UnknownColumn,
    },
}
