//! Converts models in other formats to text models.
//!
//! A robot in URDF becomes the text of a model. Read `robot` first, the contents of such a file; `urdf` reads the
//! file, with an `error` that shows the place in the file, and `text` writes the model, whose names are chosen by
//! `names`.

mod error;
mod names;
mod robot;
mod text;
mod urdf;

pub use error::UrdfError;
pub use text::model_of_urdf;
