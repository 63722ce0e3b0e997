//! The variables of the state, which decide the form of the equations.

use serde::{Deserialize, Serialize};

/// The variables of the state in addition to the coordinates, which decide the equations of motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Variables {
    /// The quasi-velocities of (9) or (30): the independent ones if constraints make the others vanish, otherwise
    /// all of them, with multipliers.
    QuasiVelocities,
    /// The momenta of (10) that belong to the quasi-velocities of (9) or (30).
    Momenta,
    /// The quasi-velocities of (9), without the coordinates on which nothing depends: the Euler–Poincaré
    /// equations if no coordinate is left.
    Reduced,
    /// The momenta that belong to the quasi-velocities of `Reduced`: the Lie–Poisson equations if no
    /// coordinate is left.
    ReducedMomenta,
    /// Quasi-velocities that are orthonormal in the kinetic metric.
    Orthonormal,
    /// Quasi-velocities [given](crate::Model::give_quasi_velocity) in addition to those of the text, for
    /// Hamel's equations.
    Given,
    /// The velocities of independent coordinates, for Voronets' equations (35), and Chaplygin's.
    IndependentVelocities,
}

impl Variables {
    /// All choices of variables.
    pub const ALL: [Variables; 7] = [
        Variables::QuasiVelocities,
        Variables::Momenta,
        Variables::Reduced,
        Variables::ReducedMomenta,
        Variables::Orthonormal,
        Variables::Given,
        Variables::IndependentVelocities,
    ];

    /// Whether the state has momenta.
    pub fn has_momenta(self) -> bool {
        matches!(self, Variables::Momenta | Variables::ReducedMomenta)
    }

    /// Whether the equations are those of the model's own coordinates and quasi-velocities.
    pub fn are_own(self) -> bool {
        matches!(self, Variables::QuasiVelocities | Variables::Momenta)
    }

    /// The name of the form of the equations in these variables, in model files, on command lines and in
    /// Python.
    pub fn name(self) -> &'static str {
        match self {
            Variables::QuasiVelocities => "poincare",
            Variables::Momenta => "canonical",
            Variables::Reduced => "reduced",
            Variables::ReducedMomenta => "lie-poisson",
            Variables::Orthonormal => "orthonormal",
            Variables::Given => "hamel",
            Variables::IndependentVelocities => "voronets",
        }
    }
}
