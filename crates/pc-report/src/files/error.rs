//! Errors of pictures as files.

/// A picture that cannot be a file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PictureError {
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
        /// The message of the encoder.
        message: String,
    },
}
