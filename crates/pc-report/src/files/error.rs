//! Errors in writing pictures as files.

/// The reason why a picture cannot be written as a file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PictureError {
    /// The built-in font cannot be read.
    #[error("the built-in font cannot be read")]
    Font,
    /// The picture is too large.
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
