//! Errors of drawing a picture.

/// A picture that could not be drawn.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PlotError {
    /// The built-in font cannot be read.
    #[error("the built-in font cannot be read")]
    Font,
    /// The drawing library refused.
    #[error("cannot draw the picture: {message}")]
    Draw {
        /// What it says.
        message: String,
    },
    /// The bitmap could not be encoded.
    #[error("cannot encode the picture: {message}")]
    Encode {
        /// What the encoder says.
        message: String,
    },
}
