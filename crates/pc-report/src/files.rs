//! Pictures written as files.
//!
//! A [`Drawing`](crate::picture::Drawing) is turned into a bitmap or a page: `glyphs` has the outlines of the
//! built-in font, `png`, `gif` and `pdf` write files, and `error` lists the errors. Writing SVG does not need
//! these modules.

mod error;
mod gif;
mod glyphs;
mod pdf;
mod png;

pub use error::PictureError;
pub use gif::{gif, nearest, stills};
pub use pdf::pdf;
pub use png::png;
