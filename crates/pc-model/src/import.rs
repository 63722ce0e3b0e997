//! Models in other formats, as text models.
//!
//! In goes a robot in URDF, out comes the text of a model. Read `robot` first, the contents of such
//! a file; `urdf` reads it, with an `error` that shows the place, and `text` writes the model, with `names` of its own.

mod error;
mod names;
mod robot;
mod text;
mod urdf;

pub use error::UrdfError;
pub use text::model_of_urdf;
