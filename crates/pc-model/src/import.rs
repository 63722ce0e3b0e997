//! Converts models in other formats to text models.
//!
//! A robot in URDF, MJCF or SDF becomes the text of a model. Read `robot` first, the contents of such a file,
//! with frames at a `pose` and moments of `inertia`. `urdf`, `mjcf` and `sdf` read the `xml` of the file,
//! with an `error` that shows the place in the file; `leftover` finds macros that were not expanded, and
//! `massless` what moves without mass, and `meshes` the files of what is seen. `text` writes the model, with the `additions` to its bodies on joints,
//! whose names are chosen by `names`.

mod additions;
mod error;
mod inertia;
mod leftover;
mod massless;
mod meshes;
mod mjcf;
mod names;
pub(crate) mod pose;
mod robot;
mod sdf;
mod text;
mod urdf;
mod xml;

pub use error::UrdfError;
pub use meshes::Directories;
pub use text::{ImportOptions, model_of_robot, model_of_urdf};
