//! What can be wrong with a rigid body or a particle.

/// An error of a body.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BodyError {
    /// A rotation whose columns are not orthogonal, or not of one length.
    #[error(
        "the rotation of a body is none: its columns {} and {} are not orthogonal and of one length; they miss it by `{defect}`",
        columns.0, columns.1
    )]
    NotARotation {
        /// Numbers of the columns, from 1.
        columns: (usize, usize),
        /// Text of the product of the columns, or of the difference of their squares.
        defect: String,
    },
    /// A rotation that turns right into left.
    #[error("the rotation of a body is a reflection: its determinant is {determinant}")]
    Reflection {
        /// Its determinant.
        determinant: f64,
    },
    /// A part of a body that depends on velocities.
    #[error("{what} of a body depends on time and coordinates only; here it depends on `{velocity}`")]
    OfVelocities {
        /// The part.
        what: &'static str,
        /// A velocity or quasi-velocity in it.
        velocity: String,
    },
    /// An angular velocity that is not affine in the quasi-velocities.
    #[error("an angular velocity is affine in the quasi-velocities; its component `{component}` is not")]
    AngularVelocityNotAffine {
        /// Text of the component.
        component: String,
    },
}
