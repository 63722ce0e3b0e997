//! Pictures as files.
//!
//! A [`Drawing`](crate::picture::Drawing) becomes a bitmap or a page: `glyphs` are the outlines of the built-in
//! font, `png`, `gif` and `pdf` write, and `error` lists the errors. SVG does not need this.

mod error;
mod gif;
mod glyphs;
mod pdf;
mod png;

pub use error::PictureError;
pub use gif::{gif, nearest, stills};
pub use pdf::pdf;
pub use png::png;
