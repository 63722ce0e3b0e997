//! Errors of rigid bodies and particles.

/// An error of a body.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BodyError {
    /// A rotation matrix whose columns are not orthogonal, or not of equal length.
    #[error(
        "the matrix of a body is not a rotation: its columns {} and {} are not orthogonal and of equal length; the defect is `{defect}`",
        columns.0, columns.1
    )]
    NotARotation {
        /// Numbers of the two columns, counted from 1.
        columns: (usize, usize),
        /// Text of the product of the columns, or of the difference of their squares.
        defect: String,
    },
    /// A rotation matrix with a negative determinant.
    #[error("the rotation of a body is a reflection: its determinant is {determinant}")]
    Reflection {
        /// Its determinant.
        determinant: f64,
    },
    /// A property of a body that depends on velocities.
    #[error("{what} of a body may depend on time and coordinates only, but depends on `{velocity}`")]
    OfVelocities {
        /// The part.
        what: &'static str,
        /// A velocity or quasi-velocity that occurs in it.
        velocity: String,
    },
    /// An angular velocity that is not affine in the quasi-velocities.
    #[error("an angular velocity must be affine in the quasi-velocities; its component `{component}` is not")]
    AngularVelocityNotAffine {
        /// Text of the component.
        component: String,
    },
}
