//! Converts models to other formats.
//!
//! A model whose motion is that of bodies on joints with dampers becomes a robot in URDF; `constants` has the
//! numbers of such a model, `urdf` writes them.

mod constants;
mod urdf;

pub use urdf::urdf_of_model;
