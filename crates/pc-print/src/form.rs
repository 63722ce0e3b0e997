//! The forms of the equations of motion.

/// Form of the equations of motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Equations for the quasi-velocities.
    Poincare,
    /// Equations for the momenta.
    Canonical,
    /// Equations for the velocities.
    Lagrange,
    /// Equations for independent velocities.
    Voronets,
}
