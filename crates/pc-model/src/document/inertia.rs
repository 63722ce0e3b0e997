//! Inertia matrices, as written.

use crate::document::expression::Expression;

/// Inertia matrix.
#[derive(Clone, Debug, PartialEq)]
pub enum Inertia {
    /// Ixx, Iyy, Izz; the other entries of the matrix are zero.
    Principal(Box<[Expression; 3]>),
    /// Ixx, Iyy, Izz, Ixy, Iyz, Ixz.
    Full(Box<[Expression; 6]>),
}
